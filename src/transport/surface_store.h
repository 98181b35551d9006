#pragma once

#include "geometry/shape.h"
#include "image/texture.h"
#include "vdbeam/surface_settings.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// Meshes, primitives and textures as a scene uses them, each read once. What the previous frame,
/// or the frame that this moment belongs to, has read from the same state of a file is taken from
/// there.
class SurfaceStore {
public:
  struct KnownShape {
    std::shared_ptr<const Shape> shape;
    Vec3d center;                   ///< that the shape's own space is moved by
    std::vector<std::string> notes; ///< for the user, once per frame
  };

  /// Which surfaces need texture coordinates is found in all settings. `previous`: null, or what
  /// must stay as long as shapes and textures are asked for.
  SurfaceStore(const std::vector<SurfaceSettings>& settings, const SurfaceStore* previous);

  /// Throws InputError and FrameError for a mesh file that cannot be read.
  const KnownShape& shape(const SurfaceSettings& surface, std::vector<std::string>& notes);
  /// The texture of a material for that use; null where it has none. Throws InputError where there
  /// is no such picture.
  std::shared_ptr<const Texture> texture(const MaterialSettings& material, TextureUse use,
                                         bool shines, std::vector<std::string>& notes);

  int meshes_read() const { return meshes_read_; }
  int textures_read() const { return textures_read_; }
  /// Nothing is taken from the previous store any more.
  void close() { previous_ = nullptr; }

private:
  struct KnownTexture {
    std::shared_ptr<const Texture> texture;
    std::vector<std::string> notes;
  };

  const SurfaceStore* previous_;
  std::map<std::string, bool> textured_; ///< mesh files: some surface shows a picture on it
  std::map<std::string, KnownShape> shapes_;
  std::map<std::string, KnownTexture> textures_;
  int meshes_read_ = 0, textures_read_ = 0;
};

} // namespace vdbeam
