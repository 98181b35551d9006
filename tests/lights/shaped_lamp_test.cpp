#include "image/output_formats.h"
#include "lights/light_test_scene.h"
#include "support/degrees.h"
#include "support/ies_text.h"
#include "support/temp_folder.h"

#include <functional>

namespace vdbeam {
namespace {

using namespace test;

/// Point and spot lights with files of the test's own.
class ShapedLamp : public ::testing::Test {
protected:
  LightSettings lamp(LightType type, const Vec3d& position, const Vec3d& direction) const {
    LightSettings settings;
    settings.type = type;
    settings.position = position;
    settings.direction = direction;
    settings.intensity = {5, 3, 2};
    settings.cone_angle = 35;
    settings.cone_falloff = 10;
    return settings;
  }
  /// A profile with two beams and no symmetry.
  std::string profile() const {
    const std::string path = folder_.file("lamp.ies");
    write_bytes(path, ies_text(angles(0, 180, 36), angles(0, 360, 24), [](double v, double h) {
                  const double beam = std::exp(-(v - 40) * (v - 40) / 200);
                  return 3 + 100 * beam * (1.2 + std::cos(h * degrees)) + (v > 150 ? 40 : 0);
                }));
    return path;
  }
  /// Twice as wide as it is high; value(x, y) per channel, from the left and the top in [0, 1].
  std::string picture(const std::function<Rgb(double, double)>& value) const {
    Image image;
    image.width = 64;
    image.height = 32;
    for (int c = 0; c < 3; ++c) {
      ImageChannel channel{std::string(1, "RGB"[c]), {}};
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
          channel.data.push_back(value((x + 0.5) / image.width, (y + 0.5) / image.height)[c]);
      image.channels.push_back(std::move(channel));
    }
    const std::string path = folder_.file("slide.exr");
    write_image(image, path);
    return path;
  }
  /// Bars and a bright spot.
  std::string slide() const {
    return picture([](double x, double y) {
      const float bar = std::fmod(x * 6, 1.0) < 0.5 ? 1.0f : 0.0f;
      return Rgb(bar, 0.2f, (x - 0.6) * (x - 0.6) + (y - 0.4) * (y - 0.4) < 0.01 ? 8.0f : 0.1f);
    });
  }

private:
  TempFolder folder_;
};

/// By a fine grid of points: mean over a box of intensity / distance^2 times the lamp's shape.
Vec3d mean_fluence_by_grid(const MadeLight& made, const Parallelepiped& box) {
  constexpr int n = 60;
  Vec3d sum;
  for (int i = 0; i < n * n * n; ++i) {
    const auto at = [](int k) { return (static_cast<float>(k) + 0.5f) / n; };
    const Vec3f p = box.corner + box.edges[0] * at(i % n) + box.edges[1] * at(i / n % n) +
                    box.edges[2] * at(i / n / n);
    sum += Vec3d(made.light->sample_incident(p, 0, 0).value);
  }
  return sum / static_cast<double>(n * n * n);
}

/// Mean of the flux of photons, per channel.
std::array<Average, 3> fluxes(const Light& light, int count) {
  std::array<Average, 3> result;
  for (int i = 0; i < count; ++i) {
    Rng rng({}, RngStage::test, static_cast<std::uint64_t>(i));
    const Rgb flux = light.emit((i + 0.5) / count, rng).flux;
    for (int c = 0; c < 3; ++c)
      result[static_cast<std::size_t>(c)].add(static_cast<double>(flux[c]));
  }
  return result;
}

/// What shadow rays find, photons bring: into a box beside lamps of every shape.
TEST_F(ShapedLamp, PhotonsGiveTheFluenceThatShadowRaysFind) {
  std::vector<LightSettings> lamps;
  for (const Vec3d& position : {Vec3d{0.3, 2.5, 0.2}, Vec3d{-1.2, 0.8, 0.4}}) {
    LightSettings point = lamp(LightType::point, position, {0.2, -1, 0.1});
    point.ies = profile();
    point.rotation = 30;
    lamps.push_back(point);
    LightSettings spot = lamp(LightType::spot, position, position * -1.0);
    spot.image = slide();
    lamps.push_back(spot);
    spot.ies = profile();
    spot.rotation = -70;
    lamps.push_back(spot);
  }
  const Parallelepiped probe = cube({0.1f, -0.1f, 0.15f}, 0.5f);
  for (const LightSettings& settings : lamps) {
    const MadeLight made(settings, region_of({cube({}, 1), skew_box()}));
    const Vec3d expected = mean_fluence_by_grid(made, probe);
    std::array<Average, 3> fluence;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
      Rng rng({}, RngStage::test, static_cast<std::uint64_t>(i));
      const EmittedPhoton photon = made.light->emit(rng);
      const double share = chord(probe, photon.ray) / volume_of(probe);
      for (int c = 0; c < 3; ++c)
        fluence[static_cast<std::size_t>(c)].add(static_cast<double>(photon.flux[c]) * share);
    }
    for (int c = 0; c < 3; ++c) {
      const Average& found = fluence[static_cast<std::size_t>(c)];
      EXPECT_NEAR(found.mean(), expected[c], 4.5 * found.error() + 3e-3 * expected[c]);
      EXPECT_LT(found.error(), 0.03 * expected[c]);
    }
  }
}

/// A lamp inside the region sends out all of its power, whatever its shape.
TEST_F(ShapedLamp, PowerIsTheFluxInAllDirections) {
  for (const LightType& type : {LightType::point, LightType::spot})
    for (const bool shaped : {false, true}) {
      LightSettings settings = lamp(type, {0.1, 0.2, 0}, {0.3, -1, 0.2});
      settings.power = Rgb(60, 30, 15);
      if (shaped)
        settings.ies = profile();
      const MadeLight made(settings, region_of({cube({}, 1)}));
      const auto flux = fluxes(*made.light, 60000);
      for (int c = 0; c < 3; ++c) {
        const Average& found = flux[static_cast<std::size_t>(c)];
        EXPECT_NEAR(found.mean(), (*settings.power)[c],
                    4.5 * found.error() + 1e-3 * (*settings.power)[c])
            << type.name << shaped;
        EXPECT_LT(found.error(), 0.01 * found.mean());
      }
    }
}

/// Photons are drawn in proportion to the profile: their fluxes hardly differ.
TEST_F(ShapedLamp, PhotonsAreDrawnInProportion) {
  LightSettings settings = lamp(LightType::point, {0.1, 0.2, 0}, {0, -1, 0});
  settings.ies = profile();
  const MadeLight made(settings, region_of({cube({}, 1)}));
  const Average flux = fluxes(*made.light, 20000)[0];
  EXPECT_LT(flux.error() * std::sqrt(flux.count), 0.2 * flux.mean());
}

/// Seen from behind the lamp the picture is upright, its shorter side as wide as the cone; turned
/// it turns counter-clockwise.
TEST_F(ShapedLamp, PictureIsUpright) {
  LightSettings settings = lamp(LightType::spot, {0, 0, 0}, {0, 0, -1}); // x to the right, y up
  settings.intensity = Rgb(1);
  settings.cone_angle = 45;
  settings.cone_falloff = 0;
  settings.image = picture(
      [](double x, double y) { return Rgb(static_cast<float>(x), static_cast<float>(y), 1.0f); });
  const auto at = [&](double rotation, float x, float y) {
    settings.rotation = rotation;
    const MadeLight made(settings, region_of({cube({0, 0, -3}, 1)}));
    const Vec3f point{x, y, -1};
    const Rgb value = made.light->sample_incident(point, 0, 0).value * dot(point, point);
    return value;
  };
  // The width spans twice the cone's: tangents from -2 to 2; rows run down.
  for (const auto& [x, y] :
       {std::pair(0.5f, 0.4f), std::pair(-0.6f, 0.2f), std::pair(0.1f, -0.7f)}) {
    const Rgb value = at(0, x, y);
    EXPECT_NEAR(value.x, 0.5f + x / 4, 1e-3);
    EXPECT_NEAR(value.y, 0.5f - y / 2, 1e-3);
    const Rgb turned = at(90, -y, x);
    EXPECT_NEAR(turned.x, value.x, 1e-3);
    EXPECT_NEAR(turned.y, value.y, 1e-3);
  }
  EXPECT_EQ(at(0, 0.9f, 0.9f), Rgb(0)); // beyond the cone
}

/// C0 is to the right, C90 above; nadir is the lamp's direction.
TEST_F(ShapedLamp, PlanesOfTheProfile) {
  const TempFolder folder;
  LightSettings settings = lamp(LightType::point, {0, 0, 0}, {0, 0, -1});
  settings.intensity = Rgb(1);
  settings.ies = folder.file("planes.ies");
  write_bytes(settings.ies, ies_text({0, 90}, angles(0, 360, 4),
                                     [](double v, double h) { return v == 0 ? 1000 : 400 - h; }));
  const MadeLight made(settings, region_of({cube({0, 0, -3}, 1)}));
  const auto at = [&](const Vec3f& point) {
    return made.light->sample_incident(point, 0, 0).value.x;
  };
  EXPECT_NEAR(at({0, 0, -1}), 1, 1e-5);
  EXPECT_NEAR(at({1, 0, -1e-5f}), 0.4, 1e-3);
  EXPECT_NEAR(at({0, 1, -1e-5f}), 0.31, 1e-3);
  EXPECT_NEAR(at({-1, 0, -1e-5f}), 0.22, 1e-3);
  EXPECT_NEAR(at({0, -1, -1e-5f}), 0.13, 1e-3);
  EXPECT_EQ(at({0, 0, 1}), 0);
}

/// A light that shines along `up` has a frame too.
TEST_F(ShapedLamp, AnyDirectionWillDo) {
  for (const Vec3d& direction : {Vec3d{0, -1, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 2, 3}}) {
    LightSettings settings = lamp(LightType::spot, {0, 0, 0}, direction);
    settings.image = slide();
    const MadeLight made(settings, region_of({cube(Vec3f(normalize(direction)) * 3, 1)}));
    EXPECT_GT(max_component(made.light->power()), 0);
    EXPECT_TRUE(std::isfinite(mean_component(made.light->power())));
  }
}

} // namespace
} // namespace vdbeam
