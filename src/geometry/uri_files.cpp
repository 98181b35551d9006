#include "geometry/uri_files.h"

#include "geometry/gltf/gltf_files.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>

#include <filesystem>

namespace vdbeam {
namespace {

/// Only regular files: opening a pipe, or reading a device, may never end.
class UriFiles final : public Assimp::DefaultIOSystem {
public:
  bool Exists(const char* file) const override {
    std::error_code failed;
    return std::filesystem::is_regular_file(named_by_uri(file), failed);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? Assimp::DefaultIOSystem::Open(named_by_uri(file).c_str(), mode) : nullptr;
  }
};

} // namespace

void open_uris(Assimp::Importer& importer) {
  importer.SetIOHandler(new UriFiles); // which the importer deletes
}

} // namespace vdbeam
