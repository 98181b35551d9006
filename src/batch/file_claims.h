#pragma once

#include "batch/folder_names.h"
#include "report/frame_files.h"
#include "scene/scene_document.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// The files that a command is going to read and to write. No output may be an input, nor another
/// output. Two paths are the same file where they lead to the same inode (through links, hard
/// links, "./" and ".."), or, for files that are not there yet, to the same name in the same
/// folder. Names that differ only in the case of their letters count as the same there: some file
/// systems do not distinguish them.
class FileClaims {
public:
  /// `name` stands for the file in messages, e.g. "the scene". Inputs may be the same file. Throws
  /// InputError where an output is that file.
  void input(const std::string& name, const std::string& path);
  /// `option` leads to the file, e.g. "--report". An empty path is no file; "-" is the standard
  /// output. Throws InputError where another output or an input is that file.
  void output(const std::string& option, const std::string& path);

  /// A path that may hold a frame number's place, for all frames.
  void inputs(const std::string& name, const std::string& pattern, const std::vector<int>& frames);
  void outputs(const std::string& option, const std::string& pattern,
               const std::vector<int>& frames);

  /// Everything that a render of these frames may write. `whose` begins the outputs' names, for
  /// instance "a part of ".
  void render(const FrameFiles& files, const std::vector<int>& frames,
              const std::string& whose = "");
  /// Some of it.
  void outputs_of(const FrameFiles& files, const std::vector<Output>& wanted,
                  const std::vector<int>& frames, const std::string& whose = "");

  /// The scene, and everything that it reads for these frames, and for those on the disk: what its
  /// keys name, what those files name in turn, and the configuration that OCIO names.
  void scene(const SceneDocument& document, const std::string& path,
             const std::vector<int>& frames);

private:
  /// One per file and frame; there may be millions: texts are shared, and the path is put
  /// together on demand.
  struct Claim {
    const std::string *name, *pattern; ///< of texts_
    std::optional<int> frame;          ///< none: the pattern is the path
    bool output;

    std::string path() const;
  };

  const std::string* keep(const std::string& text);
  void claim(const Claim& claim);
  /// The claim of a file with this identity that came first; where there is none, the new one.
  const Claim& first_claim(const std::string& identity, const Claim& claim);
  void make_slots();
  void claim_all(const std::string& name, const std::string& pattern,
                 const std::vector<int>& frames, bool output);
  void scene_file(const SceneFile& file, const std::vector<int>& frames);
  std::string identity(const std::string& path);
  std::string identity_of(const Claim& claim);

  std::deque<std::string> texts_; ///< which stay where they are
  std::vector<Claim> claims_;
  std::vector<std::size_t> hashes_; ///< of their identities
  /// Their numbers and one more, each in the first free place from its hash on; 0: free.
  std::vector<std::uint32_t> slots_;
  FolderNames folders_;
};

} // namespace vdbeam::cli
