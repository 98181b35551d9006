#pragma once

#include "keys/estimator_kind.h"
#include "keys/scene_enums.h"
#include "keys/scene_keys.h"
#include "lights/light_table.h"
#include "materials/material_table.h"
#include "phase/phase_table.h"

#include <algorithm>
#include <type_traits>

namespace vdbeam {

/// The settings struct `S` of a scene.
template <class S, class SceneRef>
auto& settings_of(SceneRef& scene, [[maybe_unused]] std::size_t index) {
  if constexpr (std::is_same_v<S, ImageSettings>)
    return scene.image;
  else if constexpr (std::is_same_v<S, CameraSettings>)
    return scene.camera;
  else if constexpr (std::is_same_v<S, VolumeSettings>)
    return scene.volumes[index];
  else if constexpr (std::is_same_v<S, VelocitySettings>)
    return scene.volumes[index].velocity;
  else if constexpr (std::is_same_v<S, PhaseSettings>)
    return scene.volumes[index].phase;
  else if constexpr (std::is_same_v<S, EmissionSettings>)
    return scene.volumes[index].emission;
  else if constexpr (std::is_same_v<S, InstanceSettings>)
    return scene.instances[index];
  else if constexpr (std::is_same_v<S, SurfaceSettings>)
    return scene.surfaces[index];
  else if constexpr (std::is_same_v<S, MaterialSettings>)
    return scene.surfaces[index].material;
  else if constexpr (std::is_same_v<S, LightSettings>)
    return scene.lights[index];
  else if constexpr (std::is_same_v<S, LayerSettings>)
    return scene.layers[index];
  else if constexpr (std::is_same_v<S, NoiseSettings>)
    return scene.volumes[index].noise;
  else if constexpr (std::is_same_v<S, FogSettings>)
    return scene.volumes[index].fog;
  else if constexpr (std::is_same_v<S, DensityRemap>)
    return scene.volumes[index].remap;
  else
    return scene.render;
}

/// A choice among the rows of a table.
template <class T>
constexpr bool is_kind = std::is_same_v<T, PhaseType> || std::is_same_v<T, MaterialType> ||
                         std::is_same_v<T, LightType> || std::is_same_v<T, EstimatorType>;
template <class T>
constexpr bool is_choice = std::is_enum_v<T> || is_kind<T>;

template <class T>
auto kind_table() {
  if constexpr (std::is_same_v<T, PhaseType>)
    return phase_table();
  else if constexpr (std::is_same_v<T, MaterialType>)
    return material_table();
  else if constexpr (std::is_same_v<T, LightType>)
    return light_table();
  else
    return estimator_table();
}

/// The words that a scene file may say.
template <class T>
std::vector<std::string> choice_names() {
  if constexpr (is_kind<T>) {
    std::vector<std::string> names;
    for (const auto* kind : kind_table<T>())
      names.emplace_back(kind->name);
    return names;
  } else {
    return enum_names<T>();
  }
}

template <class T>
std::vector<std::string> kind_docs() {
  std::vector<std::string> docs;
  for (const auto* kind : kind_table<T>())
    docs.emplace_back(kind->help);
  return docs;
}

/// Names of the rows that list a key; none for a key that every row takes.
template <class T>
std::vector<std::string> kinds_with_key(std::string_view key) {
  std::vector<std::string> names;
  for (const auto* kind : kind_table<T>())
    if (std::find(kind->keys.begin(), kind->keys.end(), key) != kind->keys.end())
      names.emplace_back(kind->name);
  return names;
}

template <class T>
KeyValue to_key_value(const T& x) {
  if constexpr (is_kind<T>)
    return std::string(x.name);
  else if constexpr (std::is_enum_v<T>)
    return enum_name(x);
  else if constexpr (std::is_integral_v<T>)
    return static_cast<std::int64_t>(x);
  else
    return x;
}
template <class T>
KeyValue to_key_value(const Vec3<T>& x) {
  return std::vector<double>{x.x, x.y, x.z};
}
inline KeyValue to_key_value(const std::array<double, 12>& x) {
  return std::vector<double>(x.begin(), x.end());
}
template <class T>
KeyValue to_key_value(const std::optional<T>& x) {
  return x ? to_key_value(*x) : KeyValue{};
}

template <class T>
void assign(T& target, const KeyValue& value) {
  if constexpr (is_kind<T>) {
    for (const auto* kind : kind_table<T>())
      if (kind->name == std::get<std::string>(value))
        target.name = kind->name;
  } else if constexpr (std::is_enum_v<T>)
    target = enum_value<T>(std::get<std::string>(value));
  else if constexpr (std::is_integral_v<T>)
    target = static_cast<T>(std::get<std::int64_t>(value));
  else
    target = std::get<T>(value);
}
template <class T>
void assign(Vec3<T>& target, const KeyValue& value) {
  const auto& list = std::get<std::vector<double>>(value);
  target = {static_cast<T>(list[0]), static_cast<T>(list[1]), static_cast<T>(list[2])};
}
inline void assign(std::array<double, 12>& target, const KeyValue& value) {
  const auto& list = std::get<std::vector<double>>(value);
  std::copy(list.begin(), list.end(), target.begin());
}
template <class T>
void assign(std::optional<T>& target, const KeyValue& value) {
  if (std::holds_alternative<std::monostate>(value))
    target.reset();
  else
    assign(target.emplace(), value);
}

/// Reads and writes one member of a settings struct.
template <class S, class T>
void bind_member(SceneKey& key, T S::*member) {
  key.get = [member](const Scene& scene, std::size_t index) {
    return to_key_value(settings_of<S>(scene, index).*member);
  };
  key.set = [member](Scene& scene, std::size_t index, const KeyValue& value) {
    assign(settings_of<S>(scene, index).*member, value);
  };
}

/// The same for a number whose 0 means "automatic".
template <class S, class T>
void bind_member_zero_is_absent(SceneKey& key, T S::*member) {
  key.get = [member](const Scene& scene, std::size_t index) {
    const T x = settings_of<S>(scene, index).*member;
    return x == T{0} ? KeyValue{} : to_key_value(x);
  };
  key.set = [member](Scene& scene, std::size_t index, const KeyValue& value) {
    T& target = settings_of<S>(scene, index).*member;
    if (std::holds_alternative<std::monostate>(value))
      target = T{0};
    else
      assign(target, value);
  };
}

} // namespace vdbeam
