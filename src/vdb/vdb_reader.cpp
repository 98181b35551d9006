#include "vdb/vdb_reader.h"

#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/stopwatch.h"
#include "text/printable.h"
#include "vdb/brick_builder.h"
#include "vdb/guarded_read.h"
#include "vdb/raw_grid.h"
#include "vdb/summary_codec.h"
#include "vdb/vdb_parse.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <openvdb/version.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace vdbeam {

namespace {

constexpr std::size_t maximum_grids = 1000;

/// The size of a file that can be read at all; InputError otherwise.
std::uint64_t check_file(const std::string& path) {
  const InputFile file = open_input_file(path);
  constexpr char magic[] = {' ', 'B', 'D', 'V'};
  char start[sizeof magic];
  if (::read(file.descriptor.get(), start, sizeof start) != sizeof start ||
      std::memcmp(start, magic, sizeof magic) != 0)
    throw InputError(path + ": is not a VDB file");
  return file.bytes;
}

/// Greatest need of a well-formed file of this size, never more than the user's limits. A node
/// of OpenVDB's tree takes at least its two bit masks of the file, which bounds the memory to 34
/// bytes per byte of file for float values, 66 for double, and 80 more for a list of its tiles.
GuardLimits guard_limits(std::uint64_t file_bytes, const ReadLimits& limits) {
  GuardLimits guard;
  guard.seconds = limits.seconds + time_for(file_bytes);
  guard.cpu_seconds = std::min(guard.seconds, 10 + 1e-6 * static_cast<double>(file_bytes));
  guard.bytes = std::min(limits.bytes, (std::uint64_t(256) << 20) + 160 * file_bytes);
  guard.stop = limits.stop;
  return guard;
}

std::string repairs_note(const std::string& label, const GridRepairs& repairs) {
  std::string list;
  const auto add = [&list](std::uint64_t count, const char* what) {
    if (count > 0)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, what);
  };
  add(repairs.nan, "NaN");
  add(repairs.infinite, "infinite");
  add(repairs.negative, "negative");
  return fmt::format("{}: values replaced by 0: {}", label, list);
}

std::vector<std::string> notes(const std::string& label, const std::string& wanted,
                               const RawGridHeader& header, const DensityGrid& grid) {
  std::vector<std::string> notes;
  const std::int64_t declared = header.declared_voxels;
  if (!header.cropped && declared >= 0 &&
      static_cast<std::uint64_t>(declared) != header.active_voxels)
    notes.push_back(fmt::format("{}: has {} active voxels, but its file says {}; it may be damaged",
                                label, header.active_voxels, declared));
  if (const std::string name(header.name.data(), strnlen(header.name.data(), header.name.size()));
      !name.empty() && as_utf8(name) != wanted && name != wanted)
    notes.push_back(fmt::format("{}: the file's grid \"{}\" is taken for it", label, name));
  if (header.level_set)
    notes.push_back(label + ": is a level set, made a fog volume");
  if (grid.repairs.nan + grid.repairs.infinite + grid.repairs.negative > 0)
    notes.push_back(repairs_note(label, grid.repairs));
  if (grid.field.empty())
    notes.push_back(label + (header.cropped ? ": is empty inside the box, nothing to render"
                                            : ": is empty, nothing to render"));
  return notes;
}

} // namespace

MappedFile read_guarded(const std::string& path, const ReadLimits& limits,
                        const std::function<void(int descriptor)>& write) {
  const GuardLimits guard = guard_limits(check_file(path), limits);
  prepare_openvdb();
  return run_guarded(path, guard, write);
}

DensityGrid read_density_grid(const std::string& path, const std::string& grid_name,
                              const ReadLimits& limits, Background background,
                              const std::optional<WantedBox>& wanted) {
  const std::string label = fmt::format("{}: grid \"{}\"", path, grid_name);
  MappedFile file = read_guarded(path, limits, [&](int output) {
    write_raw_grid(path, grid_name, background, wanted, output);
  });
  RawGridHeader header;
  RawGrid raw = view_raw_grid(label, file, header);
  // OpenVDB takes a file that ends just before a tree for an empty tree.
  if (header.declared_voxels > 0 && raw.leaf_count == 0 && header.active_voxels == 0 &&
      !header.cropped)
    throw FrameError(fmt::format("{}: the file is cut short, of {} active voxels it has none",
                                 label, header.declared_voxels));
  raw.release = [&file](std::size_t leaves) {
    file.release_front(RawGridHeader::values_offset + leaves * leaf_size * sizeof(float));
  };
  BrickedGrid bricked = build_bricks(raw, label, {limits.bytes, limits.stop});

  DensityGrid grid;
  grid.field = std::move(bricked.field);
  grid.repairs = bricked.repairs;
  grid.active_voxels = header.active_voxels;
  grid.index_to_world = Affine::from_matrix(header.index_to_world);
  grid.from_mantaflow = header.from_mantaflow != 0;
  grid.notes = notes(label, grid_name, header, grid);
  return grid;
}

GridSummary read_grid_header(const std::string& path, const std::string& grid_name,
                             const ReadLimits& limits) {
  const MappedFile header =
      read_guarded(path, limits, [&](int output) { write_header(path, grid_name, output); });
  return decode_summary(path, header.data(), header.size());
}

std::vector<GridSummary> summarize_vdb(const std::string& path, const ReadLimits& limits) {
  const Stopwatch watch;
  GuardLimits guard = guard_limits(check_file(path), limits);
  const double whole_seconds = guard.seconds;
  prepare_openvdb();
  const MappedFile list =
      run_guarded(path, guard, [&](int output) { write_grid_names(path, output); });
  const std::string text(reinterpret_cast<const char*>(list.data()), list.size());
  if (std::count(text.begin(), text.end(), '\0') > static_cast<std::ptrdiff_t>(maximum_grids))
    throw FrameError(fmt::format("{}: holds more than {} grids", path, maximum_grids));

  // One process per grid, so that no more than one is in memory at a time.
  std::vector<GridSummary> summaries;
  for (std::size_t begin = 0, end; (end = text.find('\0', begin)) != text.npos; begin = end + 1) {
    const std::string name = text.substr(begin, end - begin);
    guard.seconds = std::max(whole_seconds - watch.seconds(), 1.0);
    const MappedFile summary =
        run_guarded(path, guard, [&](int output) { write_summary(path, name, output); });
    summaries.push_back(decode_summary(path, summary.data(), summary.size()));
  }
  return summaries;
}

std::string vdb_library_version() {
  return fmt::format("OpenVDB {}.{}.{}", OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER,
                     OPENVDB_LIBRARY_MINOR_VERSION_NUMBER, OPENVDB_LIBRARY_PATCH_VERSION_NUMBER);
}

} // namespace vdbeam
