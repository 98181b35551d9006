#include "volume_factory.h"

#include "cloud_volumes.h"
#include "moving_volumes.h"

#include "vdbeam/error.h"

#include <fmt/format.h>
#include <openvdb/math/Maps.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace vdbeam {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::math::Mat4d;
using openvdb::math::Transform;
using openvdb::math::Vec3d;

/// Voxel coordinates from -half to size - 1 - half; index 0 lies at the centre of the world.
int half(const VolumeOptions& options) {
  return options.size / 2;
}

CoordBBox bounds(const VolumeOptions& options) {
  return {Coord(-half(options)), Coord(options.size - 1 - half(options))};
}

double voxel_size(const VolumeOptions& options) {
  return options.extent / options.size;
}

/// Fills a box voxel by voxel with `value(x, y, z)`, where the coordinates run from -1 to 1 across
/// the volume's size; zeros stay out of the tree.
FloatGrid::Ptr fill(const VolumeOptions& options, const CoordBBox& box,
                    const std::function<double(double, double, double)>& value) {
  FloatGrid::Ptr grid = FloatGrid::create(0);
  grid->setTransform(Transform::createLinearTransform(voxel_size(options)));
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  FloatGrid::Accessor accessor = grid->getAccessor();
  const double scale = 2.0 / options.size;
  for (int i = box.min().x(); i <= box.max().x(); ++i)
    for (int j = box.min().y(); j <= box.max().y(); ++j)
      for (int k = box.min().z(); k <= box.max().z(); ++k) {
        const auto v = static_cast<float>(value(i * scale, j * scale, k * scale));
        if (v != 0)
          accessor.setValue(Coord(i, j, k), v);
      }
  return grid;
}

/// A well-mixed number in [0, 1) for each lattice point and seed (SplitMix64's finaliser).
double lattice_noise(int x, int y, int z, std::uint64_t seed) {
  std::uint64_t h = seed * 0x9e3779b97f4a7c15;
  for (const int c : {x, y, z}) {
    h ^= static_cast<std::uint32_t>(c);
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
    h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
    h ^= h >> 31;
  }
  return static_cast<double>(h >> 11) * 0x1p-53;
}

/// Value noise in [0, 1), smooth over one unit.
double smooth_noise(const Vec3d& p, std::uint64_t seed) {
  int base[3];
  double weight[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(p[axis]), t = p[axis] - floor;
    base[axis] = static_cast<int>(floor);
    weight[axis] = t * t * (3 - 2 * t);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = (corner >> 1) & 1, z = corner >> 2;
    const double w = (x ? weight[0] : 1 - weight[0]) * (y ? weight[1] : 1 - weight[1]) *
                     (z ? weight[2] : 1 - weight[2]);
    sum += w * lattice_noise(base[0] + x, base[1] + y, base[2] + z, seed);
  }
  return sum;
}

/// A ball eaten away by four octaves of noise; lopsided, so that a mirrored or turned one differs.
FloatGrid::Ptr noise_cloud(const VolumeOptions& options) {
  return fill(options, bounds(options), [&](double x, double y, double z) {
    double noise = 0, amplitude = 0.5;
    Vec3d p = Vec3d(x, y, z) * 2.0 + Vec3d(10, 20, 30);
    for (std::uint64_t octave = 0; octave < 4; ++octave) {
      noise += amplitude * smooth_noise(p, options.seed + octave);
      amplitude *= 0.5;
      p *= 2.0;
    }
    const double radius = std::sqrt(x * x + y * y + z * z) * (1.05 + 0.15 * x - 0.1 * y);
    return options.density * std::clamp(2.5 * (noise - 0.25 - 0.7 * radius * radius), 0.0, 1.0);
  });
}

FloatGrid::Ptr half_as_large(VolumeOptions options) {
  options.size /= 2;
  options.extent /= 2;
  return noise_cloud(options);
}

FloatGrid::Ptr constant_box(const VolumeOptions& options, const CoordBBox& box) {
  return fill(options, box, [&](double, double, double) { return options.density; });
}

