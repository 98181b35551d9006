#pragma once

#include "image/pass_image.h"
#include "medium/depth_profile.h"
#include "transport/camera_ray.h"

namespace vdbeam {

/// Takes down how deep on a camera ray the medium's light and opacity are, piece by piece of the
/// pixel's layout. Without a layout it does nothing.
class DeepRay {
public:
  DeepRay() = default;
  DeepRay(const World& world, const CameraRay& camera, std::size_t pixel, PassImage& image)
      : DeepRay(pixel, image) {
    scale_ = world.space.scale;
    shift_ = camera.shift;
  }
  /// Without the ray: pieces are known by their numbers alone.
  DeepRay(std::size_t pixel, PassImage& image) : deep_(image.deep_layout ? &image.deep : nullptr) {
    if (!deep_)
      return;
    const DeepLayout& layout = *image.deep_layout;
    first_ = layout.first[pixel];
    count_ = layout.count(pixel);
    edges_ = layout.edges_of(pixel);
    if (count_ == 0)
      deep_ = nullptr;
  }
  explicit operator bool() const { return deep_ != nullptr; }

  std::size_t count() const { return count_; }
  /// Where piece i begins and ends on the ray; the first and the last have no end to that side.
  float begin(std::size_t i) const { return i == 0 ? -infinity : on_ray(edges_[i]); }
  float end(std::size_t i) const { return i + 1 == count_ ? infinity : on_ray(edges_[i + 1]); }
  /// The piece that holds a place on the ray, counted from the pixel's first.
  std::size_t piece(float t) const {
    const auto distance = static_cast<float>((static_cast<double>(t) + shift_) / scale_);
    const float* inner = edges_ + 1;
    return static_cast<std::size_t>(std::upper_bound(inner, inner + count_ - 1, distance) - inner);
  }

  void add_light(std::size_t piece, const Rgb& light) const {
    float* values = deep_->data() + (first_ + piece) * DeepLayout::values_per_piece;
    for (int c = 0; c < 3; ++c)
      values[c] += light[c];
  }
  /// Light that was scattered into the ray at t.
  void add_light_at(float t, const Rgb& light) const {
    if (deep_)
      add_light(piece(t), light);
  }
  /// Light whose place is not known: as the opacity of the pieces.
  void add_by_opacity(const Rgb& light) const;
  /// Opacity, from the profile of all of the medium, which may be empty.
  void add_opacity(const Medium& medium, const DepthProfile& profile) const;
  /// Light that the medium itself sends out.
  void add_emission(const Medium& medium, const Segment& segment, const DepthProfile& profile,
                    float cutoff) const;

private:
  float on_ray(float distance) const {
    return static_cast<float>(static_cast<double>(distance) * scale_ - shift_);
  }

  std::vector<float>* deep_ = nullptr;
  std::size_t first_ = 0, count_ = 0;
  const float* edges_ = nullptr;
  double scale_ = 1, shift_ = 0;
};

} // namespace vdbeam
