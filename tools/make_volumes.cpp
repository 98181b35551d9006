#include "volume_factory.h"

#include "vdbeam/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <openvdb/openvdb.h>

namespace {

void list_kinds() {
  for (const vdbeam::VolumeKind& kind : vdbeam::volume_kinds())
    fmt::print("{:<12} {}\n", kind.name, kind.description);
}

/// Writes the file anew, so that each of its bytes is a byte of a value or of the tree.
void unpack(const std::string& path) {
  openvdb::io::File packed(path);
  packed.open(false);
  const openvdb::GridPtrVecPtr grids = packed.getGrids();
  packed.close();
  openvdb::io::File plain(path);
  plain.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
  plain.write(*grids);
}

} // namespace

int main(int count, char** arguments) {
  CLI::App app{"Writes a procedural VDB volume for tests and experiments.\n\n"
               "Examples:\n  make_volumes --list\n  make_volumes sphere sphere.vdb --size 128",
               "make_volumes"};
  bool list = false, plain = false;
  std::string kind, path;
  vdbeam::VolumeOptions options;
  app.add_flag("--list", list, "Show the kinds and end");
  app.add_option("kind", kind, "What to make");
  app.add_option("file", path, "The VDB file to write");
  app.add_option("--size", options.size, "Voxels across")->capture_default_str();
  app.add_option("--density", options.density, "Largest density")->capture_default_str();
  app.add_option("--extent", options.extent, "World units across")->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the noise")->capture_default_str();
  app.add_option("--name", options.name, "Name of the grid")->capture_default_str();
  app.add_flag("--plain", plain, "Store it without compression");
  CLI11_PARSE(app, count, arguments);
  if (list) {
    list_kinds();
    return 0;
  }
  try {
    if (kind.empty() || path.empty())
      throw vdbeam::InputError("a kind and a file are needed; --help shows how");
    vdbeam::write_volume(kind, path, options);
    if (plain)
      unpack(path);
  } catch (const std::exception& error) {
    fmt::print(stderr, "make_volumes: {}\n", error.what());
    return static_cast<int>(vdbeam::ExitCode::bad_input);
  }
  return 0;
}
