#pragma once

#include "math/affine.h"

#include <string>
#include <unordered_map>
#include <vector>

struct aiNode;
struct aiNodeAnim;
struct aiScene;

namespace vdbeam {

/// How the nodes of a scene that assimp has read move: translation, rotation and scale, linear
/// between their keys, as at the nearest key before the first and after the last. Refers to the
/// scene. For guarded processes.
class GltfMotion {
public:
  explicit GltfMotion(const aiScene& scene);

  /// From the node to what it hangs from, at rest.
  static Affine at_rest(const aiNode& node);
  /// The same at a time.
  Affine matrix(const aiNode& node, double seconds) const;
  /// Appends the times of the node's keys [seconds], unsorted.
  void append_key_times(const aiNode& node, std::vector<double>& seconds) const;

private:
  struct Channel {
    const aiNodeAnim* motion = nullptr;
    double ticks_per_second = 1;
  };
  const Channel* find(const aiNode& node) const;

  std::unordered_map<std::string, Channel> channels_; ///< by the names of their nodes
};

} // namespace vdbeam
