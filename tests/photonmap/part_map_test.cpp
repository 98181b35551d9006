// Photons of several parts of the medium in one map: each counts with the weights of its part, as
// in a map of its own.
#include "photonmap/photon_map.h"

#include "photonmap/query_cases.h"

namespace vdbeam {
namespace {

constexpr std::size_t parts = 3;

PhotonList photons_of(std::size_t part, std::size_t count) {
  Rng rng({}, RngStage::test, part);
  PhotonList list;
  list.groups = 2;
  for (std::size_t i = 0; i < count; ++i) {
    list.position.push_back(oracle::random_point(rng) * 0.5f);
    list.direction.push_back(sample_sphere(rng.uniform(), rng.uniform()));
    list.power.push_back(Rgb(1.0f, 2.0f, 0.5f) * static_cast<float>(part + 1));
    list.group.push_back(static_cast<std::uint16_t>(i % 2));
  }
  return list;
}

/// The photons of all parts, mixed.
PhotonList mixed(const std::vector<std::size_t>& counts) {
  PhotonList all;
  all.groups = 2;
  std::vector<PhotonList> lists;
  for (std::size_t part = 0; part < counts.size(); ++part)
    lists.push_back(photons_of(part, counts[part]));
  for (std::size_t i = 0; i < *std::max_element(counts.begin(), counts.end()); ++i)
    for (std::size_t part = 0; part < counts.size(); ++part) {
      if (i >= counts[part])
        continue;
      all.position.push_back(lists[part].position[i]);
      all.direction.push_back(lists[part].direction[i]);
      all.power.push_back(lists[part].power[i]);
      all.group.push_back(lists[part].group[i]);
      all.part.push_back(static_cast<std::uint8_t>(part));
    }
  return all;
}

class PartsOfMap : public ::testing::Test {
protected:
  PartsOfMap() {
    radii_.neighbours = 50;
    map_ = PhotonMap::build(mixed(counts_), 3, radii_, KernelShape::biweight);
    for (std::size_t part = 0; part < parts; ++part)
      alone_.push_back(
          PhotonMap::build(photons_of(part, counts_[part]), 3, radii_, KernelShape::biweight));
  }

  const std::vector<std::size_t> counts_{4000, 0, 700};
  RadiusSettings radii_;
  PhotonMap map_;
  std::vector<PhotonMap> alone_;
  const std::vector<PhaseFunction> phases_{oracle::henyey_greenstein(0.6), PhaseFunction()};
};

TEST_F(PartsOfMap, HaveRadiiOfTheirOwn) {
  EXPECT_EQ(map_.size(), 4700u);
  for (std::size_t part = 0; part < parts; ++part)
    EXPECT_EQ(map_.mean_radius(part), alone_[part].mean_radius());
  EXPECT_GT(map_.mean_radius(2), map_.mean_radius(0));
  EXPECT_EQ(map_.mean_radius(parts), 0);
  const PhotonMap copy = map_.copy();
  EXPECT_EQ(copy.mean_radius(2), map_.mean_radius(2));
  EXPECT_FLOAT_EQ(map_.resized(2).mean_radius(2), 2 * map_.mean_radius(2));
}

TEST_F(PartsOfMap, PointsAskForOne) {
  const Vec3f point{0.1f, -0.1f, 0.05f}, direction{0, 0, 1};
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<Rgb> found(2), wanted(2), groups, wanted_groups;
    map_.query_point(point, direction, part, phases_, found.data(), nullptr, &groups);
    alone_[part].query_point(point, direction, 0, phases_, wanted.data(), nullptr, &wanted_groups);
    EXPECT_EQ(found, wanted);
    EXPECT_EQ(groups, wanted_groups);
    EXPECT_EQ(found[0].x > 0, counts_[part] > 0);
  }
  Rgb beyond[2] = {Rgb(1), Rgb(1)};
  map_.query_point(point, direction, parts, phases_, beyond);
  EXPECT_EQ(beyond[0], Rgb(0));
}

TEST_F(PartsOfMap, RaysHaveWeightsForEach) {
  constexpr int knots = 9;
  PhotonMap::RayProfile profile;
  profile.ray = {{0.05f, 0.02f, -2}, {0, 0, 1}};
  profile.t_begin = 1.6f;
  profile.step = 0.1f;
  profile.knots = knots;
  profile.phases = &phases_;
  std::vector<std::vector<float>> weights;
  std::vector<PhotonMap::RayProfile> by_part(parts, profile);
  for (std::size_t part = 0; part < parts; ++part) {
    weights.emplace_back(phases_.size() * knots, static_cast<float>(part + 1));
    by_part[part].weights = weights.back().data();
  }
  Rgb found, wanted;
  std::vector<Rgb> groups, wanted_groups(2);
  map_.query_ray(by_part, found, &groups);
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<Rgb> of_part;
    alone_[part].query_ray({&by_part[part], 1}, wanted, &of_part);
    for (std::size_t g = 0; g < of_part.size(); ++g)
      wanted_groups[g] += of_part[g];
  }
  EXPECT_GT(found.x, 0);
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(groups, wanted_groups);
}

TEST_F(PartsOfMap, TilesHaveWeightsForEach) {
  const BeamTile one = oracle::cube_tile(phases_);
  // The same knots for each part, with weights multiplied by its number.
  BeamTile all = one;
  all.weights.clear();
  all.by_group = true;
  for (std::size_t part = 0; part < parts; ++part) {
    all.parts.push_back(one.profiles);
    for (BeamTile::Profile& profile : all.parts.back())
      profile.offset += all.weights.size();
    for (const float weight : one.weights)
      all.weights.push_back(static_cast<float>(part + 1) * weight);
  }
  map_.query(all);
  std::vector<float> wanted(all.radiance.size()), wanted_groups(all.group_radiance.size());
  for (std::size_t part = 0; part < parts; ++part) {
    BeamTile own = one;
    own.by_group = true;
    alone_[part].query(own);
    for (std::size_t i = 0; i < own.radiance.size(); ++i)
      wanted[i] += static_cast<float>(part + 1) * own.radiance[i];
    for (std::size_t i = 0; i < own.group_radiance.size(); ++i)
      wanted_groups[i] += static_cast<float>(part + 1) * own.group_radiance[i];
  }
  ASSERT_EQ(wanted_groups.size(), 2 * wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(all.radiance[i], wanted[i], 1e-5f * wanted[i]);
  for (std::size_t i = 0; i < wanted_groups.size(); ++i)
    EXPECT_NEAR(all.group_radiance[i], wanted_groups[i], 1e-5f * wanted_groups[i]);
}

} // namespace
} // namespace vdbeam
