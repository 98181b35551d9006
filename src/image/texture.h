#pragma once

#include "math/uv.h"
#include "vdbeam/image.h"
#include "vdbeam/surface_settings.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbeam {

/// A picture on a surface, bilinear between the centres of its texels.
class Texture {
public:
  /// `largest`: what is brighter counts as that. Corrections of the
  /// values are reported in the notes, under `name`. Throws InputError for a picture without R, G
  /// and B.
  Texture(const Image& image, TextureWrap wrap, float largest, const std::string& name,
          std::vector<std::string>& notes);

  Rgb at(const Uv& uv) const;
  /// The least and greatest value of a channel.
  std::pair<float, float> range(int channel) const;
  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t bytes() const { return texels_.size() * sizeof texels_[0]; }

private:
  const Rgb& texel(int x, int y) const {
    return texels_[static_cast<std::size_t>(wrapped(y, height_)) *
                       static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(wrapped(x, width_))];
  }
  int wrapped(int i, int size) const;

  int width_, height_;
  TextureWrap wrap_;
  std::vector<Rgb> texels_;
};

/// Makes the texture of a material of an image, in the colour space of its settings: of one that
/// shines a factor of its radiance, of others of the albedo, which is kept to 1. `name` is that of
/// the image in notes.
Texture make_texture(Image image, const std::string& name, const MaterialSettings& material,
                     bool shines, std::vector<std::string>& notes);

/// What the numbers of an image mean.
struct DataKind {
  TextureUse use;
  TextureWrap wrap = TextureWrap::repeat;
  bool encoded = false;    ///< they were read as sRGB colours, which they are not
  bool alpha_only = false; ///< opacity: without an alpha channel it is 1
};

/// Makes a texture of numbers from 0 to 1. Of an opacity the alpha channel, where there is one,
/// counts in place of all others.
Texture make_data_texture(Image image, const std::string& name, const DataKind& kind,
                          std::vector<std::string>& notes);

/// Makes the texture of the file that a material names. Throws InputError where there is no such
/// picture.
Texture read_texture(const MaterialSettings& material, bool shines,
                     std::vector<std::string>& notes);

} // namespace vdbeam
