#include "scene/default_scene.h"

#include "scene/default_emission.h"
#include "scene/default_look.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdb/density_kind.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace vdbeam {
namespace {

bool is_density(const GridSummary& grid) {
  return !is_level_set(grid) && !why_no_density(kind_of(grid));
}

/// "density" for "density[1]", OpenVDB's name of the second of several grids "density".
std::string given_name(const std::string& name) {
  const std::size_t bracket = name.find_last_of('[');
  return name.ends_with(']') && bracket != name.npos ? name.substr(0, bracket) : name;
}

/// Why this grid, none being asked for or called "density".
std::string choice_note(const std::string& file, const GridSummary& chosen,
                        const std::vector<GridSummary>& grids) {
  const std::string name = given_name(chosen.name);
  const auto same = std::count_if(grids.begin(), grids.end(), [&](const GridSummary& grid) {
    return given_name(grid.name) == name;
  });
  const std::string what = name.empty() ? "without a name" : fmt::format("called \"{}\"", name);
  if (same > 1)
    return fmt::format("{}: there are {} grids {}; the first with voxels, \"{}\", is rendered; for "
                       "another: --set volume.0.density={}[1]",
                       file, same, what, chosen.name, name);
  if (name.empty())
    return fmt::format("{}: its grid has no name; it is rendered as density", file);
  return fmt::format(R"({}: there is no grid "density"; "{}" is rendered)", file, chosen.name);
}

const GridSummary& choose_grid(const std::vector<GridSummary>& grids, const FramingWishes& wishes,
                               const std::string& file, std::vector<std::string>& notes) {
  const auto find = [&](const auto& condition) -> const GridSummary* {
    const auto found = std::find_if(grids.begin(), grids.end(), condition);
    return found == grids.end() ? nullptr : &*found;
  };
  if (wishes.grid)
    if (const auto* grid = find([&](const GridSummary& g) { return g.name == *wishes.grid; }))
      return *grid;
  if (const auto* grid = find([](const GridSummary& g) { return g.name == "density"; }))
    return *grid;
  const auto* grid = find([](const GridSummary& g) {
    return is_density(g) && g.name.starts_with("density") && g.active_voxels > 0;
  });
  if (!grid)
    grid = find([](const GridSummary& g) {
      return is_density(g) && g.active_voxels > 0 && !is_fire_grid(g.name);
    });
  if (!grid)
    grid = find([](const GridSummary& g) { return is_density(g) && g.active_voxels > 0; });
  if (!grid)
    grid = find(is_level_set);
  if (!grid)
    grid = find(is_density);
  if (!grid) {
    std::vector<std::string> names;
    names.reserve(grids.size());
    for (const GridSummary& g : grids)
      names.push_back(fmt::format("{} ({})", g.name, g.value_type));
    throw InputError(fmt::format("{}: there is no float grid to render; it holds {}", file,
                                 names.empty() ? "no grid at all" : join_words(names, "and")));
  }
  notes.push_back(choice_note(file, *grid, grids));
  return *grid;
}

/// Data of a grid's shape for camera and extinction.
struct VolumeOutline {
  std::string grid;
  std::vector<Vec3d> points; ///< a body around them holds all that is to be seen
  double mean_depth = 0;     ///< of a mean line along the longest side, at extinction 1
  double largest_depth = 0;  ///< of the densest value along the shortest side, at extinction 1
  double voxels = 0;         ///< along the longest side

