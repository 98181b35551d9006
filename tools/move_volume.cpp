#include "volume_mover.h"

#include "vdbeam/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <exception>

namespace {

/// The path with a number in the place of "####".
std::string numbered(const std::string& path, int number) {
  const std::string place = "####";
  const std::size_t at = path.rfind(place);
  if (at == std::string::npos)
    throw vdbeam::InputError(path + ": must hold #### for the numbers of the files");
  return path.substr(0, at) + fmt::format("{:04}", number) + path.substr(at + place.size());
}

} // namespace

int main(int count, char** arguments) {
  CLI::App app{"Moves a VDB by its velocity grid, to the middles of equal parts of a shutter's "
               "time, and writes a file for each: the brute-force motion blur.\n\n"
               "Example:\n  move_volume smoke.0024.vdb sub.####.vdb --close 0.5 --count 64",
               "move_volume"};
  std::string from, to;
  double open = 0, close = 0.5;
  int parts = 64;
  vdbeam::MoveOptions options;
  app.add_option("from", from, "The VDB file to move")->required();
  app.add_option("to", to, "The files to write, such as sub.####.vdb, numbered from 1 on")
      ->required();
  app.add_option("--open", open, "When the shutter opens [frames]")->capture_default_str();
  app.add_option("--close", close, "When it closes [frames]")->capture_default_str();
  app.add_option("--count", parts, "How many files")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--velocity", options.velocity, "The grid of vectors that moves the others")
      ->capture_default_str();
  app.add_option("--fps", options.fps, "Frames in a second of the velocity")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--scale", options.scale, "Factor of the velocity")->capture_default_str();
  app.add_flag("--index", options.index, "Velocities are in voxels, not in units of the world");
  CLI11_PARSE(app, count, arguments);
  try {
    int number = 0;
    for (const double time : vdbeam::middle_times(open, close, parts)) {
      const std::string path = numbered(to, ++number);
      vdbeam::move_volume(from, path, time, options);
      fmt::print("{} at {:g}\n", path, time);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "move_volume: {}\n", error.what());
    return static_cast<int>(vdbeam::ExitCode::bad_input);
  }
  return 0;
}