FloatGrid::Ptr slab(const VolumeOptions& options) {
  CoordBBox box = bounds(options);
  const int half_thickness = std::max(options.size / 16, 1);
  box.min().y() = -half_thickness;
  box.max().y() = half_thickness;
  return constant_box(options, box);
}

FloatGrid::Ptr sphere(const VolumeOptions& options) {
  return fill(options, bounds(options), [&](double x, double y, double z) {
    return x * x + y * y + z * z <= 0.81 ? options.density : 0;
  });
}

/// Rises along x from 0 at the lower side.
FloatGrid::Ptr ramp(const VolumeOptions& options) {
  const double first = -2.0 * half(options) / options.size;
  return fill(options, bounds(options),
              [&, first](double x, double, double) { return options.density * (x - first) / 2; });
}

/// A thin haze in which one voxel of 500 is a thousand times denser.
FloatGrid::Ptr spikes(const VolumeOptions& options) {
  const double scale = options.size / 2.0;
  return fill(options, bounds(options), [&, scale](double x, double y, double z) {
    const auto at = [scale](double c) { return static_cast<int>(std::lround(c * scale)); };
    const bool spike = lattice_noise(at(x), at(y), at(z), options.seed) < 0.002;
    return options.density * (spike ? 1 : 0.001);
  });
}

/// No voxel at all, only tiles of 8^3 (and of 128^3 from 256 voxels across on).
FloatGrid::Ptr tiles(const VolumeOptions& options) {
  const int reach = std::max(options.size / 16, 1) * 8;
  FloatGrid::Ptr grid = fill(options, CoordBBox(), {});
  grid->sparseFill({Coord(-reach), Coord(reach - 1)}, static_cast<float>(options.density), true);
  grid->sparseFill({Coord(-reach), Coord(-1)}, static_cast<float>(options.density / 2), true);
  return grid;
}

FloatGrid::Ptr one_voxel(const VolumeOptions& options) {
  return constant_box(options, {Coord(0), Coord(0)});
}

FloatGrid::Ptr bad_values(const VolumeOptions& options) {
  FloatGrid::Ptr grid = noise_cloud(options);
  FloatGrid::Accessor accessor = grid->getAccessor();
  using Limits = std::numeric_limits<float>;
  accessor.setValue(Coord(0), Limits::quiet_NaN());
  accessor.setValue(Coord(1, 2, 3), Limits::infinity());
  accessor.setValue(Coord(-3, 1, 0), -Limits::infinity());
  for (int k = 0; k < 3; ++k)
    accessor.setValue(Coord(-2, -2, k), -0.5f);
  grid->tree().addTile(1, Coord(1024), -1.0f, true);
  return grid;
}

/// Values whose active flags are off count all the same.
FloatGrid::Ptr inactive(const VolumeOptions& options) {
  FloatGrid::Ptr grid = noise_cloud(options);
  for (auto value = grid->beginValueOn(); value; ++value)
    value.setActiveState(false);
  grid->tree().addTile(1, Coord(-8 * options.size, 0, 0), static_cast<float>(options.density),
                       false);
  return grid;
}

FloatGrid::Ptr level_set(const VolumeOptions& options) {
  return openvdb::tools::createLevelSetSphere<FloatGrid>(static_cast<float>(0.45 * options.extent),
                                                         openvdb::Vec3f(0),
                                                         static_cast<float>(voxel_size(options)));
}

/// The noise cloud under another map; `matrix` acts on row vectors, as OpenVDB's do.
FloatGrid::Ptr mapped(const VolumeOptions& options, const Mat4d& matrix) {
  FloatGrid::Ptr grid = noise_cloud(options);
  Transform::Ptr transform = Transform::createLinearTransform(voxel_size(options));
  transform->postMult(matrix);
  grid->setTransform(transform);
  return grid;
}

FloatGrid::Ptr rotated(const VolumeOptions& options) {
  Mat4d matrix = Mat4d::identity();
  matrix.setToRotation(Vec3d(1, 2, 3).unit(), 0.7);
  return mapped(options, matrix);
}

FloatGrid::Ptr sheared(const VolumeOptions& options) {
  Mat4d matrix = Mat4d::identity();
  matrix(1, 0) = 0.6; // x += 0.6 y
  matrix(2, 1) = -0.3;
  return mapped(options, matrix);
}

