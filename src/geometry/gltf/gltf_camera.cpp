#include "geometry/gltf/gltf_camera.h"

#include "geometry/gltf/gltf_files.h"
#include "geometry/gltf/gltf_motion.h"
#include "geometry/uri_files.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <set>

namespace vdbeam {
namespace {

/// Enough for hours at any frame rate; what asks for more is damaged.
constexpr double most_keys = 1e6;

/// The nodes from the root to the camera's.
std::vector<const aiNode*> joints_of(const aiNode* node) {
  std::vector<const aiNode*> joints;
  for (; node; node = node->mParent)
    joints.insert(joints.begin(), node);
  return joints;
}

/// Times [seconds] at which the camera is sampled: all keys, and `rate` per second in between.
std::vector<double> sample_times(const GltfMotion& motion, const std::vector<const aiNode*>& joints,
                                 double rate) {
  std::vector<double> found;
  for (const aiNode* joint : joints)
    motion.append_key_times(*joint, found);
  const std::set<double> keys(found.begin(), found.end());
  if (keys.empty())
    return {0};
  const double length = *keys.rbegin() - *keys.begin();
  if (!(length * rate + static_cast<double>(keys.size()) < most_keys))
    throw std::runtime_error("its animation is too long");
  std::vector<double> times;
  for (const double key : keys) {
    if (!times.empty()) {
      const double before = times.back();
      const int parts = std::max(1, static_cast<int>(std::ceil((key - before) * rate)));
      for (int i = 1; i < parts; ++i)
        times.push_back(before + (key - before) * i / parts);
    }
    times.push_back(key);
  }
  return times;
}

/// The vertical field of view [degrees]; NaN: the camera is orthographic. assimp gives that of the
/// file times the aspect ratio.
double fov_of(const aiCamera& camera) {
  if (!(camera.mHorizontalFOV > 0))
    return std::nan("");
  const auto aspect = static_cast<double>(camera.mAspect);
  return static_cast<double>(camera.mHorizontalFOV) / (aspect > 0 ? aspect : 1) * 180 /
         std::numbers::pi;
}

/// assimp gives cameras the names of their nodes.
const aiCamera& find_camera(const std::string& path, const aiScene& scene,
                            const std::string& name) {
  std::string names;
  for (unsigned i = 0; i < scene.mNumCameras; ++i) {
    const aiCamera& camera = *scene.mCameras[i];
    if (name.empty() || camera.mName.C_Str() == name)
      return camera;
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", camera.mName.C_Str());
  }
  if (names.empty())
    throw InputError(path + ": holds no camera");
  throw InputError(fmt::format("{}: holds no camera \"{}\", only {}", path, name, names));
}

struct RawKey {
  double seconds;
  std::array<double, 12> matrix;
};

/// In the child: parses the file, writes the field of view and the keys.
void parse(const std::string& path, const std::string& name, double rate, int output) {
  Assimp::Importer importer;
  open_uris(importer);
  const aiScene* scene = importer.ReadFile(path, 0);
  if (!scene)
    throw std::runtime_error(importer.GetErrorString());
  const aiCamera& camera = find_camera(path, *scene, name);
  const aiNode* node = scene->mRootNode ? scene->mRootNode->FindNode(camera.mName) : nullptr;
  if (!node)
    throw std::runtime_error("its camera stands nowhere");
  const double fov = fov_of(camera);
  write_all(output, &fov, sizeof fov);
  const GltfMotion motion(*scene);
  const std::vector<const aiNode*> joints = joints_of(node);
  for (const double seconds : sample_times(motion, joints, rate)) {
    Affine m;
    for (const aiNode* joint : joints)
      m = m.after(motion.matrix(*joint, seconds));
    const auto& [x, y, z] = m.rows;
    const Vec3d& t = m.translation;
    const RawKey key{seconds, {x.x, x.y, x.z, t.x, y.x, y.y, y.z, t.y, z.x, z.y, z.z, t.z}};
    write_all(output, &key, sizeof key);
  }
}

} // namespace

bool is_gltf_file(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  return extension == ".gltf" || extension == ".glb";
}

CameraTrack read_gltf_camera(const std::string& path, const std::string& name, double rate) {
  const std::uint64_t bytes = check_input_file(path) + bytes_of_gltf_files(path);
  GuardLimits limits;
  limits.cpu_seconds = 2 + 5e-6 * static_cast<double>(bytes);
  limits.bytes = std::min(free_memory(), (std::uint64_t(512) << 20) + 200 * bytes);
  const MappedFile file =
      run_guarded(path, limits, [&](int output) { parse(path, name, rate, output); });
  const std::size_t rest = file.size() - std::min(file.size(), sizeof(double));
  if (rest < sizeof(RawKey) || rest % sizeof(RawKey) != 0)
    throw FrameError(path + ": the reader returned too little");
  CameraTrack track;
  double fov = 0;
  std::memcpy(&fov, file.data(), sizeof fov);
  if (!std::isnan(fov))
    track.fov = fov;
  for (std::size_t at = sizeof fov; at < file.size(); at += sizeof(RawKey)) {
    RawKey key;
    std::memcpy(&key, file.data() + at, sizeof key);
    for (const double value : key.matrix)
      if (!std::isfinite(value))
        throw FrameError(path + ": a camera's matrix is not finite");
    track.keys.push_back({key.seconds, Affine::from_matrix(key.matrix)});
  }
  return track;
}

} // namespace vdbeam
