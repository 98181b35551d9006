#pragma once

#include "vdbeam/scene.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vdbeam {

/// Names of a choice's values in scene files, one table per type.
template <class E>
struct EnumNames;

template <>
struct EnumNames<Projection> {
  static constexpr std::array<std::pair<Projection, std::string_view>, 3> table{
      {{Projection::perspective, "perspective"},
       {Projection::orthographic, "orthographic"},
       {Projection::panorama, "panorama"}}};
};
template <>
struct EnumNames<FileAxes> {
  static constexpr std::array<std::pair<FileAxes, std::string_view>, 3> table{
      {{FileAxes::same, "same"},
       {FileAxes::y_up_to_z_up, "y_up_to_z_up"},
       {FileAxes::z_up_to_y_up, "z_up_to_y_up"}}};
};
template <>
struct EnumNames<RotationOrder> {
  static constexpr std::array<std::pair<RotationOrder, std::string_view>, 6> table{
      {{RotationOrder::zxy, "zxy"},
       {RotationOrder::xyz, "xyz"},
       {RotationOrder::xzy, "xzy"},
       {RotationOrder::yxz, "yxz"},
       {RotationOrder::yzx, "yzx"},
       {RotationOrder::zyx, "zyx"}}};
};
template <>
struct EnumNames<PixelFilter> {
  static constexpr std::array<std::pair<PixelFilter, std::string_view>, 3> table{
      {{PixelFilter::box, "box"},
       {PixelFilter::gaussian, "gaussian"},
       {PixelFilter::blackman_harris, "blackman_harris"}}};
};
template <>
struct EnumNames<VelocityUnits> {
  static constexpr std::array<std::pair<VelocityUnits, std::string_view>, 3> table{
      {{VelocityUnits::automatic, "auto"},
       {VelocityUnits::world, "world"},
       {VelocityUnits::index, "index"}}};
};
template <>
struct EnumNames<LayerPrecision> {
  static constexpr std::array<std::pair<LayerPrecision, std::string_view>, 3> table{
      {{LayerPrecision::automatic, "auto"},
       {LayerPrecision::half, "half"},
       {LayerPrecision::single, "float"}}};
};
template <>
struct EnumNames<Compression> {
  static constexpr std::array<std::pair<Compression, std::string_view>, 7> table{
      {{Compression::zip, "zip"},
       {Compression::zips, "zips"},
       {Compression::piz, "piz"},
       {Compression::rle, "rle"},
       {Compression::none, "none"},
       {Compression::dwaa, "dwaa"},
       {Compression::dwab, "dwab"}}};
};
template <>
struct EnumNames<TextureWrap> {
  static constexpr std::array<std::pair<TextureWrap, std::string_view>, 3> table{
      {{TextureWrap::repeat, "repeat"},
       {TextureWrap::mirror, "mirror"},
       {TextureWrap::clamp, "clamp"}}};
};
template <>
struct EnumNames<Interpolation> {
  static constexpr std::array<std::pair<Interpolation, std::string_view>, 2> table{
      {{Interpolation::linear, "linear"}, {Interpolation::cubic, "cubic"}}};
};
template <>
struct EnumNames<ColorSpace> {
  static constexpr std::array<std::pair<ColorSpace, std::string_view>, 4> table{
      {{ColorSpace::rec709, "rec709"},
       {ColorSpace::rec2020, "rec2020"},
       {ColorSpace::acescg, "acescg"},
       {ColorSpace::aces2065_1, "aces2065_1"}}};
};
template <>
struct EnumNames<EmissionLaw> {
  static constexpr std::array<std::pair<EmissionLaw, std::string_view>, 3> table{
      {{EmissionLaw::planck, "planck"},
       {EmissionLaw::stefan_boltzmann, "stefan_boltzmann"},
       {EmissionLaw::none, "none"}}};
};
template <>
struct EnumNames<SurfaceShape> {
  static constexpr std::array<std::pair<SurfaceShape, std::string_view>, 7> table{
      {{SurfaceShape::file, "file"},
       {SurfaceShape::sphere, "sphere"},
       {SurfaceShape::quad, "quad"},
       {SurfaceShape::disk, "disk"},
       {SurfaceShape::plane, "plane"},
       {SurfaceShape::box, "box"},
       {SurfaceShape::cylinder, "cylinder"}}};
};
template <>
struct EnumNames<VolumeShape> {
  static constexpr std::array<std::pair<VolumeShape, std::string_view>, 4> table{
      {{VolumeShape::file, "file"},
       {VolumeShape::box, "box"},
       {VolumeShape::sphere, "sphere"},
       {VolumeShape::height, "height"}}};
};
template <>
struct EnumNames<ImageParts> {
  static constexpr std::array<std::pair<ImageParts, std::string_view>, 2> table{
      {{ImageParts::one, "one"}, {ImageParts::layers, "layers"}}};
};
template <>
struct EnumNames<LayerNames> {
  static constexpr std::array<std::pair<LayerNames, std::string_view>, 3> table{
      {{LayerNames::vdbeam, "vdbeam"},
       {LayerNames::arnold, "arnold"},
       {LayerNames::cycles, "cycles"}}};
};
template <>
struct EnumNames<DirectLight> {
  static constexpr std::array<std::pair<DirectLight, std::string_view>, 3> table{
      {{DirectLight::automatic, "auto"},
       {DirectLight::sampled, "sampled"},
       {DirectLight::photons, "photons"}}};
};
template <>
struct EnumNames<PhotonStore> {
  static constexpr std::array<std::pair<PhotonStore, std::string_view>, 2> table{
      {{PhotonStore::fluence, "fluence"}, {PhotonStore::scatter, "scatter"}}};
};
template <>
struct EnumNames<PhotonThinning> {
  static constexpr std::array<std::pair<PhotonThinning, std::string_view>, 3> table{
      {{PhotonThinning::automatic, "auto"},
       {PhotonThinning::view, "view"},
       {PhotonThinning::even, "even"}}};
};
template <>
struct EnumNames<ForwardPeak> {
  static constexpr std::array<std::pair<ForwardPeak, std::string_view>, 2> table{
      {{ForwardPeak::automatic, "auto"}, {ForwardPeak::kept, "kept"}}};
};
template <>
struct EnumNames<KernelRadius> {
  static constexpr std::array<std::pair<KernelRadius, std::string_view>, 2> table{
      {{KernelRadius::adaptive, "adaptive"}, {KernelRadius::fixed, "fixed"}}};
};
template <>
struct EnumNames<SeedPolicy> {
  static constexpr std::array<std::pair<SeedPolicy, std::string_view>, 2> table{
      {{SeedPolicy::per_frame, "per_frame"}, {SeedPolicy::correlated, "correlated"}}};
};
template <>
struct EnumNames<KernelShape> {
  static constexpr std::array<std::pair<KernelShape, std::string_view>, 3> table{
      {{KernelShape::constant, "constant"},
       {KernelShape::epanechnikov, "epanechnikov"},
       {KernelShape::biweight, "biweight"}}};
};

/// The value's name; empty for a value outside the table.
template <class E>
std::string enum_name(E value) {
  for (const auto& [entry, name] : EnumNames<E>::table)
    if (entry == value)
      return std::string(name);
  return {};
}

/// The value of a name that is in the table.
template <class E>
E enum_value(std::string_view text) {
  for (const auto& [entry, name] : EnumNames<E>::table)
    if (name == text)
      return entry;
  return EnumNames<E>::table.front().first;
}

template <class E>
std::vector<std::string> enum_names() {
  std::vector<std::string> names;
  names.reserve(EnumNames<E>::table.size());
  for (const auto& [entry, name] : EnumNames<E>::table)
    names.emplace_back(name);
  return names;
}

} // namespace vdbeam