FloatGrid::Ptr scaled(const VolumeOptions& options, const Vec3d& factors) {
  Mat4d matrix = Mat4d::identity();
  matrix.setToScale(factors);
  return mapped(options, matrix);
}

FloatGrid::Ptr far_away(const VolumeOptions& options) {
  Mat4d matrix = Mat4d::identity();
  matrix.setTranslation(Vec3d(1e6, -1e6, 1e6));
  return mapped(options, matrix);
}

FloatGrid::Ptr frustum(const VolumeOptions& options) {
  FloatGrid::Ptr grid = noise_cloud(options);
  const CoordBBox box = bounds(options);
  grid->setTransform(Transform::Ptr(
      new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::NonlinearFrustumMap(
          openvdb::BBoxd(box.min().asVec3d(), box.max().asVec3d()), 0.5, options.extent)))));
  return grid;
}

FloatGrid::Ptr saved_as_half(const VolumeOptions& options) {
  FloatGrid::Ptr grid = noise_cloud(options);
  grid->setSaveFloatAsHalf(true);
  return grid;
}

FloatGrid::Ptr with_background(const VolumeOptions& options) {
  FloatGrid::Ptr grid = noise_cloud(options);
  openvdb::tools::changeBackground(grid->tree(), 0.25f);
  return grid;
}

/// The same values under another value type.
template <class Grid>
openvdb::GridBase::Ptr converted(const VolumeOptions& options) {
  const FloatGrid::Ptr source = noise_cloud(options);
  typename Grid::Ptr grid = Grid::create();
  grid->setTransform(source->transformPtr());
  auto accessor = grid->getAccessor();
  for (auto value = source->cbeginValueOn(); value; ++value)
    accessor.setValue(value.getCoord(), typename Grid::ValueType(value.getValue()));
  return grid;
}

Grids duplicates(const VolumeOptions& options) {
  VolumeOptions denser = options;
  denser.density *= 2;
  return {noise_cloud(options), sphere(denser)};
}

Grids simulation(const VolumeOptions& options) {
  Grids grids{noise_cloud(options), sphere(options), converted<openvdb::Vec3SGrid>(options)};
  const char* const names[] = {"", "temperature", "velocity"};
  for (int i = 1; i < 3; ++i)
    grids[i]->setName(names[i]);
  return grids;
}

/// The box and colours of it: red, green and blue are (x + 1) / 2, 1/4 and 3/4, where x runs from
/// -1 to 1 across the size. As one grid "Cd", as Houdini has it, and as three.
Grids colored(const VolumeOptions& options) {
  const FloatGrid::Ptr box = constant_box(options, bounds(options));
  const auto color = openvdb::Vec3SGrid::create();
  color->setTransform(box->transformPtr());
  color->setName("Cd");
  auto accessor = color->getAccessor();
  Grids grids{box, color};
  for (const char* name : {"tint_r", "tint_g", "tint_b"}) {
    const FloatGrid::Ptr channel = FloatGrid::create(0);
    channel->setTransform(box->transformPtr());
    channel->setName(name);
    grids.push_back(channel);
  }
  for (auto value = box->cbeginValueOn(); value; ++value) {
    const Coord at = value.getCoord();
    const openvdb::Vec3s c(static_cast<float>(0.5 + static_cast<double>(at.x()) / options.size),
                           0.25f, 0.75f);
    accessor.setValue(at, c);
    for (int i = 0; i < 3; ++i)
      static_cast<FloatGrid&>(*grids[static_cast<std::size_t>(2 + i)]).tree().setValue(at, c[i]);
  }
  return grids;
}

struct Recipe {
  const char* name;
  const char* description;
  std::function<Grids(const VolumeOptions&)> make;
};

