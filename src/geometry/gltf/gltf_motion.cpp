#include "geometry/gltf/gltf_motion.h"

#include <assimp/scene.h>

#include <algorithm>

namespace vdbeam {
namespace {

/// The value of sorted keys at a time; `mix(a, b, share)` interpolates. Requires a key.
template <class Key, class Mix>
auto value_at(const Key* keys, unsigned count, double ticks, Mix mix) {
  const Key* end = keys + count;
  const Key* after = std::lower_bound(keys, end, ticks,
                                      [](const Key& key, double time) { return key.mTime < time; });
  if (after == end)
    return keys[count - 1].mValue;
  if (after == keys)
    return keys[0].mValue;
  const Key& before = after[-1];
  const double width = after->mTime - before.mTime;
  const auto share = static_cast<float>(width > 0 ? (ticks - before.mTime) / width : 1);
  return mix(before.mValue, after->mValue, share);
}

Affine to_affine(const aiMatrix4x4& m) {
  Affine map;
  map.rows = {Vec3d{m.a1, m.a2, m.a3}, Vec3d{m.b1, m.b2, m.b3}, Vec3d{m.c1, m.c2, m.c3}};
  map.translation = {m.a4, m.b4, m.c4};
  return map;
}

} // namespace

Affine GltfMotion::at_rest(const aiNode& node) {
  return to_affine(node.mTransformation);
}

GltfMotion::GltfMotion(const aiScene& scene) {
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& animation = *scene.mAnimations[a];
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1000;
    for (unsigned c = 0; c < animation.mNumChannels; ++c)
      channels_.emplace(animation.mChannels[c]->mNodeName.C_Str(),
                        Channel{animation.mChannels[c], rate});
  }
}

const GltfMotion::Channel* GltfMotion::find(const aiNode& node) const {
  const auto found = channels_.find(node.mName.C_Str());
  return found == channels_.end() ? nullptr : &found->second;
}

Affine GltfMotion::matrix(const aiNode& node, double seconds) const {
  const Channel* channel = find(node);
  if (!channel)
    return at_rest(node);
  aiVector3D scale, position;
  aiQuaternion rotation;
  node.mTransformation.Decompose(scale, rotation, position);
  const double ticks = seconds * channel->ticks_per_second;
  const aiNodeAnim& motion = *channel->motion;
  const auto linear = [](const aiVector3D& a, const aiVector3D& b, float share) {
    return a + (b - a) * share;
  };
  if (motion.mNumPositionKeys > 0)
    position = value_at(motion.mPositionKeys, motion.mNumPositionKeys, ticks, linear);
  if (motion.mNumScalingKeys > 0)
    scale = value_at(motion.mScalingKeys, motion.mNumScalingKeys, ticks, linear);
  if (motion.mNumRotationKeys > 0)
    rotation = value_at(motion.mRotationKeys, motion.mNumRotationKeys, ticks,
                        [](const aiQuaternion& a, const aiQuaternion& b, float share) {
                          aiQuaternion mixed;
                          aiQuaternion::Interpolate(mixed, a, b, share);
                          return mixed;
                        });
  return to_affine(aiMatrix4x4(scale, rotation, position));
}

void GltfMotion::append_key_times(const aiNode& node, std::vector<double>& seconds) const {
  const Channel* channel = find(node);
  if (!channel)
    return;
  const auto add = [&](const auto* values, unsigned count) {
    for (unsigned i = 0; i < count; ++i)
      seconds.push_back(values[i].mTime / channel->ticks_per_second);
  };
  const aiNodeAnim& motion = *channel->motion;
  add(motion.mPositionKeys, motion.mNumPositionKeys);
  add(motion.mRotationKeys, motion.mNumRotationKeys);
  add(motion.mScalingKeys, motion.mNumScalingKeys);
}

} // namespace vdbeam
