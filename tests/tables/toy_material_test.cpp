// A new material is one file and one line: this is the file.
#include "materials/diffuse.h"
#include "materials/material_table.h"
#include "math/color.h"
#include "support/surface_scene.h"
#include "tables/toy_support.h"

#include <array>

namespace vdbeam {
namespace {

constexpr std::string_view toy_material_keys[] = {"reflectance"};

/// Diffuse with half its reflectance as albedo.
class Slate final : public Diffuse {
public:
  explicit Slate(const MaterialSettings& settings) : Diffuse(half(settings)) {}

private:
  static MaterialSettings half(MaterialSettings settings) {
    settings.albedo = settings.reflectance * 0.5f;
    return settings;
  }
};

const MaterialKind slate_material{
    .name = "slate",
    .help = "diffuse and rather dark",
    .keys = toy_material_keys,
    .colored = [](const MaterialSettings& settings) { return !is_grey(settings.reflectance); },
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Slate>(settings);
    }};

} // namespace

std::span<const MaterialKind* const> material_table() {
  static constexpr std::array table{
      &diffuse_material,  &mirror_material,  &conductor_material,      &dielectric_material,
      &emissive_material, &holdout_material, &shadow_catcher_material, &slate_material};
  return table;
}

namespace {

using test::holds;
using test::key;

MaterialSettings slate(const Rgb& reflectance) {
  MaterialSettings settings;
  settings.type = {"slate"};
  settings.reflectance = reflectance;
  return settings;
}

/// A wall across the fog, lit from the camera's side.
test::MemoryScene wall_of(const MaterialSettings& material) {
  test::MemoryScene scene = test::lit_by(LightType::point, 1);
  scene.scene.lights[0].position = {0, 2, 2};
  test::surfaces::add_surface(scene, SurfaceShape::quad, test::surfaces::scaled(2), material);
  return scene;
}

TEST(ToyMaterial, IsInKeysAndHelp) {
  EXPECT_TRUE(holds(key(SceneSection::material, "type").choices, "slate"));
  EXPECT_EQ(key(SceneSection::material, "reflectance").types,
            (std::vector<std::string>{"mirror", "conductor", "slate"}));
  EXPECT_FALSE(holds(key(SceneSection::material, "albedo").types, "slate"));
  EXPECT_NE(key_tables_text(100).find("slate: diffuse and rather dark"), std::string::npos);
  EXPECT_NE(key_table_markdown(SceneSection::material).find("`slate`"), std::string::npos);
}

TEST(ToyMaterial, IsReadAndWritten) {
  Scene scene;
  scene.surfaces.emplace_back();
  const SceneKey& type = key(SceneSection::material, "type");
  type.set(scene, 0, std::string("slate")); // the name of the table is kept, not this one
  EXPECT_EQ(scene.surfaces[0].material.type, (MaterialType{"slate"}));
  EXPECT_EQ(type.format(type.get(scene, 0)), "\"slate\"");
}

TEST(ToyMaterial, OtherNamesAreErrors) {
  Scene scene;
  scene.surfaces.emplace_back().shape = SurfaceShape::quad;
  scene.surfaces[0].material.type = {"slate"};
  EXPECT_EQ(test::complaint_about(scene), "");
  scene.surfaces[0].material.type = {"slat"};
  EXPECT_NE(test::complaint_about(scene).find("did you mean slate?"), std::string::npos);
  EXPECT_THROW(make_material(scene.surfaces[0].material, 1), InputError);
}

TEST(ToyMaterial, IsPlanned) {
  const test::TestFrame grey(wall_of(slate(Rgb(1)))), black(wall_of(slate(Rgb(0)))),
      red(wall_of(slate({1, 0, 0})));
  EXPECT_TRUE(grey.plan.needs(Stage::surface_photons));
  EXPECT_FALSE(black.plan.needs(Stage::surface_photons));
  EXPECT_FALSE(grey.plan.needs(Stage::photon_color));
  EXPECT_TRUE(red.plan.needs(Stage::photon_color));
}

TEST(ToyMaterial, EveryEstimatorShadesIt) {
  test::expect_same_picture(wall_of(slate(Rgb(0.8f))), wall_of(test::surfaces::diffuse(0.4)));
  EXPECT_GT(test::first_pass(wall_of(slate(Rgb(0.8f))), EstimatorType::path).total(27).x,
            1.2f * test::first_pass(wall_of(slate(Rgb(0.4f))), EstimatorType::path).total(27).x);
}

} // namespace
} // namespace vdbeam
