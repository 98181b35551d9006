#include "report/image_metadata.h"

#include "camera/camera.h"
#include "film/layers.h"
#include "keys/scene_enums.h"
#include "report/plan_text.h"
#include "report/report.h"
#include "report/versions.h"
#include "text/attributes.h"

#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numbers>

namespace vdbeam {
namespace {

using Matrix = std::array<std::array<double, 4>, 4>;

/// OpenEXR's matrices act on row vectors: p' = p M. Camera space is left-handed: x right, y up,
/// z away from the viewer.
Matrix world_to_camera(const CameraSettings& camera) {
  const CameraFrame frame = camera_frame(camera);
  const std::array<Vec3d, 3> axes{frame.right, frame.up, frame.forward};
  Matrix m{};
  for (std::size_t column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      m[static_cast<std::size_t>(row)][column] = axes[column][row];
    m[3][column] = -dot(axes[column], camera.position);
  }
  m[3][3] = 1;
  return m;
}

/// Camera space to x and y in [0, 1] from the top left, after division by the fourth component.
Matrix camera_to_ndc(const CameraSettings& camera, const ImageSettings& image) {
  const ViewWindow window = view_window(camera, image);
  const double width = window.x1 - window.x0, height = window.y1 - window.y0;
  const bool parallel = camera.projection == Projection::orthographic;
  Matrix m{};
  m[0][0] = 1 / width;
  m[1][1] = -1 / height;
  m[2] = {0, 0, 1, 0};
  m[parallel ? 3 : 2][0] = -window.x0 / width;
  m[parallel ? 3 : 2][1] = window.y1 / height;
  m[parallel ? 3 : 2][3] = 1;
  return m;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        m[i][j] += a[i][k] * b[k][j];
  return m;
}

std::vector<float> flatten(const Matrix& m) {
  std::vector<float> values;
  for (const auto& row : m)
    for (const double x : row)
      values.push_back(static_cast<float>(x));
  return values;
}

/// When the picture was made, and which moment of the shot it shows.
void add_time(Image& image, const Scene& scene) {
  image.metadata["capDate"] = fmt::format("{:%Y:%m:%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
  image.numbers["utcOffset"] = 0;
  if (!scene.image.fps)
    return;
  const double fps = *scene.image.fps;
  image.numbers["framesPerSecond"] = fps;
  // A time code counts whole frames: at most 30 per second, and one day in all.
  const int count = static_cast<int>(std::ceil(fps - 1e-6));
  const int frame =
      scene.frame.number + frames_of_time_code(scene.image.time_code, count).value_or(0);
  if (frame < 0 || count > 30 || frame / count >= 24 * 3600)
    return;
  const int seconds = frame / count;
  image.metadata["timeCode"] = fmt::format("{:02}:{:02}:{:02}:{:02}", seconds / 3600,
                                           seconds / 60 % 60, seconds % 60, frame % count);
}

} // namespace

void add_error_metadata(Image& image, const PassRecord& record) {
  const std::pair<const char*, double> values[] = {{"errorEstimate", record.error_estimate},
                                                   {"errorLow", record.error_low},
                                                   {"errorHigh", record.error_high},
                                                   {"noiseEstimate", record.noise_estimate},
                                                   {"biasMrseEstimate", record.bias_mrse_estimate},
                                                   {"biasEstimate", record.bias_estimate},
                                                   {"biasMargin", record.bias_margin}};
  for (const auto& [name, value] : values) {
    const std::string key = fmt::format("vdbeam:{}", name);
    image.numbers.erase(key); // an older one would be of fewer passes
    if (std::isfinite(value))
      image.numbers[key] = value;
  }
}

namespace {

/// The schedule of passes by columns, since each part of a file has this text.
std::string schedule_text(const RenderPlan& plan) {
  nlohmann::ordered_json columns;
  for (const nlohmann::ordered_json& pass : schedule_json(plan))
    for (const auto& [name, value] : pass.items())
      columns[name].push_back(value);
  return columns.dump();
}

/// Adds the settings by which the image is written.
void add_format(Image& image, const Scene& scene, bool in_a_hurry) {
  if (!scene.layers.empty())
    image.metadata["vdbeam:layers"] = layers_text(scene.layers);
  if (in_a_hurry)
    image.metadata["vdbeam:compression"] = enum_name(Compression::rle);
  else if (scene.image.compression != Compression::zip)
    image.metadata["vdbeam:compression"] = enum_name(scene.image.compression);
  if (!scene.image.output_space.empty())
    image.metadata["vdbeam:outputSpace"] = scene.image.output_space;
  if (scene.image.parts != ImageParts::one)
    image.metadata["vdbeam:parts"] = enum_name(scene.image.parts);
  if (scene.image.layer_names != LayerNames::vdbeam)
    image.metadata["vdbeam:layerNames"] = enum_name(scene.image.layer_names);
  if (scene.image.tile > 0) {
    image.numbers["vdbeam:tile"] = scene.image.tile;
    image.integers.insert("vdbeam:tile");
  }
  for (const auto& [name, text] : parse_attributes(scene.image.attributes))
    image.metadata[name] = text;
}

/// Adds the reason why the render ended, its passes, seconds and errors.
void add_progress(Image& image, const Scene& scene, const RenderResult& result) {
  image.metadata["vdbeam:stoppedBy"] = result.stopped_by;
  if (result.quick_look) {
    image.metadata["vdbeam:quickLook"] = "no pass was finished";
    image.numbers["vdbeam:passes"] = 0;
  } else if (result.draft > 0) {
    image.numbers["vdbeam:draft"] = result.draft;
    image.numbers["vdbeam:passes"] = 0;
    image.integers.insert("vdbeam:draft");
  } else if (result.stopped_by != "stop")
    image.numbers["vdbeam:complete"] = 1; // what --skip-existing looks for
  if (!result.passes.empty()) {
    const PassRecord& last = result.passes.back();
    image.numbers["vdbeam:passes"] = last.pass;
    image.numbers["vdbeam:seconds"] = last.seconds;
    add_error_metadata(image, last);
  }
  image.numbers["vdbeam:photonsStored"] = static_cast<double>(result.statistics.photons_stored);
  if (scene.render.clamp) { // sums, so that parts can be joined
    image.numbers["vdbeam:clampRemoved"] = result.statistics.clamp_removed;
    image.numbers["vdbeam:clampTotal"] = result.statistics.clamp_total;
    image.numbers["vdbeam:clampedPixels"] = static_cast<double>(result.statistics.clamped_pixels);
  }
  if (result.deep) {
    image.numbers["vdbeam:deepSamples"] = static_cast<double>(result.deep->z.size());
    image.numbers["vdbeam:deepAlphaError"] = static_cast<double>(result.deep->alpha_error);
    image.integers.insert("vdbeam:deepSamples");
  }
  image.numbers["vdbeam:peakMemory"] = static_cast<double>(result.statistics.peak_memory);
}

/// Adds the camera, for compositing.
void add_camera(Image& image, const Scene& scene) {
  const ViewWindow window = view_window(scene.camera, scene.image);
  if (scene.camera.projection == Projection::perspective)
    image.numbers["vdbeam:cameraFov"] =
        scene.camera.focal_length ? 360 / std::numbers::pi * std::atan((window.y1 - window.y0) / 2)
                                  : scene.camera.fov;
  const Vec3d& position = scene.camera.position;
  image.matrices["vdbeam:cameraPosition"] = {static_cast<float>(position.x),
                                             static_cast<float>(position.y),
                                             static_cast<float>(position.z)};
  const Matrix view = world_to_camera(scene.camera);
  image.matrices["worldToCamera"] = flatten(view);
  if (scene.camera.projection != Projection::panorama)
    image.matrices["worldToNDC"] = flatten(product(view, camera_to_ndc(scene.camera, scene.image)));
}

} // namespace

void add_image_metadata(Image& image, const Scene& scene, const RenderResult& result,
                        const std::string& hash) {
  for (const auto& [name, version] : component_versions())
    if (name == "vdbeam")
      image.metadata["software"] = "vdbeam " + version;
  std::error_code error; // where there is no working folder, the path stays as it was written
  const std::filesystem::path absolute = std::filesystem::absolute(scene.path, error);
  image.metadata["vdbeam:scene"] = error ? scene.path : absolute.lexically_normal().string();
  image.metadata["vdbeam:sceneHash"] = hash;
  image.metadata["vdbeam:estimator"] = std::string(
      result.plan.estimator.empty() ? scene.render.estimator.name : result.plan.estimator);
  if (!result.plan.features.empty())
    image.metadata["vdbeam:features"] = features_text(result.plan);
  if (!result.plan.numbers.empty())
    image.metadata["vdbeam:numbers"] = numbers_text(result.plan);
  if (!result.plan.schedule.empty())
    image.metadata["vdbeam:schedule"] = schedule_text(result.plan);
  image.numbers["vdbeam:frame"] = scene.frame.number;
  image.numbers["vdbeam:seed"] = static_cast<double>(scene.render.seed);
  // A draft and a quick look are packed in no time, for their time is over.
  add_format(image, scene, result.quick_look || result.draft > 0);
  add_progress(image, scene, result);
  for (const char* name : {"vdbeam:frame", "vdbeam:complete", "vdbeam:seed", "vdbeam:passes",
                           "vdbeam:photonsStored", "vdbeam:clampedPixels"})
    if (image.numbers.contains(name))
      image.integers.insert(name);
  add_time(image, scene);
  add_camera(image, scene);
}

} // namespace vdbeam
