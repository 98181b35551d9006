#include "choose/group_passes.h"

#include "layers/light_group_names.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vdbeam {
namespace {

/// Task of one group of lights: it has its own choices and photons.
EstimatorTask task_of(const EstimatorInput& of_all, std::size_t group) {
  EstimatorTask task = of_all;
  task.all_lights = &of_all.world.lights;
  task.photons = nullptr;
  if (task.of_scene)
    task.of_scene += group;
  return task;
}

/// The lights of one group, as if there were no others.
struct Group {
  Group(const EstimatorInput& from, std::size_t index, const std::vector<bool>& lights,
        bool with_emission)
      : world(from.world), plan(from.plan),
        input(world, from.camera, from.settings, plan, task_of(from, index)) {
    world.lights = from.world.lights.only(lights);
    if (!with_emission)
      world.medium.emitters.clear();
    plan.shadow_ray_lights.clear();
    for (std::size_t i = 0; i < from.plan.shadow_ray_lights.size(); ++i)
      if (lights[i])
        plan.shadow_ray_lights.push_back(from.plan.shadow_ray_lights[i]);
  }
  Group(const Group&) = delete;

  World world;
  RenderPlan plan;
  EstimatorInput input;
  std::unique_ptr<PassRenderer> passes;
};

std::vector<std::unique_ptr<Group>> groups_of(const Scene& scene, const EstimatorInput& input) {
  std::vector<std::unique_ptr<Group>> groups;
  for (const std::string& name : light_group_names(scene)) {
    const bool is_rest = name == rest_group;
    // Volumes that glow are lights that come after those of the scene.
    std::vector<bool> lights(input.world.lights.size(), is_rest);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      lights[i] = scene.lights[i].group == (is_rest ? "" : name);
    groups.push_back(std::make_unique<Group>(input, groups.size(), lights, is_rest));
  }
  return groups;
}

void add(std::vector<Rgb>& to, const std::vector<Rgb>& what) {
  for (std::size_t i = 0; i < what.size(); ++i)
    to[i] += what[i];
}

/// Blur is additive as light is.
void add_blur(std::vector<PixelValue>& to, const std::vector<PixelValue>& what) {
  std::map<std::size_t, Rgb> sums;
  for (const std::vector<PixelValue>* values : {&std::as_const(to), &what})
    for (const PixelValue& value : *values)
      sums[value.pixel] += value.radiance;
  to.clear();
  for (const auto& [pixel, radiance] : sums)
    to.push_back({pixel, radiance});
}

class GroupPasses final : public PassRenderer {
public:
  GroupPasses(const Scene& scene, const EstimatorType& type, const EstimatorInput& input)
      : input_(input), groups_(groups_of(scene, input)) {
    for (const std::unique_ptr<Group>& group : groups_)
      group->passes = std::make_unique<FramePasses>(type, group->input);
  }

  void render_pass(int pass, PassImage& image, RenderStatistics& statistics) override {
    PassImage part;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      PassImage& target = g == 0 ? image : part;
      groups_[g]->passes->render_pass(pass, target, statistics);
      std::vector<Rgb> light(target.direct.size());
      for (std::size_t i = 0; i < light.size(); ++i)
        light[i] = target.total(i);
      if (g > 0)
        add_part(part, image);
      image.groups.push_back(std::move(light));
      if (input_.stopped()) {
        std::fill(image.finished_tiles.begin(), image.finished_tiles.end(), 0);
        return;
      }
    }
  }

  const Choices& choices() const override { return groups_[0]->passes->choices(); }

private:
  void add_part(const PassImage& part, PassImage& image) const {
    add(image.direct, part.direct);
    add(image.indirect, part.indirect);
    add(image.background, part.background);
    add_blur(image.blur, part.blur);
    for (std::size_t i = 0; i < image.deep.size(); ++i)
      if (i % DeepLayout::values_per_piece < 3) // every part has the medium's opacity
        image.deep[i] += part.deep[i];
    for (std::size_t i = 0; i < image.planes.size(); ++i)
      if (input_.layers->is_light(i))
        for (std::size_t pixel = 0; pixel < image.planes[i].size(); ++pixel)
          image.planes[i][pixel] += part.planes[i][pixel];
    if (image.emission.empty())
      image.emission = part.emission;
    else
      add(image.emission, part.emission);
    for (std::size_t i = 0; i < image.finished_tiles.size(); ++i)
      image.finished_tiles[i] = image.finished_tiles[i] && part.finished_tiles[i];
  }

  EstimatorInput input_;
  std::vector<std::unique_ptr<Group>> groups_;
};

} // namespace

std::unique_ptr<PassRenderer> make_group_passes(const Scene& scene, const EstimatorType& type,
                                                const EstimatorInput& input) {
  return std::make_unique<GroupPasses>(scene, type, input);
}

std::vector<SceneChoices> choose_for_groups(const Scene& scene, const EstimatorType& type,
                                            const EstimatorInput& input) {
  std::vector<SceneChoices> choices;
  for (const std::unique_ptr<Group>& group : groups_of(scene, input))
    choices.push_back(choose_for_scene(group->input, estimator_kind(type)));
  return choices;
}

} // namespace vdbeam
