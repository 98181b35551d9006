#include "scene_fixture.h"

namespace vdbeam {
namespace {

using Overrides = test::SceneTest;

const char* const base = "[[volume]]\nfile = 'cloud.vdb'\nextinction = 1\n"
                         "phase = { type = 'henyey_greenstein', g = 0.6 }\n"
                         "[[light]]\ntype = 'distant'\n[[light]]\ntype = 'environment'\n"
                         "radiance = [1, 2, 3]\n";

TEST_F(Overrides, ReplaceValuesOfEveryKind) {
  const Scene scene =
      load(base, {"volume.0.extinction=80", "light.1.radiance=[4, 5, 6]", "camera.fov = 12.5",
                  "render.estimator=path", "render.time=5m", "volume.0.phase.g=-0.25",
                  "image.width=7", "render.photons=auto"});
  EXPECT_EQ(scene.volumes[0].extinction, 80);
  EXPECT_EQ(scene.lights[1].radiance, Rgb(4, 5, 6));
  EXPECT_EQ(scene.camera.fov, 12.5);
  EXPECT_EQ(scene.render.estimator, EstimatorType::path);
  EXPECT_EQ(scene.render.time, 300);
  EXPECT_EQ(scene.volumes[0].phase.g, -0.25);
  EXPECT_EQ(scene.image.width, 7);
}

TEST_F(Overrides, ElementsOfAList) {
  EXPECT_EQ(load(base, {"light.1.radiance.1=9"}).lights[1].radiance, Rgb(1, 9, 3));
  EXPECT_EQ(load(base, {"light.1.radiance.0=9"}).lights[1].radiance, Rgb(9, 2, 3));
}

TEST_F(Overrides, TheLastOneWins) {
  EXPECT_EQ(load(base, {"camera.fov=1", "camera.fov=2"}).camera.fov, 2);
}

TEST_F(Overrides, AListOfOneNeedsNoNumber) {
  EXPECT_EQ(load(base, {"volume.extinction=5"}).volumes[0].extinction, 5);
}

TEST_F(Overrides, NewTablesAndListEntries) {
  const Scene scene = load(base, {"light.2.type=point", "light.2.position=[1,2,3]",
                                  "volume.1={file='" + file("cloud.vdb") + "',extinction=3}"});
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[2].position, Vec3d(1, 2, 3));
  ASSERT_EQ(scene.volumes.size(), 2u);
  EXPECT_EQ(scene.volumes[1].extinction, 3);
}

TEST_F(Overrides, ShortPhaseIsWidened) {
  const Scene scene = load("volume = [{ file = 'cloud.vdb', phase = 'mie' }]",
                           {"volume.0.phase.droplet_diameter=8"});
  EXPECT_EQ(scene.volumes[0].phase.type, PhaseType::mie);
  EXPECT_EQ(scene.volumes[0].phase.droplet_diameter, 8);
}

TEST_F(Overrides, AnotherTypeForgetsTheKeysOfTheOldOne) {
  EXPECT_EQ(load(base, {"volume.0.phase.type=isotropic"}).volumes[0].phase.type,
            PhaseType::isotropic);
}

struct BadOverride {
  const char* option;
  const char* message;
};
void PrintTo(const BadOverride& entry, std::ostream* stream) {
  *stream << entry.option;
}

class BadOverrides : public test::SceneTest, public ::testing::WithParamInterface<BadOverride> {};

TEST_P(BadOverrides, NameTheOption) {
  EXPECT_EQ(error_of(base, {GetParam().option}), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadOverrides,
    ::testing::Values(
        BadOverride{"volume.0.phase.g=1.2",
                    "--set volume.0.phase.g=1.2: volume.0.phase.g must lie in (-1, 1), got 1.2"},
        BadOverride{"volume.0.extintion=8",
                    "--set volume.0.extintion=8: unknown key volume.0.extintion; did you mean "
                    "extinction?"},
        BadOverride{"rendr.seed=8", "--set rendr.seed=8: unknown key rendr; did you mean render?"},
        BadOverride{"volume.3.extinction=8",
                    "--set volume.3.extinction=8: say which volume: volume.0"},
        BadOverride{"light.radiance=1",
                    "--set light.radiance=1: say which light: light.0 to light.1"},
        BadOverride{"light.0.radiance=1",
                    "--set light.0.radiance=1: light.0.radiance does not belong to type "
                    "\"distant\", only to environment and sky"},
        BadOverride{"volume.0.extinction.x=1",
                    "--set volume.0.extinction.x=1: there is no volume.0.extinction.x"},
        BadOverride{"light.1.radiance.7=1",
                    "--set light.1.radiance.7=1: there is no light.1.radiance.7"},
        BadOverride{
            "camera.up.1=1",
            "--set camera.up.1=1: the scene has no camera.up; set all of it: camera.up=[...]"},
        BadOverride{"camera.fov",
                    "--set camera.fov: must look like key.path=value, e.g. volume.0.extinction=80"},
        BadOverride{"=3", "--set =3: must look like key.path=value, e.g. volume.0.extinction=80"},
        BadOverride{
            "camera..fov=3",
            "--set camera..fov=3: must look like key.path=value, e.g. volume.0.extinction=80"},
        BadOverride{"camera.fov=", "--set camera.fov=: the value is missing"},
        BadOverride{"camera.up=[1,2",
                    "--set camera.up=[1,2: the value of camera.up is not valid TOML"},
        BadOverride{"light.2.position=[1,2,3]",
                    "--set light.2.position=[1,2,3]: light.2 needs type: kind of light"}));

} // namespace
} // namespace vdbeam