  void extend(const GridSummary& summary) {
    if (summary.active_voxels == 0)
      return;
    add_points(summary);
    std::array<double, 3> sides{};
    double cells = 1;
    for (int i = 0; i < 3; ++i) {
      const auto count = static_cast<double>(summary.index_upper[i] - summary.index_lower[i] + 1);
      cells *= count;
      sides[static_cast<std::size_t>(i)] = count * summary.voxel_size[i];
    }
    const auto [shortest, longest] = std::minmax_element(sides.begin(), sides.end());
    voxels = std::max(voxels, *longest / summary.voxel_size[longest - sides.begin()]);
    // The inside of a level set is rendered as density 1; like a ball it fills half of its box.
    const bool level_set = is_level_set(summary);
    const double fill = level_set ? 0.5 : static_cast<double>(summary.active_voxels) / cells;
    mean_depth = std::max(mean_depth, (level_set ? 1 : summary.mean) * fill * *longest);
    largest_depth = std::max(largest_depth, (level_set ? 1 : summary.maximum) * *shortest);
  }
  void add_points(const GridSummary& summary) {
    // A voxel's value fades out over a voxel around it.
    const Vec3d lower = Vec3d(summary.index_lower) - Vec3d(1);
    const Vec3d size = Vec3d(summary.index_upper) + Vec3d(1) - lower;
    const auto add_box = [&](const Vec3d& from, const Vec3d& to) {
      for (int i = 0; i < 8; ++i)
        points.push_back(summary.index_to_world.point(lower + size * Boxd{from, to}.corner(i)));
    };
    if (summary.outline.empty()) {
      add_box(Vec3d(0), Vec3d(1));
      return;
    }
    constexpr int steps = GridSummary::outline_steps;
    for (int y = 0; y < steps; ++y)
      for (int x = 0; x < steps; ++x) {
        const int* column = &summary.outline[2 * static_cast<std::size_t>(steps * y + x)];
        if (column[0] <= column[1])
          add_box(Vec3d(x, y, column[0]) / steps, Vec3d(x + 1, y + 1, column[1] + 1) / steps);
      }
  }
  double extinction(const DefaultLook& look) const {
    return std::min(look.mean_depth / mean_depth, look.largest_depth / largest_depth);
  }
};

std::vector<std::vector<GridSummary>> read_summaries(const std::string& path) {
  std::vector<std::string> files{path};
  if (const std::vector<int> frames = frames_on_disk(path); !frames.empty()) {
    files.clear();
    for (const std::size_t i : {std::size_t(0), frames.size() / 2, frames.size() - 1}) {
      std::string file = substitute_frame(path, frames[i]);
      if (files.empty() || files.back() != file)
        files.push_back(std::move(file));
    }
  }
  std::vector<std::vector<GridSummary>> summaries;
  summaries.reserve(files.size());
  for (const std::string& file : files)
    summaries.push_back(summarize_vdb(file));
  return summaries;
}

VolumeOutline find_shape(const std::string& path,
                         const std::vector<std::vector<GridSummary>>& summaries,
                         const FramingWishes& wishes, std::vector<std::string>& notes) {
  VolumeOutline shape;
  for (const std::vector<GridSummary>& grids : summaries) {
    std::vector<std::string> grid_notes;
    const GridSummary& grid = choose_grid(grids, wishes, path, grid_notes);
    if (shape.grid.empty()) {
      shape.grid = grid.name;
      notes.insert(notes.end(), grid_notes.begin(), grid_notes.end());
    }
    shape.extend(grid);
  }
  if (shape.points.empty()) {
    notes.push_back(fmt::format("{}: grid \"{}\" is empty", path, shape.grid));
    shape.points = {Vec3d(-1), Vec3d(1)};
  }
  return shape;
}

/// Coordinates that people can read: a thousandth of the object's size is precise enough.
Vec3d round_point(const Vec3d& p, double size) {
  const double steps = std::pow(10, 3 - std::floor(std::log10(size)));
  const auto round = [steps](double x) {
    return (steps >= 1 ? std::round(x * steps) / steps
                       : std::round(x * steps) * std::round(1 / steps)) +
           0.0; // no -0
  };
  return {round(p.x), round(p.y), round(p.z)};
}

/// Axes of a viewer that stands upright in front of the object.
struct Viewer {
  Vec3d right, up, back;

  explicit Viewer(const Vec3d& up_axis) : up(up_axis) {
    // Y up looks along -Z, Z up along +Y, as modelling programs do.
    const Vec3d front = std::abs(up.z) < 0.7 ? Vec3d(0, 0, 1) : Vec3d(0, -1, 0);
    right = normalize(cross(up, front));
    back = cross(right, up);
  }
  Vec3d direction(double x, double y, double z) const {
    return normalize(right * x + up * y + back * z);
  }
};

constexpr double margin = 0.9; // share of the picture that the object may fill

/// Where the camera must stand so that points, given in its own axes, fill one side of the picture:
/// |x - centre| <= slope (distance - z) for every point.
struct Fit {
  double right = -std::numeric_limits<double>::infinity(), left = right;
  double slope; ///< tangent of half the angle of view, less the margin

