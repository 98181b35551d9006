#pragma once

#include "report/frame_files.h"
#include "scene/scene_document.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// The files that a command is going to read and to write. No output may be an input, nor another
/// output. Two paths are the same file where they lead to the same inode (through links, hard
/// links, "./" and ".."), or, for files that are not there yet, to the same name in the same
/// folder. Names that differ only in the case of their letters count as the same there: some file
/// systems do not tell them apart.
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
  struct Claim {
    std::string name, path;
    bool output = false;
  };

  void claim(const Claim& claim);
  void scene_file(const SceneFile& file, const std::vector<int>& frames);
  std::string identity(const std::string& path);

  struct Folder {
    std::string real;            ///< without links
    std::size_t asked = 0;       ///< how often
    bool listed = false;         ///< from then on, once that is often
    std::set<std::string> names; ///< of its files, in small letters
  };
  Folder& folder_of(const std::string& path);

  std::map<std::string, Claim> claims_; ///< by the file's identity
  std::map<std::string, Folder> folders_;
};

} // namespace vdbeam::cli
