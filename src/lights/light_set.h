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

  void add(std::unique_ptr<Light> light) { lights_.push_back(std::move(light)); }

  std::size_t size() const { return lights_.size(); }
  const Light& operator[](std::size_t i) const { return *lights_[i]; }
  Light& operator[](std::size_t i) { return *lights_[i]; }

  /// Sum of what all lights show to a ray that leaves the scene.
  Rgb escaped_radiance(const Vec3f& direction) const;

private:
  std::vector<std::unique_ptr<Light>> lights_;
};

} // namespace vdbeam
