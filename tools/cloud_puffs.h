#pragma once

#include "cloud_noise.h"

#include <openvdb/openvdb.h>

#include <vector>

namespace vdbeam {

/// A ball of cloud, flattened along y where `flatness` is below 1.
struct Puff {
  openvdb::Vec3f centre;
  float radius = 1;
  float flatness = 1; ///< height over width
};

/// A heap of balls and the rules by which its surface is worked. Lengths are in world units.
struct CloudForm {
  std::vector<Puff> puffs;
  float base = 0;    ///< height of the flat base
  float detail = 0;  ///< size of the largest billows on the balls' surfaces
  float crisp = 0;   ///< thickness of the border where it is sharp
  float wispy = 0;   ///< thickness of the border where it frays, at the base and in the anvil
  float fraying = 1; ///< height above which the border frays, except over the tower
  openvdb::Vec3f tower = openvdb::Vec3f(0); ///< axis of the tower, at any height
  float tower_radius = 0; ///< distance from the axis within which the border stays sharp
};

/// Children on the upper surface of each puff, again on the children, `levels` times. `smallest` is
/// the least radius.
void grow(std::vector<Puff>& puffs, int levels, float smallest, Dice& dice);

/// A cumulus `width` wide: a flat base, towers that are highest in the middle. Where `tallness` is
/// 1 it is about half as high as wide.
CloudForm cumulus_form(const openvdb::Vec3f& middle, float width, float tallness, float smallest,
                       Dice& dice);

/// A storm: a main tower, a flanking line of lower ones, and an anvil that the wind draws along x.
CloudForm storm_form(float extent, float smallest, Dice& dice);

} // namespace vdbeam
