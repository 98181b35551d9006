#include "keys/scene_keys.h"

#include "scene_fixture.h"
#include "text/text.h"

#include <set>
#include <sstream>

namespace vdbeam {
namespace {

TEST(SceneKeys, NamesAreUniqueAndDocumented) {
  std::set<std::string> paths;
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(paths.insert(key_path(key, 0)).second) << key.name;
    EXPECT_FALSE(key.doc.empty()) << key.name;
    EXPECT_EQ(key.kind == KeyKind::choice, !key.choices.empty()) << key.name;
  }
}

TEST(SceneKeys, DefaultsAreValid) {
  Scene scene;
  scene.volumes.emplace_back();
  scene.surfaces.emplace_back();
  scene.lights.emplace_back();
  scene.layers.emplace_back();
  scene.instances.emplace_back();
  for (const SceneKey& key : scene_keys())
    if (key.get && !key.required) {
      EXPECT_FALSE(key.complaint(key.get(scene, 0)).has_value()) << key.name;
    }
}

TEST(SceneKeys, ReferenceHasTheTableOfEverySection) {
  std::ifstream stream(VDBEAM_SOURCE_DIR "/docs/reference/scene.md");
  std::stringstream text;
  text << stream.rdbuf();
  for (const SceneSection section :
       {SceneSection::image, SceneSection::camera, SceneSection::volume, SceneSection::phase,
        SceneSection::emission, SceneSection::instance, SceneSection::mesh, SceneSection::material,
        SceneSection::light, SceneSection::layer, SceneSection::render})
    EXPECT_NE(text.str().find(key_table_markdown(section)), std::string::npos)
        << "docs/reference/scene.md lacks this table of " << section_name(section) << ":\n"
        << key_table_markdown(section);
}

TEST(SceneKeys, HelpListsEveryKey) {
  const std::string text = key_tables_text(100);
  for (const SceneKey& key : scene_keys())
    EXPECT_NE(text.find("  " + key.name + " "), std::string::npos) << key.name;
}

TEST(Text, NearestWord) {
  const std::vector<std::string> words{"extinction", "albedo", "density", "g"};
  EXPECT_EQ(nearest_word("extintion", words), "extinction");
  EXPECT_EQ(nearest_word("dnesity", words), "density");
  EXPECT_EQ(nearest_word("alb", words), "albedo");
  EXPECT_EQ(nearest_word("temperature", words), std::nullopt);
  // One letter is nearer than an ending.
  EXPECT_EQ(nearest_word("velocityscale", {"velocity", "velocity_scale"}), "velocity_scale");
  EXPECT_EQ(nearest_word("velocityscale", {"velocity", "scale"}), "velocity");
}

TEST(Text, Durations) {
  EXPECT_EQ(parse_duration("2m30s"), 150);
  EXPECT_EQ(parse_duration("0.5s"), 0.5);
  for (const char* bad : {"", "s", "5x", "5s5m", "5s5s", "-5s", "1e3", "inf", "5 s", "m5"})
    EXPECT_EQ(parse_duration(bad), std::nullopt) << bad;
  EXPECT_EQ(format_duration(12.34), "12.3s");
  EXPECT_EQ(format_duration(200), "3m20s");
  EXPECT_EQ(format_duration(3720), "1h02m");
}

} // namespace
} // namespace vdbeam
