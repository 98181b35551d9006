#include "materials/diffuse.h"

#include "materials/material_table.h"
#include "math/color.h"

namespace vdbeam {
namespace {

constexpr std::string_view diffuse_keys[] = {"albedo",         "texture",         "texture_wrap",
                                             "opacity",        "opacity_texture", "opacity_cutoff",
                                             "normal_texture", "normal_scale"};

} // namespace

bool has_colored_albedo(const MaterialSettings& settings) {
  return !is_grey(albedo_of(settings)) || !settings.texture.empty();
}

const MaterialKind diffuse_material{
    .name = "diffuse",
    .help = "Lambertian reflection",
    .keys = diffuse_keys,
    .colored = has_colored_albedo,
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Diffuse>(settings);
    }};

} // namespace vdbeam
