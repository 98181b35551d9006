#pragma once

#include "lights/light_set.h"
#include "transport/next_event.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace vdbeam {

/// A light that a shadow ray is sent to.
struct DrawnLight {
  std::size_t light;
  float weight = 1; ///< reciprocal of the chance that it was drawn
};

/// Keeps about `count` of the candidates from index `first` on, whose weights are how much they
/// matter, and sets these to the reciprocals of their chances. Chances go with the weights, but are
/// at most 1: who matters enough is kept for certain. The others are drawn systematically, all by
/// one random number, so that the number of those kept does not vary (Madow, On the theory of
/// systematic sampling II, 1949). Candidates of weight 0 are left out. All others are kept if
/// they are at most twice `count`: to draw would cost about what it saves.
void draw_systematically(std::vector<DrawnLight>& candidates, std::size_t first, std::size_t count,
                         Rng& rng);

/// About how much a flight may find of a lamp that it passes: its intensity times the integral of
/// 1 / r^2 along the segment, which is L / d^2 far from the lamp and pi / d near it, d being the
/// distance between the lamp and the segment, and L the segment's length.
float lamp_importance(const Light& lamp, const Segment& segment);

/// The lights that the shadow rays of a vertex look for. There may be hundreds of lamps: of
/// more than twice tuning::lamps_per_vertex a vertex draws that many, with chances that go with the
/// light that it scatters if nothing is in between. To each chance belongs a part that does not
/// depend on the angle: where the vertex scatters a little more than evaluate() says, as with the
/// aureole of a peak, no weight is large. Other lights, such as suns and skies, are always looked
/// for.
class LightDraw {
public:
  /// `sampled`: per light, whether shadow rays look for it. `lights` must outlive this.
  LightDraw(const LightSet& lights, const std::vector<bool>& sampled);

  /// Puts the lights for a vertex to `drawn`, but those that is_left_out(light). Unbiased in the
  /// sum of weight times the light of each.
  template <PathVertex Vertex, class IsLeftOut>
  void draw(const Vertex& vertex, Rng& rng, const IsLeftOut& is_left_out,
            std::vector<DrawnLight>& drawn) const {
    drawn.clear();
    for (const std::size_t light : others_)
      if (!is_left_out(light))
        drawn.push_back({light});
    const std::size_t first = drawn.size();
    for (const std::size_t light : lamps_)
      if (!is_left_out(light))
        drawn.push_back({light});
    if (drawn.size() - first <= 2 * most())
      return;
    for (std::size_t i = first; i < drawn.size(); ++i)
      drawn[i].weight = expected((*lights_)[drawn[i].light], vertex);
    draw_systematically(drawn, first, most(), rng);
  }

  /// How many lights a vertex looks for if it leaves none out.
  std::size_t usual_count() const {
    return others_.size() + (lamps_.size() <= 2 * most() ? lamps_.size() : most());
  }

  /// The most lamps that a vertex, or a flight that passes them, looks for.
  static std::size_t most();

private:
  template <PathVertex Vertex>
  static float expected(const Light& light, const Vertex& vertex) {
    const IncidentSample sample = light.typical_incident(vertex.position());
    const float arriving = max_component(sample.value);
    if (!(arriving > 0))
      return 0;
    const Rgb scattered = vertex.evaluate(sample.wi);
    if (light.is_delta() && scattered == Rgb())
      return 0;
    constexpr float at_any_angle = 1 / (4 * pi);
    return std::min(arriving * (std::max(0.0f, max_component(scattered)) + at_any_angle),
                    std::numeric_limits<float>::max());
  }

  const LightSet* lights_;
  std::vector<std::size_t> lamps_, others_; ///< with shadow rays: too many lamps; all other lights
};

} // namespace vdbeam