  void add(double x, double z) {
    right = std::max(right, x + slope * z);
    left = std::max(left, -x + slope * z);
  }
  double centre() const { return (right - left) / 2; }
  double distance() const { return (right + left) / 2 / slope; }
};

void frame_camera(Scene& scene, const std::vector<Vec3d>& points, const Vec3d& up_axis,
                  const FramingWishes& wishes) {
  CameraSettings& camera = scene.camera;
  camera.up = up_axis;
  // The camera looks slightly upwards: the sky is behind the object, the horizon low.
  const Vec3d towards = Viewer(up_axis).direction(0.35, -0.17, 1);
  const Vec3d right = normalize(cross(camera.up, towards)), up = cross(towards, right);
  scene.image.width = wishes.width.value_or(960);
  scene.image.height = wishes.height.value_or(540);

  Boxd bounds;
  for (const Vec3d& point : points)
    bounds.extend(point);
  const Vec3d middle = bounds.center();
  Fit across, upright;
  upright.slope = std::tan(camera.fov / 2 * std::numbers::pi / 180) * margin;
  across.slope = upright.slope * scene.image.width / scene.image.height;
  for (const Vec3d& point : points) {
    const Vec3d offset = point - middle;
    across.add(dot(offset, right), dot(offset, towards));
    upright.add(dot(offset, up), dot(offset, towards));
  }
  const Vec3d target = middle + right * across.centre() + up * upright.centre();
  const double distance = std::max(across.distance(), upright.distance());
  const double size = length(bounds.size());
  camera.look_at = round_point(target, size);
  camera.position = round_point(target + towards * distance, size);
}

/// A sunny day; for a fire dusk, since what glows shows in the dark only.
void light_scene(Scene& scene, const Vec3d& up_axis, Subject subject) {
  const DefaultLook& look = default_look(subject);
  const bool dusk = subject == Subject::fire;
  LightSettings sun;
  sun.type = LightType::distant;
  sun.direction =
      round_point(Viewer(up_axis).direction(look.sunlight.x, look.sunlight.y, look.sunlight.z), 1);
  sun.irradiance = look.irradiance;
  sun.angular_radius = 0.27;
  LightSettings sky;
  sky.type = LightType::sky;
  if (dusk) {
    sky.zenith = {0.01f, 0.018f, 0.045f};
    sky.horizon = {0.1f, 0.06f, 0.045f};
    sky.ground = {0.012f, 0.011f, 0.011f};
  }
  scene.lights = {sun, sky};
}

/// Whose axis points up, and how that is known.
Vec3d choose_up(const std::string& path, const std::vector<std::vector<GridSummary>>& summaries,
                const FramingWishes& wishes, std::vector<std::string>& notes) {
  if (wishes.up)
    return *wishes.up;
  bool mantaflow = false;
  for (const std::vector<GridSummary>& grids : summaries)
    for (const GridSummary& grid : grids)
      mantaflow = mantaflow || grid.from_mantaflow;
  notes.push_back(mantaflow ? fmt::format("{}: Z is up, as in Blender, whose simulator wrote the "
                                          "file; for Y: --set camera.up=[0,1,0]",
                                          path)
                            : fmt::format("{}: Y is taken to be up; for Z: "
                                          "--set camera.up=[0,0,1]",
                                          path));
  return mantaflow ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);
}

} // namespace

Scene make_default_scene(const std::string& path, const FramingWishes& wishes) {
  return make_default_scene(path, read_summaries(path), wishes);
}

Scene make_default_scene(const std::string& path,
                         const std::vector<std::vector<GridSummary>>& summaries,
                         const FramingWishes& wishes) {
  Scene scene;
  scene.path = path;
  const VolumeOutline shape = find_shape(path, summaries, wishes, scene.notes);
  const Vec3d up = choose_up(path, summaries, wishes, scene.notes);
  frame_camera(scene, shape.points, up, wishes);

  VolumeSettings volume;
  volume.file = path;
  volume.density = shape.grid;
  volume.phase.type = PhaseType::henyey_greenstein;
  std::vector<std::string> fire_notes;
  volume.emission = default_emission(path, summaries, fire_notes);
  const Subject subject = volume.emission.glows()   ? Subject::fire
                          : is_simulated(summaries) ? Subject::smoke
                                                    : Subject::cloud;
  const DefaultLook& look = default_look(subject);
  volume.phase.g = look.g;
  volume.albedo = Rgb(look.albedo);
  if (shape.voxels < look.fewest_voxels)
    volume.interpolation = Interpolation::cubic;
  if (volume.emission.glows() && is_fire_grid(shape.grid) && !wishes.grid) {
    volume.extinction = 0;
    scene.notes.push_back(
        fmt::format("{}: no grid is smoke, so only the fire is rendered; for smoke "
                    "of grid \"{}\": --set volume.0.extinction=X",
                    path, shape.grid));
  } else if (shape.mean_depth > 0 && shape.largest_depth > 0) {
    volume.extinction = round_to_digits(shape.extinction(look), 2);
    scene.notes.push_back(fmt::format("{}: extinction {} chosen: the optical depth along the "
                                      "longest side is about {:.2g}; change "
                                      "it with --set volume.0.extinction=X",
                                      path, volume.extinction,
                                      volume.extinction * shape.mean_depth));
  }
  scene.notes.insert(scene.notes.end(), fire_notes.begin(), fire_notes.end());
  if (subject == Subject::smoke)
    scene.notes.push_back(fmt::format("{}: taken as smoke, since a simulation wrote it; for a "
                                      "cloud: --set volume.0.albedo=0.98",
                                      path));
  light_scene(scene, up, subject);
  scene.volumes.push_back(volume);
  return scene;
}

} // namespace vdbeam
