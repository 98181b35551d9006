#include "scene_fixture.h"

namespace vdbeam {
namespace {

class LightKeys : public test::SceneTest {};

TEST_F(LightKeys, StrengthAndColour) {
  write("lamp.ies", "any");
  write("slide.png", "any");
  const Scene scene =
      load("[[light]]\ntype = 'distant'\nkelvin = 5500\nexposure = -2\n"
           "[[light]]\ntype = 'point'\npower = 40\nies = 'lamp.ies'\nrotation = 90\n"
           "[[light]]\ntype = 'spot'\npower = [3, 2, 1]\nimage = 'slide.png'\n"
           "[[light]]\ntype = 'sky'\nkelvin = { keys = [[1, 4000], [3, 6000]] }\n"
           "[[mesh]]\ntype = 'sphere'\n"
           "material = { type = 'emissive', power = 9, kelvin = 2700, exposure = 1 }\n",
           {}, 2);
  EXPECT_EQ(scene.lights[0].kelvin, 5500);
  EXPECT_EQ(scene.lights[0].exposure, -2);
  EXPECT_EQ(scene.lights[1].power, Rgb(40));
  EXPECT_EQ(scene.lights[1].ies, file("lamp.ies"));
  EXPECT_EQ(scene.lights[1].rotation, 90);
  EXPECT_EQ(scene.lights[2].power, Rgb(3, 2, 1));
  EXPECT_EQ(scene.lights[2].image, file("slide.png"));
  EXPECT_EQ(scene.lights[3].kelvin, 5000);
  EXPECT_EQ(scene.surfaces[0].material.power, Rgb(9));
  EXPECT_EQ(scene.surfaces[0].material.kelvin, 2700);
}

TEST_F(LightKeys, PowerExcludesTheOtherStrength) {
  const std::string lamp = "[[light]]\ntype = 'point'\n";
  EXPECT_EQ(error_of(lamp + "intensity = 3\npower = 4\n"),
            "s.toml:4: light.0.power excludes intensity: write one or the other");
  EXPECT_EQ(error_of("[[mesh]]\ntype = 'quad'\n"
                     "material = { type = 'emissive', radiance = 1, power = 4 }\n"),
            "s.toml:3: mesh.0.material.power excludes radiance: write one or the other");
  EXPECT_EQ(load(lamp + "intensity = 3\npower = 'none'\n").lights[0].intensity, Rgb(3));
  EXPECT_EQ(load(lamp + "intensity = 3\n", {"light.0.power=5"}).lights[0].power, Rgb(5));
}

TEST_F(LightKeys, Complaints) {
  const std::string spot = "[[light]]\ntype = 'spot'\n";
  EXPECT_EQ(error_of(spot + "kelvin = 20\n"),
            "s.toml:3: light.0.kelvin must lie in [500, 50000], got 20");
  EXPECT_NE(error_of(spot + "ies = 'gone.ies'\n").find("there is no file"), std::string::npos);
  EXPECT_NE(error_of("[[light]]\ntype = 'distant'\npower = 3\n")
                .find("light.0.power does not belong to type \"distant\", only to point and spot"),
            std::string::npos);
  write("slide.png", "any");
  EXPECT_EQ(error_of(spot + "image = 'slide.png'\ncone_angle = 90\n"),
            "s.toml:4: light.0.cone_angle must be at most 89 for an image, got 90");
  EXPECT_NE(error_of(spot + "gobo = 'slide.png'\n").find("did you mean image?"), std::string::npos);
  EXPECT_NE(error_of(spot + "watts = 3\n").find("did you mean power?"), std::string::npos);
}

/// A light of its own, after those of the file, which keep their numbers.
TEST_F(LightKeys, AnAtmosphereHasItsSun) {
  const std::string sky = "[[light]]\ntype = 'atmosphere'\ndirection = [1, -1, 0]\nirradiance = 6\n"
                          "aerosol = 0.3\nexposure = 1\ngroup = 'sky'\n";
  const Scene scene = load(sky + "[[light]]\ntype = 'point'\ngroup = 'lamp'\n");
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[1].type, LightType::point);
  const LightSettings& sun = scene.lights[2];
  EXPECT_EQ(sun.type, LightType::sun);
  EXPECT_EQ(sun.direction, Vec3d(1, -1, 0));
  EXPECT_EQ(sun.irradiance, Rgb(6));
  EXPECT_EQ(sun.aerosol, 0.3);
  EXPECT_EQ(sun.exposure, 1);
  EXPECT_EQ(sun.group, "sky");
  EXPECT_EQ(load(sky + "sun = false\n").lights.size(), 1u);
  EXPECT_NE(error_of(sky + "turbidity = 2\n").find("did you mean aerosol?"), std::string::npos);
  EXPECT_EQ(error_of(sky + "altitude = -3\n"),
            "s.toml:8: light.0.altitude must lie in [0, 50000], got -3");
}

TEST_F(LightKeys, AirIsThereOnce) {
  const std::string sky = "[[light]]\ntype = 'atmosphere'\nmetres_per_unit = 1000\n";
  const Scene scene = load(sky + "[[light]]\ntype = 'atmosphere'\n");
  EXPECT_EQ(scene.lights[0].metres_per_unit, 1000);
  EXPECT_FALSE(scene.lights[1].metres_per_unit);
  EXPECT_FALSE(load(sky + "\n", {"light.0.metres_per_unit=none"}).lights[0].metres_per_unit);
  EXPECT_EQ(error_of(sky + sky),
            "s.toml:6: light.1.metres_per_unit must be there once: light.0 has "
            "the air between camera and scene");
  EXPECT_EQ(error_of("[[light]]\ntype = 'atmosphere'\nmetres_per_unit = 0\n"),
            "s.toml:3: light.0.metres_per_unit must be greater than 0, got 0");
  EXPECT_NE(error_of("[[light]]\ntype = 'sky'\nmetres_per_unit = 1\n").find("only to atmosphere"),
            std::string::npos);
}

class FogKeys : public test::SceneTest {};

TEST_F(FogKeys, AVolumeNeedsNoFile) {
  const Scene scene =
      load("[[volume]]\nshape = 'height'\nbox_lower = [-9, 0, -9]\nbox_upper = [9, 30, 9]\n"
           "scale_height = 4\nleast_density = 0.01\nextinction = 0.2\nnoise_amplitude = 1\n"
           "noise_size = 5\ntranslate = [1, 2, 3]\n"
           "[[volume]]\nshape = 'box'\n[[volume]]\nshape = 'sphere'\n");
  EXPECT_EQ(scene.volumes[0].fog.shape, VolumeShape::height);
  EXPECT_EQ(scene.volumes[0].fog.scale_height, 4);
  EXPECT_EQ(scene.volumes[0].fog.least_density, 0.01);
  EXPECT_EQ(scene.volumes[0].transform[3], 1);
  EXPECT_EQ(scene.volumes[1].fog.shape, VolumeShape::box);
  EXPECT_EQ(scene.volumes[2].fog.shape, VolumeShape::sphere);
}

TEST_F(FogKeys, Complaints) {
  EXPECT_NE(error_of("[[volume]]\n").find("volume.0 needs file"), std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nshape = 'box'\nfile = 'cloud.vdb'\n")
                .find("volume.0.file does not belong to shape \"box\", only to file"),
            std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nshape = 'box'\nscale_height = 3\n")
                .find("volume.0.scale_height does not belong to shape \"box\", only to height"),
            std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nshape = 'ball'\n").find("did you mean sphere?"),
            std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nshape = 'box'\nemission = { intensity = 'flame' }\n")
                .find("volume.0.emission.intensity must be \"density\" for a shape, which has no "
                      "other grid, got \"flame\""),
            std::string::npos);
  EXPECT_NE(
      error_of("[[volume]]\nshape = 'box'\nnoise_amplitude = 0.1\nnoise_size = 0.001\n")
          .find("volume.0.noise_size must be at least a thousandth of the box, 0.002, got 0.001"),
      std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nshape = 'box'\nbox_lower = [0, 0, 0]\n")
                .find("volume.0.box_lower needs the other corner too"),
            std::string::npos);
}

} // namespace
} // namespace vdbeam
