#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_light_keys(KeyTable& table) {
  using L = LightSettings;
  table.section(SceneSection::light);
  table.add("type", &L::type, "kind of light").required();
  table
      .add("direction", &L::direction,
           "direction in which the light travels; of an atmosphere the sun's, of a point light "
           "that of its ies")
      .always_written();
  table
      .add("irradiance", &L::irradiance,
           "irradiance on a plane that faces the light; of an atmosphere the sun's, above the air")
      .unit("W / m^2")
      .at_least(0)
      .always_written();
  table.add("angular_radius", &L::angular_radius, "angular radius of the disc (the sun: 0.27)")
      .unit("degrees")
      .within(0, 90);
  table.add("position", &L::position, "position").unit("world").always_written();
  table.add("intensity", &L::intensity, "radiant intensity, with ies in the brightest direction")
      .unit("W / sr")
      .at_least(0);
  table
      .add("power", &L::power,
           "radiant power in all directions, without the image, instead of intensity")
      .unit("W")
      .at_least(0)
      .absent("none");
  table.add("cone_angle", &L::cone_angle, "half angle of the cone")
      .unit("degrees")
      .above_up_to(0, 90);
  table.add("cone_falloff", &L::cone_falloff, "width of the soft edge, inside the cone")
      .unit("degrees")
      .within(0, 90);
  table
      .add("ies", &L::ies,
           "photometric file (IES LM-63, type C) with the shape of the intensity; its absolute "
           "values are not used; empty: none")
      .file(InputKind::profile);
  table
      .add("radiance", &L::radiance,
           "radiance from all directions; with an image or for a sky: a factor")
      .unit("W / m^2 / sr")
      .at_least(0)
      .always_written();
  table.add("zenith", &L::zenith, "radiance straight up").unit("W / m^2 / sr").at_least(0);
  table.add("horizon", &L::horizon, "radiance at the horizon").unit("W / m^2 / sr").at_least(0);
  table.add("ground", &L::ground, "radiance of the ground below the horizon")
      .unit("W / m^2 / sr")
      .at_least(0);
  table
      .add("aerosol", &L::aerosol,
           "vertical optical depth of haze at 550 nm; 0: none, 0.05: very clear, 0.1: clear, 0.3: "
           "hazy, 1: thick")
      .within(0, 5);
  table
      .add("ground_albedo", &L::ground_albedo,
           "fraction of light that the ground reflects, which brightens the sky too")
      .within(0, 1);
  table
      .add("altitude", &L::altitude,
           "altitude above the ground: of the camera, with metres_per_unit of the world's origin")
      .unit("metres")
      .within(0, 50000);
  table
      .add("metres_per_unit", &L::metres_per_unit,
           "length of a world unit, which adds the air between camera and scene; none: no air")
      .unit("metres")
      .above(0)
      .absent("none");
  table.add("sun", &L::sun, "add the sun's disc, as a light of its own");
  table
      .add("image", &L::image,
           "EXR, HDR, PNG or JPEG image: an environment shows it all around (lat-long), and is "
           "constant without one; a spot light projects it, its shorter side as wide as the cone")
      .file(InputKind::picture);
  table
      .add("rotation", &L::rotation,
           "rotation about the camera's up axis; of a profile and image about the direction")
      .unit("degrees");
  table
      .add("kelvin", &L::kelvin,
           "colour temperature: factor of the colour of a black body, with luminance 1")
      .unit("kelvin")
      .within(500, 50000)
      .absent("none");
  table.add("exposure", &L::exposure, "exposure: factor of 2^exposure")
      .unit("stops")
      .within(-100, 100);
  table.add("visible", &L::visible,
            "visible to the camera; a hidden light still lights the scene and leaves A at 0");
  table.add("group", &L::group, "light group; the lights of a group share the layer light_NAME");
  table.add("direct", &L::direct, "method for single scattering, instead of render.direct");
}

} // namespace vdbeam
