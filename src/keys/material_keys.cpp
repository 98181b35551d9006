#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_material_keys(KeyTable& table) {
  using M = MaterialSettings;
  table.section(SceneSection::material);
  table.add("type", &M::type, R"(material; short form: material = "NAME")");
  table.add("albedo", &M::albedo, "fraction of light reflected; auto: 0.8, or 1 with a texture")
      .within(0, 1)
      .absent("auto");
  table
      .add("texture", &M::texture,
           "EXR, HDR, PNG or JPEG image that multiplies albedo or radiance, placed by the "
           "surface's UV")
      .file(InputKind::picture);
  table.add("texture_wrap", &M::texture_wrap, "texture lookup beyond the edges of the images");
  table
      .add("opacity", &M::opacity,
           "fraction of the rays that the surface stops; the others go straight on")
      .within(0, 1);
  table
      .add("opacity_texture", &M::opacity_texture,
           "image that multiplies opacity, by its alpha channel, or its green one if it has none")
      .file(InputKind::picture);
  table
      .add("opacity_cutoff", &M::opacity_cutoff,
           "opacity below which there is a hole, and from which on all rays are stopped; 0: each "
           "point stops its fraction")
      .within(0, 1);
  table.add("reflectance", &M::reflectance, "reflectance at normal incidence").within(0, 1);
  table
      .add("roughness", &M::roughness,
           "GGX roughness, the square root of the lobe's width alpha; 0: smooth; auto: 0.2 for a "
           "conductor, 0 for a dielectric, 0.5 for standard")
      .within(0, 1)
      .absent("auto");
  table
      .add("roughness_texture", &M::roughness_texture,
           "image whose green channel multiplies roughness, as in glTF")
      .file(InputKind::picture);
  table.add("ior", &M::ior, "relative index of refraction, inside over outside").within(0.1, 10);
  table
      .add("metal", &M::metal,
           "share of the base that is metal, with albedo as its reflectance at normal incidence")
      .within(0, 1);
  table
      .add("metal_texture", &M::metal_texture,
           "image whose blue channel multiplies metal, as in glTF")
      .file(InputKind::picture);
  table.add("coat", &M::coat, "weight of a clear glossy layer on top").within(0, 1);
  table.add("coat_roughness", &M::coat_roughness, "GGX roughness of the coat").within(0, 1);
  table
      .add("normal_texture", &M::normal_texture,
           "image of normals in tangent space, as in glTF: +x along u, +y along v")
      .file(InputKind::picture);
  table
      .add("normal_scale", &M::normal_scale, "factor of the slope of the normals of normal_texture")
      .within(-10, 10);
  table.add("absorption", &M::absorption, "absorption coefficient inside, per channel")
      .unit("1 / world")
      .at_least(0);
  table.add("solid", &M::solid, "exclude volumes from the inside; always so where absorption > 0");
  table.add("radiance", &M::radiance, "emitted radiance").unit("W / m^2 / sr").at_least(0);
  table
      .add("power", &M::power,
           "radiant power of the whole surface without its texture, instead of radiance")
      .unit("W")
      .at_least(0)
      .absent("none");
  table
      .add("kelvin", &M::kelvin,
           "colour temperature: factor of the colour of a black body, with luminance 1")
      .unit("kelvin")
      .within(500, 50000)
      .absent("none");
  table.add("exposure", &M::exposure, "exposure: factor of 2^exposure")
      .unit("stops")
      .within(-100, 100);
  table.add("two_sided", &M::two_sided, "emit from the back too");
}

} // namespace vdbeam
