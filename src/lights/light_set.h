#pragma once

#include "lights/light.h"
#include "lights/occupied_region.h"
#include "volume/render_space.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// All lights of a scene.
class LightSet {
public:
  LightSet() = default;
  /// Converts the settings to render space. Throws InputError for an unreadable environment image.
  /// `notes` takes what the user should know.
  LightSet(const std::vector<LightSettings>& settings, const Vec3d& up, const RenderSpace& space,
           const OccupiedRegion& region, std::vector<std::string>* notes = nullptr);

  /// `direct`: how its single scattering is to be estimated.
  void add(std::unique_ptr<Light> light, DirectLight direct = DirectLight::automatic,
           bool visible = true);

  std::size_t size() const { return lights_.size(); }
  const Light& operator[](std::size_t i) const { return *lights_[i]; }
  /// How the scene asks for the single scattering of light i.
  DirectLight direct(std::size_t i) const { return direct_[i]; }
  /// Whether the camera sees light i where its rays meet it.
  bool visible(std::size_t i) const { return visible_[i]; }
  /// Some light may be met at a finite distance.
  bool any_extent() const { return any_extent_; }

private:
  std::vector<std::shared_ptr<const Light>> lights_; ///< shared by copies
  std::vector<DirectLight> direct_;                  ///< per light
  std::vector<bool> visible_;                        ///< per light
  bool any_extent_ = false;
};

} // namespace vdbeam
