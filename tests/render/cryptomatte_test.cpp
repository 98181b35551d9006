#include "film/cryptomatte.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <fstream>

namespace vdbeam {
namespace {

/// Two clouds, one beside and before the other, and a ball behind.
class CryptomatteOfAScene : public testing::Test {
protected:
  Scene load(const std::string& estimator, const std::vector<std::string>& more = {}) {
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 24\nheight = 16\ncryptomatte = true\n"
           "[camera]\nposition = [0, 0.5, 8]\nlook_at = [0, 0.5, 0]\nfov = 24\n"
           "[[volume]]\nname = \"near\"\nfile = \"" VDBEAM_SOURCE_DIR
           "/data/cloud.vdb\"\nextinction = 6\ntranslate = [0.6, 0, 3]\n"
           "[[volume]]\nfile = \"" VDBEAM_SOURCE_DIR "/data/cloud.vdb\"\nextinction = 12\n"
           "[[mesh]]\nname = \"ball\"\ntype = \"sphere\"\ntranslate = [-2.2, 1.8, -3]\n"
           "[[light]]\ntype = \"distant\"\ndirection = [-1, -1, -1]\n"
           "[render]\npasses = 3\nphotons = 2000\n";
    std::vector<std::string> overrides{"render.estimator=" + estimator};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scene(folder_.file("s.toml"), 1, overrides);
  }
  /// Coverage of an object in each pixel.
  static std::vector<float> coverage(const Image& image, const std::string& name) {
    std::vector<float> sum(image.find("A")->data.size());
    for (const char* layer : {"CryptoObject00.", "CryptoObject01.", "CryptoObject02."})
      for (const auto& [id, share] : {std::pair{"R", "G"}, {"B", "A"}})
        for (std::size_t i = 0; i < sum.size(); ++i)
          if (image.find(std::string(layer) + id)->data[i] == object_id(name))
            sum[i] += image.find(std::string(layer) + share)->data[i];
    return sum;
  }
  test::TempFolder folder_;
};

TEST_F(CryptomatteOfAScene, ObjectsCoverWhatIsOpaque) {
  for (const char* estimator : {"path", "beam"}) {
    const Image image = render(load(estimator)).image;
    const std::vector<float> near = coverage(image, "near"), far = coverage(image, "volume1"),
                             ball = coverage(image, "ball");
    double sums[3] = {};
    for (std::size_t i = 0; i < near.size(); ++i) {
      ASSERT_NEAR(near[i] + far[i] + ball[i], image.find("A")->data[i], 1e-5) << i;
      sums[0] += static_cast<double>(near[i]);
      sums[1] += static_cast<double>(far[i]);
      sums[2] += static_cast<double>(ball[i]);
    }
    for (const double sum : sums)
      EXPECT_GT(sum, 2);
  }
}

/// What one volume covers in front of everything is its opacity alone.
TEST_F(CryptomatteOfAScene, TheNearestCoversAsIfAlone) {
  const Image both = render(load("path")).image;
  Scene scene = load("path");
  scene.volumes.resize(1);
  scene.surfaces.clear();
  const Image alone = render(scene).image;
  const std::vector<float> near = coverage(both, "near");
  double sum = 0, expected = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    sum += static_cast<double>(near[i]);
    expected += static_cast<double>(alone.find("A")->data[i]);
  }
  EXPECT_NEAR(sum, expected, 0.01 * expected);
}

TEST_F(CryptomatteOfAScene, PartsMerge) {
  const Scene scene = load("path");
  const Image whole = render(scene).image;
  const Image merged = merge_partials(test::render_parts(scene, folder_, {{0, 1}, {2, 2}}));
  for (const char* channel : {"CryptoObject00.R", "CryptoObject00.G", "CryptoObject01.A"})
    EXPECT_EQ(merged.find(channel)->data, whole.find(channel)->data) << channel;
  for (const auto& [name, text] : whole.metadata)
    if (name.starts_with("cryptomatte/")) {
      EXPECT_EQ(merged.metadata.at(name), text);
    }
}

} // namespace
} // namespace vdbeam
