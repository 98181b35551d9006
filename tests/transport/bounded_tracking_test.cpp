#include "medium/flight.h"
#include "medium/optical_depth.h"
#include "support/chi_squared.h"
#include "support/exact_field.h"
#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr int flights = 20000;
constexpr int bins = 40;
/// Goes through cells with peaks, and past these.
const Ray beside{{-0.7f, -0.44f, -0.43f}, normalize(Vec3f(1, 0.03f, 0.02f))};

/// Every 8^3 cell has one voxel of density `peak` amid noise below 1, so that its majorant is
/// loose.
Medium loose_medium(double peak, float extinction, bool overlapping = false) {
  const auto value = [peak](int i, int j, int k) {
    const bool is_peak = i % 8 == 4 && j % 8 == 4 && k % 8 == 4;
    return is_peak ? peak : test::lattice_noise(i, j, k, 3);
  };
  std::vector<Volume> volumes;
  volumes.push_back(
      test::make_volume(test::closed_field({3, 3, 3}, value), 1.0f / 24, Vec3f(-0.5f), extinction));
  if (overlapping)
    volumes.push_back(test::make_volume(test::closed_field({2, 2, 2}, value), 1.0f / 20,
                                        Vec3f(-0.45f), extinction / 2));
  return test::make_medium(std::move(volumes), {Vec3f(-0.6f), Vec3f(0.6f)});
}

/// A walk of one flight, up to its first real collision.
struct OneFlight {
  static constexpr bool bounds_null_collisions = true;

  void meet(Flight&, const Collision&) { ++tentative; }
  bool pass(Flight&) { return true; }
  bool collide(Flight&, const Collision& hit) {
    real = hit;
    return false;
  }
  bool leave(Flight&) { return false; }

  Collision real = {};
  std::uint64_t tentative = 0;
};

/// The first real collision; `tentative` counts the others too.
Collision first_real(const Medium& medium, const Segment& segment, Rgb& weight, Rng& rng,
                     std::uint64_t& tentative) {
  OneFlight walker;
  Flight flight(rng, weight);
  flight.start(medium, segment);
  for (bool goes_on = advance_flight(flight, walker); goes_on;)
    goes_on = step_flight(medium, flight, walker);
  rng = flight.rng;
  weight = flight.throughput;
  tentative += walker.tentative;
  return walker.real;
}

/// Distances follow the exact optical depth whether they are found among few tentative collisions
/// or after many, in one volume and in two.
TEST(BoundedTracking, FlightsFollowTheIntegral) {
  for (const double peak : {1.0, 1e3, 1e5})
    for (const bool overlapping : {false, true}) {
      SCOPED_TRACE(testing::Message() << peak << " " << overlapping);
      const Medium medium = loose_medium(peak, 3, overlapping);
      std::vector<double> counts(bins + 1), expected(bins + 1);
      double before = 1;
      for (std::size_t b = 0; b < bins; ++b) {
        const double after = static_cast<double>(
            exact_transmittance(medium, {beside, 0, 1.5f * static_cast<float>(b + 1) / bins}).x);
        expected[b] = (before - after) * flights;
        before = after;
      }
      expected[bins] = before * flights;
      Rng rng({1, 0, 0}, RngStage::test, 1);
      std::uint64_t tentative = 0;
      for (int n = 0; n < flights; ++n) {
        Rgb weight(1);
        const Collision hit = first_real(medium, {beside, 0, 1.5f}, weight, rng, tentative);
        ++counts[hit.volume ? static_cast<std::size_t>(hit.t / 1.5f * bins) : bins];
      }
      EXPECT_GT(test::chi_squared_test(counts, expected), test::family_level(6));
      // With the looser majorants most flights take the greatest number of collisions.
      EXPECT_EQ(tentative > flights * std::uint64_t{most_tentative_collisions} / 2, peak > 1);
    }
}

TEST(BoundedTracking, WeightsOfColoursAreUnbiased) {
  Medium medium = loose_medium(1e5, 3);
  medium.volumes[0].channel_scale = {1, 0.4f, 0.1f};
  medium.chromatic = true;
  const Rgb through = exact_transmittance(medium, {beside});
  Rng rng({1, 0, 0}, RngStage::test, 2);
  test::Samples passed[3];
  std::uint64_t tentative = 0;
  for (int n = 0; n < flights; ++n) {
    Rgb weight(1);
    const bool real = first_real(medium, {beside}, weight, rng, tentative).volume != nullptr;
    for (int c = 0; c < 3; ++c)
      passed[c].add(real ? 0 : static_cast<double>(weight[c]));
  }
  for (int c = 0; c < 3; ++c)
    test::expect_mean(passed[c], static_cast<double>(through[c]), 0, 2e-6);
}

/// A peak a million times denser than what surrounds it would stop every flight a hundred thousand
/// times; how dense it is does not matter to the work, nor to what comes through beside it.
TEST(BoundedTracking, WorkIsBounded) {
  for (const double peak : {1e6, 1e12}) {
    const Medium medium = loose_medium(peak, 2);
    Rng rng({1, 0, 0}, RngStage::test, 3);
    std::uint64_t by_majorants = 0;
    for (MediumTracker tracker(medium, {beside}); by_majorants < 50000 && tracker.advance(rng);)
      ++by_majorants;
    EXPECT_EQ(by_majorants, 50000u);
    const auto exact = static_cast<double>(exact_transmittance(medium, {beside}).x);
    ASSERT_GT(exact, 0.1);
    test::Samples passed, ratio;
    for (int n = 0; n < 4000; ++n) {
      std::uint64_t tentative = 0;
      Rgb weight(1);
      passed.add(first_real(medium, {beside}, weight, rng, tentative).volume ? 0 : 1);
      EXPECT_LE(tentative, std::uint64_t{most_tentative_collisions} + 2);
      int looked_up = 0;
      RatioTracking shadow(medium, {beside});
      while (shadow.advance(rng)) {
        ++looked_up;
        if (!shadow.attenuate(rng))
          break;
      }
      EXPECT_LE(looked_up, most_tentative_collisions);
      ratio.add(static_cast<double>(shadow.transmittance().x));
    }
    test::expect_mean(passed, exact);
    test::expect_mean(ratio, exact, 0, 1e-5);
  }
}

} // namespace
} // namespace vdbeam
