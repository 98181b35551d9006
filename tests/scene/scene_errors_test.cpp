#include "scene_fixture.h"

namespace vdbeam {
namespace {

struct BadScene {
  const char* text;
  const char* message;
};
void PrintTo(const BadScene& scene, std::ostream* stream) {
  *stream << scene.text;
}

class BadSceneFile : public test::SceneTest, public ::testing::WithParamInterface<BadScene> {};

TEST_P(BadSceneFile, GivesTheExactLine) {
  EXPECT_EQ(error_of(GetParam().text), GetParam().message);
}

#define VOLUME "[[volume]]\nfile = 'cloud.vdb'\n"

INSTANTIATE_TEST_SUITE_P(
    Syntax, BadSceneFile,
    ::testing::Values(
        BadScene{"[image]\nwidth = 1\nwidth = 2\n",
                 "s.toml:3: not valid TOML: cannot redefine existing integer 'width'; it is there "
                 "already, in line 2"},
        BadScene{"[[light]]\ntype = 'point'\n[light]\ntype = 'point'\n",
                 "s.toml:3: not valid TOML: cannot redefine existing array 'light' as table; write "
                 "[[light]], in double brackets"},
        BadScene{"[[light]]\ntype = point\n",
                 "s.toml:2: not valid TOML: could not determine value type; a text needs quotes: "
                 "\"...\""},
        BadScene{"[camera]\nfov = 24,5\n",
                 "s.toml:2: not valid TOML: expected a comment or whitespace, saw ','; decimals "
                 "have a point: 24.5"},
        BadScene{"[[volume]]\nfile = \"C:\\shot\\cloud.vdb\"\n",
                 "s.toml:2: not valid TOML: unknown escape sequence '\\s'; write a path with / or "
                 "in single quotes: 'C:\\shot\\cloud.vdb'"},
        BadScene{"[light]\ntype = 'point'\n[light]\ntype = 'point'\n",
                 "s.toml:3: not valid TOML: cannot redefine existing table 'light'; write "
                 "[[light]], in double brackets, for each of them"},
        BadScene{"[[light]]\ntype = 'distant'\nirradiance = 5, 5, 5\n",
                 "s.toml:3: not valid TOML: expected a comment or whitespace, saw ','; a list "
                 "needs brackets: [5, 5, 5]"},
        BadScene{"[[light]]\ntype = 'distant'\nvisible = False\n",
                 "s.toml:3: not valid TOML: expected 'false', saw 'F'; write false, in small "
                 "letters"},
        BadScene{"\n\n[image\n", "s.toml:3: not valid TOML: expected ']', saw '\\n'"}));

INSTANTIATE_TEST_SUITE_P(
    UnknownKeys, BadSceneFile,
    ::testing::Values(
        BadScene{"[image]\nwidht = 1\n", "s.toml:2: unknown key image.widht; did you mean width?"},
        BadScene{VOLUME "extintion = 2\n",
                 "s.toml:3: unknown key volume.0.extintion; did you mean extinction?"},
        BadScene{VOLUME "phase = { tpye = 'mie' }\n",
                 "s.toml:3: unknown key volume.0.phase.tpye; did you mean type?"},
        BadScene{"[image]\nheight = 1\n\n[rendr]\n",
                 "s.toml:4: unknown key rendr; did you mean render?"},
        BadScene{"width = 1\n", "s.toml:1: unknown key width; did you mean image.width?"},
        BadScene{"[camera]\nseed = 1\n",
                 "s.toml:2: unknown key camera.seed; seed is a key of render"},
        BadScene{"[image]\nzzz = 1\n",
                 "s.toml:2: unknown key image.zzz; vdbeam help scene image lists its keys"},
        BadScene{"[[layer]]\nzzz = 1\n",
                 "s.toml:2: unknown key layer.0.zzz; its keys are name, precision and compression"},
        BadScene{"[render]\nsamples = 4\n",
                 "s.toml:2: unknown key render.samples; did you mean passes?"},
        BadScene{"[render]\nspp = 4\n", "s.toml:2: unknown key render.spp; did you mean passes?"},
        BadScene{"[image]\nSize = 4\n",
                 "s.toml:2: unknown key image.Size; did you mean width and height?"},
        BadScene{VOLUME "phase = { type = 'henyey_greenstein', anisotropy = 0.5 }\n",
                 "s.toml:3: unknown key volume.0.phase.anisotropy; did you mean g?"},
        BadScene{
            "[[light]]\ntype = 'distant'\ncolor = [1, 0.5, 0]\n",
            "s.toml:3: unknown key light.0.color; colour and strength of a light are one key: "
            "irradiance of a distant light, intensity or power of a point or spot light, radiance "
            "of "
            "an environment or sky, e.g. irradiance = [5, 4, 3]; kelvin and exposure multiply it"},
        BadScene{"[[light]]\ntype = 'distant'\nelevation = 50\n",
                 "s.toml:3: unknown key light.0.elevation; direction = [x, y, z] is the way that a "
                 "distant or spot light travels"},
        BadScene{"zzz = 1\n", "s.toml:1: unknown key zzz; the tables are image, camera, volume, "
                              "instance, "
                              "mesh, light, layer and render"}));

INSTANTIATE_TEST_SUITE_P(
    Types, BadSceneFile,
    ::testing::Values(
        BadScene{"[image]\nwidth = 'wide'\n",
                 "s.toml:2: image.width must be a whole number, got \"wide\""},
        BadScene{"[image]\nwidth = 1.5\n", "s.toml:2: image.width must be a whole number, got 1.5"},
        BadScene{"[camera]\nfov = true\n", "s.toml:2: camera.fov must be a number, got true"},
        BadScene{"[camera]\nup = [0, 1]\n", "s.toml:2: camera.up must be 3 numbers, got [0, 1]"},
        BadScene{"[camera]\nup = [0, 1, 'x']\n",
                 "s.toml:2: camera.up must be 3 numbers, got [0, 1, \"x\"]"},
        BadScene{"[camera]\nposition = '0,0,5'\n",
                 "s.toml:2: camera.position must be 3 numbers, got \"0,0,5\"; did you mean [0, 0, "
                 "5]?"},
        BadScene{"[render]\ntime = '5min'\n",
                 "s.toml:2: render.time must be seconds or a text like \"90s\", \"5m\" or "
                 "\"1h30m\" or \"none\", got \"5min\"; did you mean 5m?"},
        BadScene{"[image]\ndeep = 'True'\n",
                 "s.toml:2: image.deep must be true or false, got \"True\"; did you mean true?"},
        BadScene{"[camera]\nup = 1\n", "s.toml:2: camera.up must be 3 numbers, got 1"},
        BadScene{VOLUME "albedo = 'white'\n",
                 "s.toml:3: volume.0.albedo must be 3 numbers (red, green, blue) or one for all, "
                 "got \"white\""},
        BadScene{VOLUME "transform = [1, 2]\n",
                 "s.toml:3: volume.0.transform must be 12 numbers, got [1, 2]"},
        BadScene{"[[volume]]\nfile = 3\n", "s.toml:2: volume.0.file must be a path, got 3"},
        BadScene{"[render]\ntime = '5x'\n",
                 "s.toml:2: render.time must be seconds or a text like \"90s\", \"5m\" or "
                 "\"1h30m\" or \"none\", got \"5x\""},
        BadScene{"[render]\nphotons = 'many'\n",
                 "s.toml:2: render.photons must be a whole number or \"auto\", got \"many\""},
        BadScene{"image = 3\n", "s.toml:1: image must be a table: write [image], got 3"},
        BadScene{"[volume]\nfile = 'cloud.vdb'\n",
                 "s.toml:1: volume must be a list: write [[volume]] for each volume, got a table"},
        BadScene{"light = [1]\n", "s.toml:1: light.0 must be a table, got 1"},
        BadScene{VOLUME "phase = 3\n",
                 "s.toml:3: volume.0.phase must be a table, e.g. { type = \"henyey_greenstein\", "
                 "g = 0.6 }, got 3"}));

INSTANTIATE_TEST_SUITE_P(
    Ranges, BadSceneFile,
    ::testing::Values(
        BadScene{"[image]\nwidth = 0\n", "s.toml:2: image.width must lie in [1, 65536], got 0"},
        BadScene{"[camera]\nfov = 180\n", "s.toml:2: camera.fov must lie in (0, 180), got 180"},
        BadScene{"[camera]\nfov = nan\n", "s.toml:2: camera.fov must be finite, got nan"},
        BadScene{"[camera]\nposition = [0, inf, 0]\n",
                 "s.toml:2: camera.position must be finite, got [0, inf, 0]"},
        BadScene{VOLUME "extinction = -1\n",
                 "s.toml:3: volume.0.extinction must be at least 0, got -1"},
        BadScene{VOLUME "albedo = [0.5, 1.2, 1]\n",
                 "s.toml:3: volume.0.albedo must lie in [0, 1], got [0.5, 1.2, 1]"},
        BadScene{VOLUME "phase = { type = 'henyey_greenstein', g = 1.2 }\n",
                 "s.toml:3: volume.0.phase.g must lie in (-1, 1), got 1.2"},
        BadScene{VOLUME "phase = { type = 'two_lobe', g2 = 0.99999999999 }\n",
                 "s.toml:3: volume.0.phase.g2 must lie in (-1, 1), got 0.99999999999"},
        BadScene{VOLUME "phase = { type = 'mie', droplet_diameter = 3 }\n",
                 "s.toml:3: volume.0.phase.droplet_diameter must lie in [5, 50], got 3"},
        BadScene{"[render]\npasses = 0\n", "s.toml:2: render.passes must be at least 1, got 0"},
        BadScene{"[render]\npasses = 3000000000\n",
                 "s.toml:2: render.passes must be at most 2147483647, got 3000000000"},
        BadScene{"[render]\ntime = 0\n", "s.toml:2: render.time must be greater than 0, got 0"},
        BadScene{"[render]\nalpha = 0\n", "s.toml:2: render.alpha must lie in (0, 1], got 0"},
        BadScene{"[render]\nseed = -1\n", "s.toml:2: render.seed must be at least 0, got -1"}));

INSTANTIATE_TEST_SUITE_P(
    Choices, BadSceneFile,
    ::testing::Values(
        BadScene{"[render]\nestimator = 'beams'\n",
                 "s.toml:2: render.estimator must be auto, beam, gather, march or path, got "
                 "\"beams\"; did you "
                 "mean beam?"},
        BadScene{
            "[[light]]\ntype = 'directional'\n",
            "s.toml:2: light.0.type must be distant, point, spot, environment, sky, atmosphere or "
            "sun, got \"directional\"; did you mean distant?"},
        BadScene{
            "[[light]]\ntype = 'dome'\n",
            "s.toml:2: light.0.type must be distant, point, spot, environment, sky, atmosphere "
            "or sun, got \"dome\"; did you mean environment?"},
        BadScene{
            "[[light]]\ntype = 'area'\n",
            "s.toml:2: light.0.type must be distant, point, spot, environment, sky, atmosphere "
            "or sun, got \"area\"; a light with an area is a [[mesh]] with material = { type = "
            "\"emissive\", radiance = 10 }"},
        BadScene{"[[mesh]]\ntype = 'cube'\n",
                 "s.toml:2: mesh.0.type must be file, sphere, quad, disk, plane, box or cylinder, "
                 "got \"cube\"; did you mean box?"},
        BadScene{"[[mesh]]\ntype = 'cone'\n",
                 "s.toml:2: mesh.0.type must be file, sphere, quad, disk, plane, box or cylinder, "
                 "got \"cone\"; solids come from files (.obj, .ply, .gltf, .glb)"},
        BadScene{"[[mesh]]\ntype = 'plane'\nmaterial = 'emissive'\n",
                 "s.toml:3: mesh.0.material.type must not emit on a plane, which has no end: use "
                 "type = \"quad\" with a scale, or a light of type \"environment\""},
        BadScene{"[image]\nworking_space = 'ACEScg'\n",
                 "s.toml:2: image.working_space must be rec709, rec2020, acescg or aces2065_1, got "
                 "\"ACEScg\"; did you mean acescg?"},
        BadScene{VOLUME "phase = 'hg'\n",
                 "s.toml:3: volume.0.phase.type must be isotropic, henyey_greenstein, rayleigh, "
                 "two_lobe or mie, got \"hg\"; did you mean henyey_greenstein?"}));

INSTANTIATE_TEST_SUITE_P(
    Consistency, BadSceneFile,
    ::testing::Values(
        BadScene{"\n[[volume]]\nextinction = 3\n",
                 "s.toml:2: volume.0 needs file: VDB file; ####, %04d or $F4 stands for the frame "
                 "number"},
        BadScene{"[[light]]\n", "s.toml:1: light.0 needs type: kind of light"},
        BadScene{"[[volume]]\nfile = 'fog.vdb'\n",
                 "s.toml:2: volume.0.file: there is no file fog.vdb"},
        BadScene{"[[volume]]\nfile = 'clowd.vdb'\n",
                 "s.toml:2: volume.0.file: there is no file clowd.vdb; did you mean cloud.vdb?"},
        BadScene{
            "[[volume]]\nfile = '$SHOT/cloud.vdb'\n",
            "s.toml:2: volume.0.file: there is no file $SHOT/cloud.vdb; $SHOT is not expanded: "
            "write out the path"},
        BadScene{"[[volume]]\nfile = '~/cloud.vdb'\n",
                 "s.toml:2: volume.0.file: there is no file ~/cloud.vdb; ~ is not expanded: write "
                 "out the path"},
        BadScene{"[[volume]]\nfile = 'shot/cloud.vdb'\n",
                 "s.toml:2: volume.0.file: there is no file shot/cloud.vdb, nor its folder"},
        BadScene{"[[volume]]\nfile = '.'\n",
                 "s.toml:2: volume.0.file: there is no file ., which is a folder"},
        BadScene{
            "[[mesh]]\nfile = 'ship.abc'\n",
            "s.toml:2: mesh.0.file: ship.abc cannot be read: a mesh is an .obj, .ply, .gltf or "
            ".glb file"},
        BadScene{"[[light]]\ntype = 'environment'\nimage = 'sky.exr'\n",
                 "s.toml:3: light.0.image: there is no file sky.exr"},
        BadScene{"[[light]]\ntype = 'distant'\nintensity = 3\n",
                 "s.toml:3: light.0.intensity does not belong to type \"distant\", only to point "
                 "and spot"},
        BadScene{VOLUME "phase = { g = 0.5 }\n",
                 "s.toml:3: volume.0.phase.g does not belong to type \"isotropic\", only to "
                 "henyey_greenstein and two_lobe"},
        BadScene{"[[light]]\ntype = 'distant'\ndirection = [0, 0, 0]\n",
                 "s.toml:3: light.0.direction must not be [0, 0, 0]"},
        BadScene{"[[light]]\ntype = 'spot'\ncone_angle = 3\ncone_falloff = 4\n",
                 "s.toml:4: light.0.cone_falloff must be at most cone_angle (3), got 4"},
        BadScene{VOLUME "scale = [1, 0, 1]\n",
                 "s.toml:3: volume.0.scale must not be 0 in any direction, got [1, 0, 1]"},
        BadScene{VOLUME "translate = [1, 0, 1]\ntransform = [1,0,0,0, 0,1,0,0, 0,0,1,0]\n",
                 "s.toml:4: volume.0.transform excludes translate: write one or the other"},
        BadScene{"[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]\n",
                 "s.toml:3: camera.look_at must differ from camera.position"},
        BadScene{"[camera]\nup = [0, 0, 0]\n", "s.toml:2: camera.up must not be [0, 0, 0]"},
        BadScene{"[camera]\nup = [0, 0, 2]\n",
                 "s.toml:2: camera.up must not be parallel to the direction from position to "
                 "look_at"},
        BadScene{"[render]\nkernel = 'fixed'\n",
                 "s.toml:2: render.kernel is \"fixed\": render.radius is needed too"},
        BadScene{"[render]\nmin_radius = 2\nmax_radius = 1\n",
                 "s.toml:2: render.min_radius must be at most render.max_radius (1), got 2"}));

#undef VOLUME

using SceneErrors = test::SceneTest;

TEST_F(SceneErrors, MissingFrameNamesTheFramesThereAre) {
  write("s.0001.vdb", "");
  write("s.0002.vdb", "");
  write("s.0005.vdb", "");
  const std::string path = write("q.toml", "[[volume]]\nfile = 's.####.vdb'\n");
  try {
    load_scene(path, 3);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(without_folder(error.what()),
              "q.toml:2: volume.0.file: there is no file s.0003.vdb; there are frames 1,2,5");
  }
}

TEST_F(SceneErrors, WrongPlaceholderNamesTheSequenceBesideIt) {
  for (const char* name : {"s.0001.vdb", "s.0002.vdb", "s.0005.vdb"})
    write(name, "");
  for (const char* name : {"s.*.vdb", "s.<UDIM>.vdb", "s.<frame>.vdb", "s.###.vdb", "s.$F.vdb"})
    EXPECT_EQ(error_of("[[volume]]\nfile = '" + std::string(name) + "'\n"),
              "s.toml:2: volume.0.file: there is no file " + std::string(name) +
                  "; there is s.####.vdb, frames 1,2,5");
}

TEST_F(SceneErrors, WhatIsNoSceneIsNamed) {
  const auto error_of_file = [this](const std::string& path) {
    try {
      load_scene(path);
    } catch (const InputError& error) {
      return without_folder(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_of_file(write("a.exr", "\x76\x2f\x31\x01...")),
            "a.exr: is an OpenEXR image, not a scene file or VDB");
  EXPECT_EQ(error_of_file(write("a.png", "\x89PNG...")),
            "a.png: is a PNG image, not a scene file or VDB");
  EXPECT_EQ(error_of_file("/dev/null"), "/dev/null: is a device, not a scene file or VDB");
  EXPECT_EQ(error_of_file(file("b.exr")), "there is no file b.exr; did you mean a.exr?");
}

TEST_F(SceneErrors, WhatCannotBeMeantIsNoted) {
  const std::string volume = "[[volume]]\nfile = 'cloud.vdb'\n";
  const std::string light = "[[light]]\ntype = 'point'\n";
  const auto notes = [&](const std::string& text) {
    std::string all;
    for (const std::string& note : load(text).notes)
      all += without_folder(note) + "\n";
    return all;
  };
  EXPECT_EQ(notes(volume + light + "[camera]\nfov = 24\n"), "");
  EXPECT_EQ(notes(volume + light + "[camera]\nfov = 0.42\n"),
            "s.toml:6: camera.fov = 0.42 is in degrees; if radians are meant, write 24.1\n");
  EXPECT_EQ(notes(volume + light + "[camera]\nshutter_close = 180\n"),
            "s.toml:6: camera.shutter_close = 180 is in frames; if degrees are meant, write 0.5\n");
  EXPECT_EQ(notes(volume + light + "[camera]\nshutter_open = -0.25\nshutter_close = 0.25\n"), "");
  EXPECT_EQ(notes(volume + light + "[render]\ntarget_error = 1\n"),
            "s.toml:6: render.target_error = 1 is reached by almost any image after a few passes; "
            "a clean image has about 0.001\n");
  EXPECT_EQ(notes(volume + light + "[[layer]]\nname = 'depth'\n"),
            "s.toml: the image will have no alpha, since no [[layer]] is \"alpha\"; add one for "
            "compositing\n");
  EXPECT_EQ(notes(volume + light + "[[layer]]\nname = 'depth'\n[[layer]]\nname = 'alpha'\n"), "");
  EXPECT_EQ(notes(volume + "time = { speed = 2 }\n" + light),
            "s.toml:2: volume.0.time does nothing: file names a single file, not a sequence like "
            "smoke.####.vdb\n");
  EXPECT_EQ(notes(volume + "emission = { intensity = 'flame', kelvin = 900 }\n" + light),
            "s.toml:3: volume.0.emission.kelvin does nothing without a temperature grid\n");
  EXPECT_EQ(notes(volume + "emission = { intensity = 'flame', temperature = 't', kelvin = 900 }\n" +
                  light),
            "");
  EXPECT_EQ(notes(volume + "emission = { intensity = 'flame', kelvin = 1 }\n" + light), "");
}

TEST_F(SceneErrors, FirstMistakeOfTheFileIsTold) {
  EXPECT_EQ(error_of("[render]\nseed = -1\n[camera]\nfov = 0\n"),
            "s.toml:2: render.seed must be at least 0, got -1");
}

TEST_F(SceneErrors, UnreadableFiles) {
  EXPECT_THROW(load_scene(file("none.toml")), InputError);
  EXPECT_THROW(load_scene(folder_.string()), InputError);
  std::string noise;
  for (int i = 0; i < 5000; ++i)
    noise += static_cast<char>(i * 37 % 251);
  EXPECT_THROW(load_scene(write("noise.toml", noise)), InputError);
  EXPECT_THROW(load_scene(write("deep.toml", "a = " + std::string(100000, '['))), InputError);
}

TEST_F(SceneErrors, KeysOfManyDotsAreRefusedBeforeTheyAreParsed) {
  std::string dots = "a";
  for (int i = 0; i < 200000; ++i)
    dots += ".a";
  const std::string refused =
      "a key has more than 16 names between dots; no key of a scene has more than 4";
  EXPECT_EQ(error_of("# x\n" + dots + " = 1\n"), "s.toml:2: " + refused);
  EXPECT_EQ(error_of("[" + dots + "]\n"), "s.toml:1: " + refused);
  EXPECT_EQ(error_of("x = \"\"\"\n\n\"\"\"\ny = { " + dots + " = 1 }\n"), "s.toml:4: " + refused);
  const std::string scene = write("s.toml", "[render]\npasses = 1\n");
  EXPECT_THROW(load_scene(scene, 1, {dots + "=1"}), InputError);
  EXPECT_THROW(load_scene(scene, 1, {"volume.0={" + dots + "=1}"}), InputError);
  // Dots of texts, comments and numbers are none of keys.
  EXPECT_NO_THROW(load("# " + std::string(1000, '.') +
                       "\n[[volume]]\nfile = 'cloud.vdb'\nname = '" + std::string(1000, '.') +
                       "'\nalbedo = [0.5, 0.5, 0.5]\n"));
}

TEST_F(SceneErrors, ReasonsOutliveLongPaths) {
  const std::string folder(200, 'f');
  std::filesystem::create_directory(folder_ / folder);
  const std::string path = write(folder + "/s.toml", "[render]\nseed = -1\n");
  try {
    load_scene(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .ends_with("s.toml:2: render.seed must be at least 0, got "
                               "-1"))
        << error.what();
  }
}

TEST_F(SceneErrors, MessagesAreOneLine) {
  const std::string message = error_of("\"a\\nb\" = 1\n");
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_NE(message.find("s.toml:1"), std::string::npos);
}

TEST(ValidateScene, ChecksScenesFilledByHand) {
  Scene scene;
  scene.volumes.emplace_back().file = "x.vdb";
  scene.lights.emplace_back();
  EXPECT_NO_THROW(validate_scene(scene));
  scene.volumes[0].phase.g = -1;
  try {
    validate_scene(scene);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "scene: volume.0.phase.g must lie in (-1, 1), got -1");
  }
  scene.volumes[0].phase.g = 0;
  scene.render.radius = -1;
  EXPECT_THROW(validate_scene(scene), InputError);
  scene.render.radius = 0;
  scene.lights[0].type = {"lantern"};
  EXPECT_THROW(validate_scene(scene), InputError);
  scene.lights[0].type = LightType::distant;
  scene.volumes[0].file = "";
  EXPECT_THROW(validate_scene(scene), InputError);
}

} // namespace
} // namespace vdbeam
