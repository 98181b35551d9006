#pragma once

#include "lights/light.h"
#include "lights/occupied_region.h"
#include "volume/render_space.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// Properties of a light, cached.
struct LightTraits {
  bool visible = true;           ///< the camera sees it where its rays meet it
  bool surrounds = false;        ///< its light comes from all around, as a sky's does (LightKind)
  bool wants_shadow_rays = true; ///< they find it better than scattered rays do (LightKind)
  bool is_emission = false;      ///< of the medium: whatever looks along a ray sees it anyway
  int group = -1;                ///< to which its light belongs (LightGroups); -1: there are none
};

/// All lights of a scene.
class LightSet {
public:
  LightSet() = default;
  /// Converts the settings to render space. Throws InputError for an unreadable environment image.
  /// `notes` takes what the user should know.
  LightSet(const std::vector<LightSettings>& settings, const Vec3d& up, const RenderSpace& space,
           const OccupiedRegion& region, std::vector<std::string>* notes = nullptr);

  /// Sorts all lights into groups: one number for each light; of the medium's own emission
  /// `of_emission`. Without it there are no groups.
  void sort_into_groups(int count, const std::vector<int>& of_light, int of_emission);

  void add(std::unique_ptr<Light> light, LightTraits traits = {});

  std::size_t size() const { return lights_.size(); }
  const Light& operator[](std::size_t i) const { return *lights_[i]; }
  const LightTraits& traits(std::size_t i) const { return traits_[i]; }
  int group_count() const { return group_count_; }
  int group(std::size_t i) const { return traits_[i].group; }
  /// Whether the plate that a shadow catcher stands for has the light: it is one of the scene's
  /// [[light]] tables. Surfaces that shine and glowing volumes are added to the plate.
  bool in_plate(std::size_t i) const {
    return lights_[i]->surface() < 0 && !traits_[i].is_emission;
  }
  /// Group of the medium's emission.
  int group_of_emission() const { return group_of_emission_; }
  /// Those, but for surfaces, that rays may meet.
  const std::vector<std::size_t>& met_by_rays() const { return met_by_rays_; }
  /// Some light may be met at a finite distance.
  bool any_extent() const { return any_extent_; }

private:
  std::vector<std::shared_ptr<const Light>> lights_; ///< shared by copies
  std::vector<LightTraits> traits_;                  ///< per light
  std::vector<std::size_t> met_by_rays_;
  bool any_extent_ = false;
  int group_count_ = 0, group_of_emission_ = -1;
};

} // namespace vdbeam