template <class Make>
Recipe single(const char* name, const char* description, Make make) {
  return {name, description, [make](const VolumeOptions& options) { return Grids{make(options)}; }};
}

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all{
      single("sphere", "constant density in a ball of 0.9 of the size", sphere),
      single("box", "constant density in a cube",
             [](const VolumeOptions& o) { return constant_box(o, bounds(o)); }),
      single("slab", "constant density, an eighth as thick (y) as wide", slab),
      single("ramp", "density rising linearly along x in a cube", ramp),
      single("noise", "a noise cloud", noise_cloud),
      single("spikes", "single voxels a thousand times denser than the haze around them", spikes),
      single("tiles", "constant tiles and no voxel", tiles),
      single("empty", "a grid without a value",
             [](const VolumeOptions& o) { return fill(o, CoordBBox(), {}); }),
      single("voxel", "one voxel", one_voxel),
      single("half", "the noise cloud saved as half floats", saved_as_half),
      single("double", "the noise cloud in double precision", converted<openvdb::DoubleGrid>),
      single("rotated", "the noise cloud, rotated", rotated),
      single("sheared", "the noise cloud, sheared", sheared),
      single("mirrored", "the noise cloud, mirrored in x",
             [](const VolumeOptions& o) { return scaled(o, Vec3d(-1, 1, 1)); }),
      single("anisotropic", "the noise cloud with voxels of 1 x 2 x 0.5",
             [](const VolumeOptions& o) { return scaled(o, Vec3d(1, 2, 0.5)); }),
      single("far", "the noise cloud a million units from the origin on each axis", far_away),
      single("frustum", "the noise cloud in a frustum (not supported by vdbeam)", frustum),
      single("levelset", "a sphere as a level set", level_set),
      single("bad", "the noise cloud with NaN, infinite and negative values", bad_values),
      single("inactive", "the noise cloud and a tile with all active flags off", inactive),
      single("background", "the noise cloud with a background of 0.25", with_background),
      single("vector", "a vec3s grid where a density is expected", converted<openvdb::Vec3SGrid>),
      single("integer", "an int32 grid where a density is expected", converted<openvdb::Int32Grid>),
      {"duplicates", "two grids of one name: the noise cloud, and a sphere twice as dense",
       duplicates},
      {"staggered", "a ball and its staggered velocity (1, 2, 3)",
       [](const VolumeOptions& o) { return staggered(sphere(o)); }},
      {"whirl", "a noise cloud of half the size that a velocity turns, shears and lifts",
       [](const VolumeOptions& o) { return whirl(half_as_large(o), bounds(o)); }},
      {"wild", "a ball and its velocity (1, 2, 3), a third of it NaN, infinite or 1e6",
       [](const VolumeOptions& o) { return wild(sphere(o)); }},
      {"components", "a ball and its velocity (1, 2, 3) in three grids",
       [](const VolumeOptions& o) { return components(sphere(o)); }},
      {"colored", "a box and its colours, as a grid of vectors and as three of numbers", colored},
      {"simulation", "grids density, temperature and velocity", simulation},
      single("cumulus", "a fair-weather cumulus, from 300 voxels for images", cumulus),
      single("storm", "a storm tower with an anvil, from 500 voxels for images", storm),
      single("field", "many cumuli, from 1500 voxels for images", cumulus_field),
      single("fogbank", "a bank of fog with an uneven top", fog_bank),
  };
  return all;
}

void check(const VolumeOptions& options) {
  if (options.size < 1 || options.size > 4096)
    throw InputError(fmt::format("size must lie in 1 to 4096 voxels, got {}", options.size));
  if (!(options.extent > 0) || !std::isfinite(options.extent))
    throw InputError(fmt::format("extent must be above 0, got {}", options.extent));
}

} // namespace

std::vector<VolumeKind> volume_kinds() {
  std::vector<VolumeKind> kinds;
  for (const Recipe& recipe : recipes())
    kinds.push_back({recipe.name, recipe.description});
  return kinds;
}

void write_volume(const std::string& kind, const std::string& path, const VolumeOptions& options) {
  check(options);
  openvdb::initialize();
  for (const Recipe& recipe : recipes())
    if (recipe.name == kind) {
      Grids grids = recipe.make(options);
      for (const openvdb::GridBase::Ptr& grid : grids)
        if (grid->getName().empty() || grids.size() == 1)
          grid->setName(options.name);
      openvdb::io::File(path).write(grids);
      return;
    }
  throw InputError(fmt::format("unknown kind of volume \"{}\"; --list shows all", kind));
}

} // namespace vdbeam
