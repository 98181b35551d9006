#pragma once

#include "film/film.h"
#include "machine/atomic_file.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Passes are numbered from 0 to below this, in files as in --pass-range: merging lists all up to
/// the last one.
inline constexpr int most_passes = 1'000'000;

/// Identity of a film on disk.
struct FilmFileInfo {
  Image header;           ///< windows and attributes of the picture, without channels
  std::string pass_hash;  ///< of the scene (vdbeam::pass_hash)
  std::string arithmetic; ///< of the machine (arithmetic_fingerprint)
  int frame = 1;
  std::vector<int> passes; ///< sorted; which passes the film holds
  std::uint64_t invalid_values = 0;
  double seconds = 0;               ///< spent on rendering them
  bool glows = false;               ///< the film holds emission
  std::vector<std::string> groups;  ///< light groups with planes of their own
  std::vector<std::string> objects; ///< whose coverage it holds
  std::vector<std::string> planes;  ///< of layers that it holds
  /// Planes of edges and of pieces of a film that holds a deep picture; 0: it does not.
  std::size_t deep_edge_planes = 0, deep_piece_planes = 0;
  bool unbiased = false; ///< as the plan has it (RenderPlan::unbiased)

  /// Same scene, frame, pixels and arithmetic: the passes may be added.
  bool joins(const FilmFileInfo& other) const;
};

/// Writes the film as an EXR that is complete or not there: R, G, B and A for viewers, and the
/// film's planes under "film.", a double as two 32-bit integers. Throws FrameError.
void write_film(const FilmFileInfo& info, Film& film, const std::string& path,
                Links links = Links::follow);

/// The header of such a file. Throws InputError for any other, also a damaged one.
FilmFileInfo read_film_info(const std::string& path);

/// The film itself, bit for bit as it was written. Throws InputError.
Film read_film(const std::string& path, const FilmFileInfo& info);

} // namespace vdbeam
