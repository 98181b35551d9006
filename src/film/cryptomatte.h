#pragma once

#include "vdbeam/image.h"

#include <cstdint>
#include <string_view>

namespace vdbeam {

/// MurmurHash3_x86_32 with seed 0 (Appleby 2011).
std::uint32_t murmur_hash(std::string_view text);

/// A name's hash as the float that stands for it in a picture: one whose exponent is neither 0 nor
/// 255 (Friedman and Jones, Cryptomatte specification 1.2.0, "Hashing").
float object_id(std::string_view name);

/// Adds the layers CryptoObject00 to CryptoObject02, which hold the six objects that cover most of
/// each pixel as pairs of id and coverage, in R and G, then in B and A, and the attributes that
/// give their names. `coverage(object, pixel)` lies in [0, 1].
template <class Coverage>
void add_cryptomatte(const std::vector<std::string>& names, const Coverage& coverage, Image& image);

/// The layers' planes and the attributes.
class CryptomatteWriter {
public:
  static constexpr int ranks = 6;

  CryptomatteWriter(const std::vector<std::string>& names, Image& image);
  /// The coverage of each object in a pixel.
  void set(std::size_t pixel, const std::vector<float>& coverage);

private:
  Image& image_;
  std::size_t first_; ///< channel
  std::vector<float> ids_;
  std::vector<std::size_t> order_;
};

template <class Coverage>
void add_cryptomatte(const std::vector<std::string>& names, const Coverage& coverage,
                     Image& image) {
  CryptomatteWriter writer(names, image);
  std::vector<float> values(names.size());
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t i = 0; i < names.size(); ++i)
      values[i] = coverage(i, pixel);
    writer.set(pixel, values);
  }
}

} // namespace vdbeam
