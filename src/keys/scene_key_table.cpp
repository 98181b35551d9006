#include "keys/scene_key_builder.h"

namespace vdbeam {
namespace {

/// Where a volume or mesh stands.
template <class S>
void add_placement(KeyTable& table, std::array<double, 12> S::*transform) {
  table.add(
      "transform", transform,
      "row-major 3x4 matrix, applied after the file's own transform; excludes the next three keys");
  table.add_unbound<Vec3d>("translate", "translation, applied after rotation").unit("world");
  table.add_unbound<Vec3d>("rotate", "rotation about the world's X, then Y, then Z axis")
      .unit("degrees");
  table.add_unbound<Vec3d>("scale", "scale about the origin, applied before rotation")
      .one_for_all();
}

void add_volume(KeyTable& table) {
  using V = VolumeSettings;
  using F = FogSettings;
  table.section(SceneSection::volume);
  table.add(
      "shape", &F::shape,
      "source of the density: a file, or a formula in the box from box_lower to box_upper: 1 "
      "in the box; 1 in the ellipsoid that the box encloses; exponential decay with the height "
      "y above its bottom");
  table.add("file", &V::file, "VDB file; ####, %04d or $F4 stands for the frame number")
      .file(InputKind::volume)
      .required()
      .types({"file"});
  table.add("density", &V::density, "name of the density grid").always_written().types({"file"});
  table.add("scale_height", &F::scale_height, "height over which the density falls to 1/e")
      .unit("world")
      .types({"height"})
      .above(0);
  table
      .add("least_density", &F::least_density,
           "least density; there is no fog at heights where the formula gives less")
      .types({"height"})
      .inside(0, 1);
  table.add("extinction", &V::extinction, "extinction coefficient where the density is 1")
      .unit("1 / world")
      .at_least(0)
      .always_written();
  table.add("extinction_scale", &V::extinction_scale, "extinction factor per channel").at_least(0);
  table
      .add("albedo", &V::albedo,
           "single-scattering albedo: the fraction of the extinction that scatters, per channel")
      .within(0, 1)
      .always_written();
  table
      .add("color_grid", &V::color_grid,
           R"(colour grid that multiplies the albedo, or three scalar grids ("r,g,b"); "auto": )"
           R"("Cd", "color" or "albedo"; "": none)")
      .types({"file"});
  table.add("name", &V::name, R"(name in Cryptomatte; "": volume0, volume1, ...)").keeps_world();
  add_placement(table, &V::transform);

  table.add("add", &V::add, R"(grids added to the density, "a, b"; "": none)").types({"file"});
  table.add("mask", &V::mask, R"(grids that multiply the density, "a, b"; "": none)")
      .types({"file"});
  using D = DensityRemap;
  table.add("density_scale", &D::scale, "factor of the density").types({"file"});
  table.add("density_offset", &D::offset, "added to densities above 0, after density_scale")
      .types({"file"});
  table.add("density_min", &D::least, "smaller densities become 0, after density_offset")
      .at_least(0)
      .types({"file"});
  table.add("density_max", &D::most, "larger densities are reduced to this, after density_offset")
      .above(0)
      .absent("none")
      .types({"file"});
  table.add("density_power", &D::power, "exponent of the density, applied after density_max")
      .above(0)
      .types({"file"});
  table
      .add("density_curve", &D::curve,
           R"(curve of the density, "x:y x:y ...", linear in between, applied last; "": none)")
      .types({"file"});
  table
      .add("interpolation", &V::interpolation,
           "interpolation of density and emission between voxels; cubic takes ten times the memory")
      .types({"file"});
  table
      .add("box_lower", &V::box_lower,
           "lower corner of a clipping box; nothing outside is rendered. Of a shape: lower corner "
           "of its "
           "box, before the transform; none: the box from -1 to 1")
      .unit("world")
      .absent("none");
  table.add("box_upper", &V::box_upper, "upper corner of the clipping box")
      .unit("world")
      .absent("none");

  using N = NoiseSettings;
  table
      .add("noise_amplitude", &N::amplitude,
           "greatest displacement of density and emission by noise along an axis; 0: none")
      .unit("world")
      .at_least(0);
  table.add("noise_size", &N::size, "size of the noise's largest features").unit("world").above(0);
  table
      .add("noise_octaves", &N::octaves,
           "octaves of the noise; each has half the size and half the strength of the previous one")
      .within(1, 12);
  table.add("noise_seed", &N::seed, "seed of the noise").at_least(0);

  using W = VelocitySettings;
  table
      .add("velocity", &W::grid,
           R"(velocity grid, or three grids of its components ("vx,vy,vz"); "auto", "none")")
      .types({"file"});
  table.add("velocity_fps", &W::fps, "frames per second of the velocity").above(0).types({"file"});
  table.add("velocity_scale", &W::scale, "factor of the velocity").types({"file"});
  table.add("velocity_units", &W::units, "unit of length of velocities, per second")
      .types({"file"});

  using P = PhaseSettings;
  table.section(SceneSection::phase);
  table.add("type", &P::type, R"(phase function; short form: phase = "NAME")");
  table.add("g", &P::g, "mean cosine, of the first lobe where there are two").inside(-1, 1);
  table.add("g2", &P::g2, "mean cosine of the second lobe").inside(-1, 1);
  table.add("blend", &P::blend, "weight of the second lobe").within(0, 1);
  table.add("droplet_diameter", &P::droplet_diameter, "diameter of the water droplets")
      .unit("micrometres")
      .within(5, 50);
}

void add_emission(KeyTable& table) {
  using E = EmissionSettings;
  table.section(SceneSection::emission);
  table.add("intensity", &E::intensity,
            R"(grid with the strength of the emission ("flame", "heat"); "": 1 everywhere)");
  table.add("temperature", &E::temperature,
            R"(temperature grid, for black-body emission; "": no black body, color alone)");
  table.add("kelvin", &E::kelvin, "kelvin per unit of the temperature grid").above(0);
  table.add("kelvin_offset", &E::kelvin_offset, "added to the temperature, except where it is 0")
      .unit("kelvin");
  table.add("law", &E::law, "how a black body's brightness depends on its temperature");
  table.add("reference", &E::reference, "temperature at which a black body's luminance is 1")
      .unit("kelvin")
      .within(100, 100000);
  table.add(
      "ramp", &E::ramp,
      R"(colour ramp over the temperature grid, or over the intensity grid without one: "x:r,g,b ..."; "": none)");
  table.add("color", &E::color, "factor per channel").at_least(0).scales_emission();
  table.add("scale", &E::scale, "radiance per world unit where all of the above are 1")
      .unit("radiance / world")
      .at_least(0)
      .scales_emission();
}

void add_mesh(KeyTable& table) {
  using S = SurfaceSettings;
  table.section(SceneSection::mesh);
  table.add("type", &S::shape,
            "triangles from a file, or a shape: the unit sphere about the origin, the square "
            "from -1 to 1 in x and y, the unit disk in that plane, the plane without an end, the "
            "cube from -1 to 1, the closed cylinder of radius 1 from -1 to 1 along z; what is flat "
            "faces +z");
  table.add("file", &S::file, "an .obj, .ply, .gltf or .glb file; #### stands for the frame number")
      .file(InputKind::mesh)
      .types({"file"});
  table
      .add("file_normals", &S::file_normals, "shade with the normals of the file where it has them")
      .types({"file"});
  table
      .add("smooth_angle", &S::smooth_angle,
           "smooth shading where normals of the file are not used: triangles that meet at this "
           "angle "
           "or less share a normal; 0: flat")
      .unit("degrees")
      .within(0, 180)
      .types({"file"});
  table.add("file_axes", &S::file_axes, "axis conversion from the file's world to the scene's")
      .types({"file"});
  table
      .add("file_materials", &S::file_materials,
           "use the materials of a glTF (metallic-roughness), instead of material")
      .types({"file"});
  table
      .add("file_fps", &S::file_fps,
           "frames per second of the animation of a glTF's nodes; time 0 is frame 0")
      .types({"file"})
      .above(0);
  table.add("visible", &S::visible, "visible to the camera; an invisible mesh still blocks light");
  table.add("name", &S::name, R"(name in Cryptomatte; "": mesh0, mesh1, ...)").keeps_world();
  table.add("group", &S::group,
            "light group of an emissive mesh; the lights of a group share the layer light_NAME");
  add_placement(table, &S::transform);
}

void add_layer(KeyTable& table) {
  using L = LayerSettings;
  table.section(SceneSection::layer);
  table.add("name", &L::name, "layer to write").required();
  table.add("precision", &L::precision, "stored as half or float");
  table
      .add("compression", &L::compression,
           R"(compression of its part with image.parts = "layers"; auto: image.compression)")
      .absent("auto");
}

void add_stop_rule(KeyTable& table) {
  using R = RenderSettings;
  table.add("passes", &R::passes, "number of passes; 64 if no limit is given")
      .at_least(1)
      .absent("none")
      .always_written()
      .not_in_passes();
  table.add("time", &R::time, R"(time limit of a frame, as a number or like "90s", "5m", "1h30m")")
      .kind(KeyKind::duration)
      .unit("seconds")
      .above(0)
      .absent("none")
      .not_in_passes();
  table.add("target_error", &R::target_error, "stop at this estimated error (MRSE)")
      .above(0)
      .absent("none")
      .not_in_passes();
  table
      .add("min_passes", &R::min_passes,
           "fewest passes before target_error may end the frame; auto: 4, or one per motion sample "
           "of an "
           "open shutter")
      .at_least(1)
      .absent("auto")
      .not_in_passes();
}

void add_render(KeyTable& table) {
  using R = RenderSettings;
  table.section(SceneSection::render);
  table.add("estimator", &R::estimator, "rendering method").always_written();
  add_stop_rule(table);
  table.add("photons", &R::photons, "photons stored per pass").at_least(1).absent("auto");
  table.add("store", &R::store,
            "photon storage: fluence at every tentative collision, or scattered flux at real "
            "collisions (Jensen and Christensen 1998)");
  table.add("direct", &R::direct, "single scattering by shadow rays (sampled) or from photons");
  table.add_auto("direct_samples", &R::direct_samples, "shadow rays per camera ray and light")
      .at_least(1);
  table.add("kernel", &R::kernel, "kernel radius: adapted to the local photon density, or fixed");
  table.add("kernel_shape", &R::kernel_shape, "kernel profile");
  table
      .add_auto("radius", &R::radius,
                R"(radius of the fixed kernel; required for kernel = "fixed")")
      .unit("world")
      .above(0)
      .absent("none");
  table.add_auto("neighbours", &R::neighbours, "k of the adaptive k-nearest-neighbour kernel")
      .at_least(1);
  table.add_auto("min_radius", &R::min_radius, "least adaptive radius").unit("world").above(0);
  table.add_auto("max_radius", &R::max_radius, "greatest adaptive radius").unit("world").above(0);
  table
      .add("alpha", &R::alpha,
           "radius reduction over the passes, alpha of Knaus and Zwicker (2011); 1: none")
      .above_up_to(0, 1);
  table.add("thinning", &R::thinning,
            "where photons are stored: by importance for the camera (view), or everywhere with the "
            "same probability (even)");
  table.add("forward_peak", &R::forward_peak,
            "auto: delta-M truncation of the forward peak in multiple scattering, with an order "
            "that rises "
            "with the passes; kept: no truncation");
  table.add("max_bounces", &R::max_bounces, "greatest number of scattering events of a path")
      .at_least(1)
      .absent("none");
  table.add("cutoff", &R::cutoff, "transmittance at which a camera ray ends").inside(0, 1);
  table
      .add("bias_rays", &R::bias_rays,
           "fraction of the camera rays that are also path traced, to estimate the bias; 0: none")
      .within(0, 1);
  table
      .add("clamp", &R::clamp,
           "greatest radiance that the medium may add to a pixel in one pass; removes light and "
           "reports how "
           "much")
      .unit("radiance")
      .above(0)
      .absent("none");
  table.add("step", &R::step, "length of a step along a camera ray").unit("voxels").above(0);
  table.add("seed", &R::seed, "seed of the random numbers; the same seed gives the same image")
      .at_least(0)
      .always_written();
  table.add("seeds", &R::seeds,
            "random numbers of a sequence: a new seed in each frame, or one seed for all frames");
  table
      .add("threads", &R::threads,
           "number of threads; 0: all that the machine grants. Does not change the image")
      .within(0, 4096)
      .keeps_picture();
}

/// Keys of [render] that a lighting artist needs; the others are advanced.
constexpr std::array<std::string_view, 10> usual_render_keys = {
    "estimator",   "passes", "time", "target_error", "min_passes",
    "max_bounces", "clamp",  "seed", "seeds",        "threads"};

std::vector<SceneKey> make_table() {
  std::vector<KeyEntry> entries;
  KeyTable table(entries);
  add_image_keys(table);
  add_camera_keys(table);
  add_volume(table);
  add_emission(table);
  add_instance_keys(table);
  add_mesh(table);
  add_material_keys(table);
  add_light_keys(table);
  add_layer(table);
  add_render(table);
  std::vector<SceneKey> keys;
  keys.reserve(entries.size());
  for (KeyEntry& entry : entries)
    keys.push_back(std::move(entry.key));
  for (SceneKey& key : keys) {
    // Skies turn about the camera's way up; nothing else of it is part of the world.
    if (key.section == SceneSection::camera && key.name != "up")
      key.changes_world = false;
    if (key.section == SceneSection::phase)
      key.types = kinds_with_key<PhaseType>(key.name);
    if (key.section == SceneSection::material)
      key.types = kinds_with_key<MaterialType>(key.name);
    if (key.section == SceneSection::light)
      key.types = kinds_with_key<LightType>(key.name);
    // No pass depends on which layers are wanted.
    if (key.section == SceneSection::layer) {
      key.changes_world = false;
      key.changes_passes = false;
    }
    if (key.section == SceneSection::render) {
      key.advanced = std::find(usual_render_keys.begin(), usual_render_keys.end(), key.name) ==
                     usual_render_keys.end();
      key.estimators = kinds_with_key<EstimatorType>(key.name);
      key.changes_world = false;
    }
  }
  return keys;
}

} // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = make_table();
  return keys;
}

} // namespace vdbeam
