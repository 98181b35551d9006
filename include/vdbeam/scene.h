#pragma once

#include "vdbeam/camera_settings.h"
#include "vdbeam/emission_settings.h"
#include "vdbeam/fog_settings.h"
#include "vdbeam/frame_time.h"
#include "vdbeam/kinds.h"
#include "vdbeam/layer_settings.h"
#include "vdbeam/light_settings.h"
#include "vdbeam/phase_settings.h"
#include "vdbeam/surface_settings.h"
#include "vdbeam/vec.h"
#include "vdbeam/volume_edits.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// The settings of a scene, as plain values in world units; docs/reference/scene.md gives unit,
/// range and default of each key. `load_scene` fills it from a file; programs may fill it
/// themselves.

struct VolumeSettings {
  std::string name;    ///< in Cryptomatte; empty: volume0, volume1, ...
  FogSettings fog;     ///< what stands for a file
  std::string file;    ///< path, frame pattern already substituted
  bool present = true; ///< false: this frame lies outside its sequence; nothing is there
  std::string density = "density"; ///< grid name
  double extinction = 1;           ///< sigma_t = extinction * extinction_scale * density [1/world]
  Rgb extinction_scale{1, 1, 1};   ///< per-channel factor of the extinction (chromatic media)
  Rgb albedo{1, 1, 1};             ///< sigma_s / sigma_t per channel, in [0, 1]
  PhaseSettings phase;
  EmissionSettings emission;
  VelocitySettings velocity;
  DensityRemap remap;
  Interpolation interpolation = Interpolation::linear; ///< of density and emission
  std::string add;        ///< names of grids that are added to the density: "a, b"
  std::string mask;       ///< names of grids whose values multiply the density; empty: none
  std::string color_grid; ///< a vec3 grid, or "r,g,b", that multiplies the albedo; "auto"; empty
  NoiseSettings noise;    ///< displaces density and emission
  std::optional<Vec3d> box_lower; ///< clipping box [world]; of a shape its box, see FogSettings
  std::optional<Vec3d> box_upper;
  /// Row-major affine 3x4 matrix applied after the grid's own index-to-world map.
  std::array<double, 12> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  bool glows() const { return present && emission.glows(); }
  /// Its extinction is not 0 where there is density.
  bool absorbs_or_scatters() const { return extinction * max_component(extinction_scale) > 0; }
  /// Something absorbs or scatters, or nothing else is there to look at.
  bool needs_density() const { return present && (absorbs_or_scatters() || !glows()); }
};

/// Places of a volume that is repeated (docs/reference/scene.md, [[instance]]). A scene that was
/// read has a volume for each of them already.
struct InstanceSettings {
  std::string volume;            ///< its name
  std::string file;              ///< path of the rows, frame pattern already substituted; or empty
  std::string columns = "x y z"; ///< what the numbers of a row are
};

enum class PhotonStore { fluence, scatter };
/// Which collisions of a light path become photons: by importance for the camera, or all with the
/// same probability; automatic: by view, unless only the camera moves in the scene file.
enum class PhotonThinning { automatic, view, even };
/// Whether multiple scattering uses delta-M truncation (docs/theory/beam.md, "Forward peaks").
enum class ForwardPeak { automatic, kept };
enum class KernelRadius { adaptive, fixed };
/// Whether the frames of a sequence use new random numbers or the same ones.
enum class SeedPolicy { per_frame, correlated };
enum class KernelShape { constant, epanechnikov, biweight };

struct RenderSettings {
  EstimatorType estimator = EstimatorType::automatic;
  std::optional<int> passes;            ///< the first of these three met ends the frame
  std::optional<double> time;           ///< seconds
  std::optional<double> target_error;   ///< MRSE
  std::optional<int> min_passes;        ///< fewest passes before target_error may end the frame
  std::optional<std::uint64_t> photons; ///< stored per pass; absent: automatic
  PhotonStore store = PhotonStore::fluence;
  DirectLight direct = DirectLight::automatic;
  int direct_samples = 0; ///< per ray and light; 0: automatic
  KernelRadius kernel = KernelRadius::adaptive;
  KernelShape kernel_shape = KernelShape::biweight;
  double radius = 0;     ///< fixed kernel, world units
  int neighbours = 0;    ///< adaptive kernel, photons per kernel; 0: automatic
  double min_radius = 0; ///< world units; 0: automatic
  double max_radius = 0; ///< world units; 0: automatic
  double alpha = 0.6;    ///< radius reduction (Knaus and Zwicker 2011), in (0, 1]
  ForwardPeak forward_peak = ForwardPeak::automatic;   ///< of scattering (beam, march)
  PhotonThinning thinning = PhotonThinning::automatic; ///< which collisions are stored (beam)
  std::optional<int> max_bounces; ///< scattering events per light path; absent: no limit
  double cutoff = 1e-6;           ///< transmittance below which a camera ray ends
  double bias_rays = 1.0 / 128;   ///< fraction of the camera rays path traced to estimate the bias
  std::optional<double> clamp;    ///< greatest radiance of the medium in a pixel of one pass
  double step = 1;                ///< march: step length in voxels
  std::uint64_t seed = 1;
  SeedPolicy seeds = SeedPolicy::correlated;
  int threads = 0; ///< 0: all that the machine grants
};

struct Scene {
  std::string path; ///< where it came from, for messages
  /// The scene at the motion samples of an open shutter, in order; empty if nothing moves or the
  /// shutter is closed. Each pass renders one of them.
  std::vector<Scene> moments;
  /// The scene one frame later, for the layer `motion`; empty without that layer or without
  /// animation.
  std::vector<Scene> next;
  FrameTime frame; ///< frame of a sequence
  ImageSettings image;
  CameraSettings camera;
  std::vector<VolumeSettings> volumes;
  std::vector<InstanceSettings> instances;
  std::vector<SurfaceSettings> surfaces;
  std::vector<LightSettings> lights;
  RenderSettings render;
  std::vector<LayerSettings> layers; ///< empty: the default layers
  bool black = false;                ///< a volume's file is missing and the frame is to be black
  std::vector<std::string> notes;    ///< for the user: what load_scene chose or found odd

  /// Whether any volume can emit light, in this frame or another.
  bool glows() const {
    for (const VolumeSettings& volume : volumes)
      if (!volume.emission.intensity.empty() || !volume.emission.temperature.empty())
        return true;
    return false;
  }
};

} // namespace vdbeam
