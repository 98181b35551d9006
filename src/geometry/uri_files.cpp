#include "geometry/uri_files.h"

#include "geometry/gltf_files.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>

namespace vdbeam {
namespace {

class UriFiles final : public Assimp::DefaultIOSystem {
public:
  bool Exists(const char* file) const override {
    return Assimp::DefaultIOSystem::Exists(named_by_uri(file).c_str());
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Assimp::DefaultIOSystem::Open(named_by_uri(file).c_str(), mode);
  }
};

} // namespace

void open_uris(Assimp::Importer& importer) {
  importer.SetIOHandler(new UriFiles); // which the importer deletes
}

} // namespace vdbeam
