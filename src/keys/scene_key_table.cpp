#include "keys/scene_key_builder.h"

namespace vdbeam {
namespace {

/// Where a volume or mesh stands.
template <class S>
void add_placement(KeyTable& table, std::array<double, 12> S::*transform) {
  table.add("transform", transform,
            "row-major 3x4 matrix applied after its own transform; excludes the next three");
  table.add_unbound<Vec3d>("translate", "moves it, after rotating it").unit("world");
  table.add_unbound<Vec3d>("rotate", "turns it about the world's X, then Y, then Z axis")
      .unit("degrees");
  table.add_unbound<Vec3d>("scale", "scales it about the origin, before rotating it").one_for_all();
}

void add_volume(KeyTable& table) {
  using V = VolumeSettings;
  using F = FogSettings;
  table.section(SceneSection::volume);
  table.add(
      "shape", &F::shape,
      "what its density comes from: a file; or without one, in the box from box_lower to "
      "box_upper: 1 everywhere; 1 in the sphere or ellipsoid that touches its faces; 1 at its "
      "bottom and falling exponentially with y");
  table.add("file", &V::file, "the VDB; ####, %04d or $F4 stands for the frame number")
      .file(InputKind::volume)
      .types({"file"})
      .required();
  table.add("density", &V::density, "name of the density grid").types({"file"}).always_written();
  table.add("scale_height", &F::scale_height, "height over which the density falls to 1/e")
      .unit("world")
      .types({"height"})
      .above(0);
  table
      .add("least_density", &F::least_density,
           "above the height where the density is less, there is none")
      .types({"height"})
      .inside(0, 1);
  table.add("extinction", &V::extinction, "extinction coefficient where the density is 1")
      .unit("1 / world")
      .at_least(0)
      .always_written();
  table.add("extinction_scale", &V::extinction_scale, "factor of the extinction per channel")
      .at_least(0);
  table.add("albedo", &V::albedo, "share of the extinction that scatters, per channel")
      .within(0, 1)
      .always_written();
  table
      .add("color_grid", &V::color_grid,
           R"(grid of colours that multiply the albedo, or three of numbers ("r,g,b"); "auto": )"
           R"("Cd", "color" or "albedo"; "": none)")
      .types({"file"});
  table.add("name", &V::name, R"(its name in Cryptomatte; "": volume0, volume1, ...)")
      .keeps_world();
  add_placement(table, &V::transform);

  table.add("add", &V::add, R"(names of grids that are added to the density, "a, b"; "": none)")
      .types({"file"});
  table
      .add("mask", &V::mask,
           R"(names of grids whose values multiply the density, "a, b"; "": none)")
      .types({"file"});
  using D = DensityRemap;
  table.add("density_scale", &D::scale, "the density's values are multiplied by this")
      .types({"file"});
  table.add("density_offset", &D::offset, "then this is added to values above 0").types({"file"});
  table.add("density_min", &D::least, "then smaller values become 0").at_least(0).types({"file"});
  table.add("density_max", &D::most, "then larger values become this")
      .above(0)
      .absent("none")
      .types({"file"});
  table.add("density_power", &D::power, "then values are raised to this power")
      .above(0)
      .types({"file"});
  table
      .add("density_curve", &D::curve,
           R"(then values go through this curve, "x:y x:y ...", linear in between; "": none)")
      .types({"file"});
  table
      .add("interpolation", &V::interpolation,
           "how density and emission are interpolated between voxels; cubic takes ten times the "
           "memory")
      .types({"file"});
  table
      .add("box_lower", &V::box_lower,
           "lower corner of a box outside of which nothing is seen; of a shape "
           "without a file its box, before it is placed, from -1 to 1 where there is none")
      .unit("world")
      .absent("none");
  table.add("box_upper", &V::box_upper, "its upper corner").unit("world").absent("none");

  using N = NoiseSettings;
  table
      .add("noise_amplitude", &N::amplitude,
           "how far noise displaces density and emission along an axis, at most; 0: none")
      .unit("world")
      .at_least(0);
  table.add("noise_size", &N::size, "size of the noise's largest features").unit("world").above(0);
  table
      .add("noise_octaves", &N::octaves,
           "octaves of the noise, each half as large and half as strong as the one before")
      .within(1, 12);
  table.add("noise_seed", &N::seed, "another seed is another noise").at_least(0);

  using W = VelocitySettings;
  table
      .add("velocity", &W::grid,
           R"(grid of the velocity, or three of its components ("vx,vy,vz"); "auto", "none")")
      .types({"file"});
  table.add("velocity_fps", &W::fps, "frames in a second of the velocity").above(0).types({"file"});
  table.add("velocity_scale", &W::scale, "factor of the velocity").types({"file"});
  table.add("velocity_units", &W::units, "what velocities are measured in, per second")
      .types({"file"});

  using P = PhaseSettings;
  table.section(SceneSection::phase);
  table.add("type", &P::type, R"(phase function; phase = "NAME" is short for it)");
  table.add("g", &P::g, "mean cosine, of the first lobe where there are two").inside(-1, 1);
  table.add("g2", &P::g2, "mean cosine of the second lobe").inside(-1, 1);
  table.add("blend", &P::blend, "share of the second lobe").within(0, 1);
  table.add("droplet_diameter", &P::droplet_diameter, "diameter of the water droplets")
      .unit("micrometres")
      .within(5, 50);
}

void add_emission(KeyTable& table) {
  using E = EmissionSettings;
  table.section(SceneSection::emission);
  table.add(
      "intensity", &E::intensity,
      R"(name of a grid with the strength of the emission ("flame", "heat"); "": 1 everywhere)");
  table.add("temperature", &E::temperature,
            R"(name of a grid of temperatures, for black-body emission; "": the color alone)");
  table.add("kelvin", &E::kelvin, "kelvin per unit of the temperature grid").above(0);
  table.add("kelvin_offset", &E::kelvin_offset, "added to the temperature, except where it is 0")
      .unit("kelvin");
  table.add("law", &E::law, "how a black body's brightness follows its temperature");
  table.add("reference", &E::reference, "temperature at which a black body's luminance is 1")
      .unit("kelvin")
      .within(100, 100000);
  table.add(
      "ramp", &E::ramp,
      R"(colours by the temperature's value, or else the intensity's: "x:r,g,b ..."; "": none)");
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
            "triangles of a file, or a shape: the sphere of radius 1 about the origin, the square "
            "from -1 to 1 in x and y, the disk of radius 1 in that plane; the latter two face +z");
  table.add("file", &S::file, "an .obj, .ply, .gltf or .glb file; #### stands for the frame number")
      .file(InputKind::mesh)
      .types({"file"});
  table
      .add("file_normals", &S::file_normals,
           "its normals, where it has them, tell what curved surface its triangles stand for")
      .types({"file"});
  table
      .add("smooth_angle", &S::smooth_angle,
           "where normals of the file are not used, triangles that meet at this angle at most look "
           "like one curved surface; 0: all are flat")
      .unit("degrees")
      .within(0, 180)
      .types({"file"});
  table.add("visible", &S::visible, "whether the camera sees it; it stops light in any case");
  table.add("name", &S::name, R"(its name in Cryptomatte; "": mesh0, mesh1, ...)").keeps_world();
  table.add("group", &S::group,
            "of an emissive mesh: lights of one group share the layer light_NAME");
  add_placement(table, &S::transform);

