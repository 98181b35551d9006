#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_light_keys(KeyTable& table) {
  using L = LightSettings;
  table.section(SceneSection::light);
  table.add("type", &L::type, "kind of light").required();
  table
      .add("direction", &L::direction,
           "the way the light travels, of an atmosphere the sun's; a point light has one for its "
           "ies")
      .always_written();
  table
      .add("irradiance", &L::irradiance,
           "irradiance of a plane that faces the light; of an atmosphere's sun above the air")
      .unit("W / m^2")
      .at_least(0)
      .always_written();
  table.add("angular_radius", &L::angular_radius, "half angle of the light's disc (the sun: 0.27)")
      .unit("degrees")
      .within(0, 90);
  table.add("position", &L::position, "where the light is").unit("world").always_written();
  table.add("intensity", &L::intensity, "radiant intensity, with ies in the brightest direction")
      .unit("W / sr")
      .at_least(0);
  table
      .add(
          "power", &L::power,
          "radiant power in all directions, before a picture takes its part, in place of intensity")
      .unit("W")
      .at_least(0)
      .absent("none");
  table.add("cone_angle", &L::cone_angle, "half angle where the light ends")
      .unit("degrees")
      .above_up_to(0, 90);
  table.add("cone_falloff", &L::cone_falloff, "width of the soft edge inside the cone")
      .unit("degrees")
      .within(0, 90);
  table
      .add("ies", &L::ies,
           "photometric file (IES LM-63, type C): how its intensity depends on direction; of the "
           "file's strength nothing is used; empty: none")
      .file(InputKind::profile);
  table
      .add("picture", &L::picture,
           "EXR, HDR or PNG picture that it projects, its shorter side as wide as the cone; empty: "
           "none")
      .file(InputKind::picture);
  table
      .add("radiance", &L::radiance,
           "radiance from everywhere; with an image or for a sky: factor of what follows")
      .unit("W / m^2 / sr")
      .at_least(0)
      .always_written();
  table.add("zenith", &L::zenith, "radiance straight up").unit("W / m^2 / sr").at_least(0);
  table.add("horizon", &L::horizon, "radiance at the horizon").unit("W / m^2 / sr").at_least(0);
  table.add("ground", &L::ground, "radiance of what lies below the horizon")
      .unit("W / m^2 / sr")
      .at_least(0);
  table
      .add("aerosol", &L::aerosol,
           "haze: its optical depth straight up, at 550 nm; 0: none, 0.05: very clear, 0.1: clear, "
           "0.3: hazy, 1: thick")
      .within(0, 5);
  table
      .add("ground_albedo", &L::ground_albedo,
           "share of light that the ground reflects, which brightens the sky too")
      .within(0, 1);
  table.add("altitude", &L::altitude, "of the eye above the ground")
      .unit("metres")
      .within(0, 50000);
  table.add("sun", &L::sun, "whether the sun's disc is there, as a light of its own");
  table.add("image", &L::image, "lat-long EXR or HDR picture of the sky; empty: constant")
      .file(InputKind::picture);
  table
      .add("rotation", &L::rotation,
           "turns a sky about the camera's up axis, a lamp's profile and picture about its "
           "direction")
      .unit("degrees");
  table
      .add("kelvin", &L::kelvin,
           "temperature of a black body by whose colour, of luminance 1, its light is multiplied")
      .unit("kelvin")
      .within(500, 50000)
      .absent("none");
  table.add("exposure", &L::exposure, "its light is multiplied by 2 to the power of this")
      .unit("stops")
      .within(-100, 100);
  table.add("visible", &L::visible,
            "whether the camera sees it; hidden, it still lights the medium, and A is 0 beside it");
  table.add("group", &L::group, "lights of one group share the layer light_NAME");
  table.add("direct", &L::direct, "how its single scattering is found, instead of render.direct");
}

} // namespace vdbeam
