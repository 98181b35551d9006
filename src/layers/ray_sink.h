#pragma once

#include "layers/deep_ray.h"
#include "layers/ray_layers.h"

namespace vdbeam {

/// Writes the light that a ray of a pixel brings: its sums, and those of groups of lights; the
/// pieces of the deep pixel, by how deep it was scattered; and the layers of volumes, by which of
/// them scattered it. Sums are added once for all that is sorted by place.
class RaySink {
public:
  RaySink() = default;
  /// `layers`: the layers to fill; null: none.
  RaySink(const World& world, const CameraRay& camera, const RayLayers* layers, std::size_t pixel,
          PassImage& image)
      : RaySink(world, camera, layers, pixel, image, image) {}
  /// Pieces of one image, layers of another.
  RaySink(const World& world, const CameraRay& camera, const RayLayers* layers, std::size_t pixel,
          PassImage& of_pieces, PassImage& of_layers)
      : deep_(world, camera, pixel, of_pieces), volumes_(layers, pixel, of_layers),
        image_(&of_layers), pixel_(pixel) {}
  /// For light whose piece is known.
  RaySink(const RayLayers* layers, std::size_t pixel, PassImage& image)
      : deep_(pixel, image), volumes_(layers, pixel, image), image_(&image), pixel_(pixel) {}

  bool sorts_by_depth() const { return static_cast<bool>(deep_); }
  bool sorts_by_volume() const { return static_cast<bool>(volumes_); }

  /// Adds light to one of the sums of the pixel, and the parts of groups to theirs.
  void add_sum(std::vector<Rgb> PassImage::*sum, const GroupedLight& light) const {
    image_->add(sum, pixel_, light);
  }
  /// Light that volume `setting` of the scene scatters into the ray at the distance t.
  void add(float t, std::size_t setting, const Rgb& light) const {
    deep_.add_light_at(t, light);
    volumes_.add(setting, light);
  }
  /// The same, where several volumes scatter it: add_of_volume takes the part of each.
  void add_at(float t, const Rgb& light) const { deep_.add_light_at(t, light); }
  void add_of_volume(std::size_t setting, const Rgb& light) const { volumes_.add(setting, light); }

  /// The pieces of the pixel; none where it has no deep layout.
  std::size_t pieces() const { return deep_ ? deep_.count() : 0; }
  /// The piece that holds a place on the ray.
  std::size_t piece_at(float t) const { return deep_ ? deep_.piece(t) : 0; }
  /// Where a piece begins and ends on the ray; the first and the last have no end to that side.
  float begin(std::size_t piece) const { return deep_.begin(piece); }
  float end(std::size_t piece) const { return deep_.end(piece); }
  void add_to_piece(std::size_t piece, const Rgb& light) const {
    if (deep_)
      deep_.add_light(piece, light);
  }
  /// Spreads light over the pieces as their opacity is spread.
  void add_by_opacity(const Rgb& light) const {
    if (deep_)
      deep_.add_by_opacity(light);
  }

  /// Opacity, from the profile of all of the medium, which may be empty.
  void add_opacity(const Medium& medium, const DepthProfile& profile) const {
    if (deep_)
      deep_.add_opacity(medium, profile);
  }
  /// Light that the medium itself sends out.
  void add_emission(const Medium& medium, const Segment& segment, const DepthProfile& profile,
                    float cutoff) const {
    if (deep_)
      deep_.add_emission(medium, segment, profile, cutoff);
  }

private:
  DeepRay deep_;
  VolumeLights volumes_;
  PassImage* image_ = nullptr;
  std::size_t pixel_ = 0;
};

} // namespace vdbeam