  using M = MaterialSettings;
  table.section(SceneSection::material);
  table.add("type", &M::type, R"(what it is made of; material = "NAME" is short for it)");
  table
      .add("albedo", &M::albedo,
           "share of light reflected; auto: 0.8, or 1 where there is a texture")
      .within(0, 1)
      .absent("auto");
  table
      .add(
          "texture", &M::texture,
          "EXR, HDR or PNG picture, by the surface's UV, that albedo or radiance are multiplied by")
      .file(InputKind::picture);
  table.add("texture_wrap", &M::texture_wrap, "what the texture shows beyond its edges");
  table.add("reflectance", &M::reflectance, "share that is reflected at normal incidence")
      .within(0, 1);
  table
      .add("roughness", &M::roughness,
           "0: smooth; the width of the GGX lobe is its square; auto: 0.2 of a conductor, 0 of a "
           "dielectric")
      .within(0, 1)
      .absent("auto");
  table.add("ior", &M::ior, "index inside over that outside").within(0.1, 10);
  table.add("absorption", &M::absorption, "absorption coefficient inside, per channel")
      .unit("1 / world")
      .at_least(0);
  table.add("solid", &M::solid, "no volume is inside; so wherever it absorbs");
  table.add("radiance", &M::radiance, "radiance that it sends out")
      .unit("W / m^2 / sr")
      .at_least(0);
  table
      .add("power", &M::power,
           "radiant power of all of the surface, before a texture takes its part, in place of "
           "radiance")
      .unit("W")
      .at_least(0)
      .absent("none");
  table
      .add("kelvin", &M::kelvin,
           "temperature of a black body by whose colour, of luminance 1, its light is multiplied")
      .unit("kelvin")
      .within(500, 50000)
      .absent("none");
  table.add("exposure", &M::exposure, "its light is multiplied by 2 to the power of this")
      .unit("stops")
      .within(-100, 100);
  table.add("two_sided", &M::two_sided, "whether its back shines too");
}

void add_layer(KeyTable& table) {
  using L = LayerSettings;
  table.section(SceneSection::layer);
  table.add("name", &L::name, "which layer the image is to have").required();
  table.add("precision", &L::precision, "how it is stored: as halves or floats");
  table
      .add("compression", &L::compression,
           R"(of its part, where image.parts = "layers"; auto: image.compression)")
      .absent("auto");
}

void add_stop_rule(KeyTable& table) {
  using R = RenderSettings;
  table.add("passes", &R::passes, "passes to render; 64 where no limit at all is given")
      .at_least(1)
      .absent("none")
      .always_written()
      .not_in_passes();
  table.add("time", &R::time, R"(rendering time, as a number or like "90s", "5m", "1h30m")")
      .kind(KeyKind::duration)
      .unit("seconds")
      .above(0)
      .absent("none")
      .not_in_passes();
  table.add("target_error", &R::target_error, "estimated error (MRSE) to reach")
      .above(0)
      .absent("none")
      .not_in_passes();
  table
      .add("min_passes", &R::min_passes,
           "passes before target_error may end the frame; auto: 4, or one for each moment of an "
           "open shutter")
      .at_least(1)
      .absent("auto")
      .not_in_passes();
}

void add_render(KeyTable& table) {
  using R = RenderSettings;
  table.section(SceneSection::render);
  table.add("estimator", &R::estimator, "how light is found").always_written();
  add_stop_rule(table);
  table.add("photons", &R::photons, "photons stored per pass").at_least(1).absent("auto");
  table.add("store", &R::store, "what a photon stores: fluence, or scattered flux (classic)");
  table.add("direct", &R::direct, "single scattering by shadow rays (sampled) or from photons");
  table.add_auto("direct_samples", &R::direct_samples, "shadow rays per camera ray and light")
      .at_least(1);
  table.add("kernel", &R::kernel, "photon radii by local density, or one radius for all");
  table.add("kernel_shape", &R::kernel_shape, "profile of the kernel");
  table.add_auto("radius", &R::radius, R"(radius of the fixed kernel, needed for kernel = "fixed")")
      .unit("world")
      .above(0)
      .absent("none");
  table.add_auto("neighbours", &R::neighbours, "photons in an adaptive kernel").at_least(1);
  table.add_auto("min_radius", &R::min_radius, "lower bound of adaptive radii")
      .unit("world")
      .above(0);
  table.add_auto("max_radius", &R::max_radius, "upper bound of adaptive radii")
      .unit("world")
      .above(0);
  table.add("alpha", &R::alpha, "radius shrinking over the passes; 1: none").above_up_to(0, 1);
  table.add("thinning", &R::thinning,
            "photons are kept where the camera sees them, or everywhere alike");
  table.add(
      "forward_peak", &R::forward_peak,
      "auto: multiple scattering leaves out the forward peak of the phase function, and less of it "
      "as passes are added; kept: multiple scattering has all of it");
  table.add("final_gather", &R::final_gather,
            "alias of older scenes: never keeps auto to gathering along camera rays, always means "
            "estimator = \"gather\"");
  table.add("max_bounces", &R::max_bounces, "scattering events per path")
      .at_least(1)
      .absent("none");
  table.add("cutoff", &R::cutoff, "transmittance at which a camera ray ends").inside(0, 1);
  table
      .add("bias_rays", &R::bias_rays,
           "share of the camera rays that are path traced too, to estimate the bias; 0: none")
      .within(0, 1);
  table
      .add("clamp", &R::clamp,
           "most that the medium may add to a pixel in one pass; removes light, and reports how "
           "much")
      .unit("radiance")
      .above(0)
      .absent("none");
  table.add("step", &R::step, "length of a step along a camera ray").unit("voxels").above(0);
  table.add("seed", &R::seed, "random numbers; the same seed gives the same picture")
      .at_least(0)
      .always_written();
  table.add("seeds", &R::seeds, "random numbers: others in each frame, or the same in all frames");
  table
      .add("threads", &R::threads,
           "threads; 0: all that the machine grants. Never changes the picture")
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
  add_mesh(table);
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
