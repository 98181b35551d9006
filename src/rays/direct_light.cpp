#include "rays/direct_light.h"

#include "medium/distance_sampling.h"
#include "medium/equi_angular.h"
#include "transport/light_draw.h"
#include "transport/next_event.h"
#include "tuning/constants.h"

#include <optional>

namespace vdbeam {

namespace {

/// How much light a point scatters by an angle, where its medium may lack a forward peak.
///
/// Light that is scattered once has all of the scene's phase function p, but on its way before and
/// after it goes straight on at every further scattering by the peak, as in the medium without it:
/// the TMS method (Nakajima and Tanaka 1988). Light that only the peak scatters would then count
/// once for each of those scatterings, all from where the light is. Towards the light, and from a
/// light that surrounds the medium, it counts at the last of them only, seen through the scene's
/// own medium, and comes spread by those before (Aureole).
struct SinglePhase {
  const PhaseFunction& phase; ///< the scene's
  const PhaseFunction* gathered = nullptr;
  const Aureole* aureole = nullptr;
  float forward = 0;    ///< share of the peak that was taken out
  Rgb through{1, 1, 1}; ///< transmittance to the point of what was taken out

  float evaluate(float cosine) const { return phase.evaluate(cosine); }
  /// Phase value in the delta-scaled medium, whose scattering is the fraction 1 - forward.
  /// `taken_out`: optical depth of the peak on the way from the light.
  Rgb weight(bool surrounds, float p, float cosine, const Rgb& taken_out) const {
    const float tms = p / (1 - forward);
    const float share = surrounds ? 1 : share_of_aureole(cosine);
    if (!(forward > 0) || share == 0)
      return Rgb(tms);
    const float smooth = gathered->evaluate(cosine), peak = p - (1 - forward) * smooth;
    Rgb spread(aureole->spread(peak, cosine, taken_out.x));
    for (int c = 1; c < 3; ++c)
      if (taken_out[c] != taken_out.x)
        spread[c] = aureole->spread(peak, cosine, taken_out[c]);
    const Rgb exact = Rgb(smooth) + through * spread * (1 / (1 - forward));
    return exact * share + Rgb(tms * (1 - share));
  }

private:
  /// 1 up to 10 degrees, 0 from 35 degrees on, where TMS is about as good.
  static float share_of_aureole(float cosine) {
    constexpr float begin = 0.8192f, end = 0.9848f;
    const float x = std::clamp((cosine - begin) / (end - begin), 0.0f, 1.0f);
    return x * x * (3 - 2 * x);
  }
};

/// Single scattering along one camera ray.
class RayLighting {
public:
  RayLighting(const World& world, const Ray& ray, const DepthProfile& profile,
              const LightSampling& sampling, Rng& rng, std::uint64_t& shadow_rays,
              const RaySink& sink)
      : world_(world), ray_(ray), profile_(profile), distances_(world.medium, ray, profile),
        light_draw_(world.lights, sampling.sampled), rng_(rng), shadow_rays_(shadow_rays),
        sink_(sink), share_(sampling.weight / static_cast<float>(sampling.samples)) {
    for (std::size_t l = 0; l < world.lights.size(); ++l) {
      if (!sampling.sampled[l])
        continue;
      lights_.push_back({.index = l});
      look_near(lights_.back());
      if (sampling.shadows && l < sampling.shadows->size() && (*sampling.shadows)[l])
        weigh_pieces(*(*sampling.shadows)[l], lights_.back());
    }
  }

  /// All lights at a distance drawn by what scatters.
  GroupedLight by_medium(float u) {
    const bool chromatic = world_.medium.chromatic;
    const int c = chromatic ? std::min(2, static_cast<int>(rng_.uniform() * 3)) : 0;
    GroupedLight sum;
    if (!(distances_.opacity(c) > 0))
      return sum;
    const ScatterPoint point = distances_.sample(u, c);
    if (!(point.pdf > 0)) // in a medium too dense for single precision to place the point
      return sum;
    light_draw_.draw(
        PointVertex{world_.medium, ray_, point}, rng_,
        [&](std::size_t l) { return !sampled_light(l).pieces.empty(); }, drawn_);
    for (const auto& [l, weight] : drawn_) {
      const SampledLight& light = sampled_light(l);
      const float other = light.near ? light.near->pdf(point.t) : 0;
      add(sum, light, scattered(point, l, weight * point.pdf / (point.pdf + other)));
    }
    sink_.add_at(point.t, sum.sum() * share_);
    return sum;
  }

  /// Lights with a shadow lattice, at distances drawn by the weights of their pieces.
  GroupedLight by_shadow(float u) {
    GroupedLight sum;
    for (const SampledLight& light : lights_) {
      if (light.pieces.empty())
        continue;
      const float x = u * light.pieces.back().weight;
      std::size_t i = 0;
      while (i + 1 < light.pieces.size() && light.pieces[i].weight <= x)
        ++i;
      const Piece before = i > 0 ? light.pieces[i - 1] : Piece{0, 0};
      const Piece& piece = light.pieces[i];
      const float weight = piece.weight - before.weight, seen = piece.opacity - before.opacity;
      if (!(weight > 0))
        continue;
      const float opacity = distances_.opacity(0);
      const float within = std::clamp((x - before.weight) / weight, 0.0f, 1.0f);
      const ScatterPoint point =
          distances_.sample(std::min((before.opacity + within * seen) / opacity, 1.0f), 0);
      // By the medium alone, the piece is drawn with its share of the opacity.
      const float share = seen / opacity, drawn = weight / light.pieces.back().weight;
      // Where a point is drawn since light is expected there, chance is not to take it away.
      const float certain = tuning::certain_depth + light.shadow->depth(point.position);
      if (point.pdf > 0)
        add(sum, light, take_down(point, scattered(point, light.index, share / drawn, certain)));
    }
    return sum;
  }

  /// Each light that stands in or near the medium, at a distance drawn by its 1 / r^2.
  GroupedLight by_nearness(float u) {
    GroupedLight sum;
    drawn_.clear();
    for (const SampledLight& light : lights_)
      if (light.near)
        drawn_.push_back({light.index, light.importance});
    draw_systematically(drawn_, 0, LightDraw::most(), rng_);
    for (const auto& [l, weight] : drawn_) {
      const SampledLight& light = sampled_light(l);
      const ScatterPoint point = distances_.at(light.near->sample(u));
      const float other = light.near->pdf(point.t);
      if (point.pdf > 0)
        add(sum, light,
            take_down(point, scattered(point, l, weight * point.pdf / (point.pdf + other))));
    }
    return sum;
  }

private:
  /// Opacity and weight of the ray from its beginning to the end of a piece.
  struct Piece {
    float opacity, weight;
  };
  struct SampledLight {
    std::size_t index;
    std::optional<EquiAngular> near = {};  ///< where its nearness needs samples of its own
    float importance = 0;                  ///< of its nearness
    const ShadowLattice* shadow = nullptr; ///< null without one
    std::vector<Piece> pieces = {};        ///< by the lattice; empty without one
  };

  /// A point of the ray, which scatters by all volumes there.
  struct PointVertex {
    const Medium& medium;
    const Ray& ray;
    const ScatterPoint& point;

    const Vec3f& position() const { return point.position; }
    Vec3d leave(const Vec3f&) const { return Vec3d(point.position); }
    Rgb evaluate(const Vec3f& wi) const {
      Rgb sum;
      float all = 0;
      for (std::size_t i = 0; i < point.weights->size(); ++i) {
        const float weight = max_component((*point.weights)[i]);
        const Volume& volume = medium.volumes[(*point.volumes)[i]];
        const auto phase = static_cast<std::size_t>(volume.phase_index);
        sum += Rgb(weight * medium.phases[phase].evaluate(dot(ray.direction, wi)));
        all += weight;
      }
      return all > 0 ? sum / all : Rgb();
    }
  };

  const SampledLight& sampled_light(std::size_t light) const {
    return *std::lower_bound(
        lights_.begin(), lights_.end(), light,
        [](const SampledLight& one, std::size_t other) { return one.index < other; });
  }

  void add(GroupedLight& sum, const SampledLight& light, const Rgb& found) const {
    sum.add(found, world_.lights.group(light.index));
  }

  /// Distances by nearness, where they are of use: to a light that is near, or that shines on a
  /// part of the ray only.
  void look_near(SampledLight& sampled) const {
    const Light& light = world_.lights[sampled.index];
    const Segment all{ray_, profile_.front(), profile_.back()};
    if (light.position() == nullptr || all.empty())
      return;
    const Segment lit = light.lit_part(all);
    if (lit.empty())
      return;
    const EquiAngular near(ray_, *light.position(), lit.t_begin, lit.t_end,
                           world_.medium.angles.get());
    const bool small = lit.t_end - lit.t_begin < tuning::small_lit_part * (all.t_end - all.t_begin);
    if (!small && !near.useful())
      return;
    sampled.near = near;
    sampled.importance = lamp_importance(light, lit);
  }

  /// Cuts the ray where opacity or shadow may change much, and weighs the pieces by both.
  void weigh_pieces(const ShadowLattice& shadow, SampledLight& light) {
    light.shadow = &shadow;
    const float opacity = distances_.opacity(0);
    const std::size_t last = profile_.knots() - 1;
    float t = profile_.front(), seen = 0, sum = 0, before = shadow.transmittance(ray_.at(t));
    for (std::size_t k = 1; k <= last; ++k) {
      const float now = opacity_of(profile_.total(k));
      if (k < last && (now == seen || profile_.t(k) - t < shadow.step()))
        continue;
      t = profile_.t(k);
      const float after = shadow.transmittance(ray_.at(t));
      sum += (now - seen) * 0.5f * (before + after);
      light.pieces.push_back({now, sum});
      before = after;
      seen = now;
    }
    const float least = opacity > 0 ? tuning::lit_everywhere * sum / opacity + 1e-6f : 0;
    for (Piece& piece : light.pieces)
      piece.weight += least * piece.opacity;
  }

  /// Adds the light of one of the samples to the deep image, and returns it.
  const Rgb& take_down(const ScatterPoint& point, const Rgb& light) {
    sink_.add_at(point.t, light * share_);
    return light;
  }

  /// Radiance that one light scatters into the ray at the point, times `factor`. Balance heuristic
  /// (Veach and Guibas 1995): the point's weights hold 1 / point.pdf already.
  Rgb scattered(const ScatterPoint& point, std::size_t light, float factor,
                float certain_depth = tuning::certain_depth) {
    const Medium& medium = world_.medium;
    Rgb sum;
    for (std::size_t i = 0; i < point.weights->size(); ++i) {
      const Rgb& weight = (*point.weights)[i];
      if (!(max_component(weight) > 0))
        continue;
      const std::size_t v = profile_.volume(i);
      const Rgb radiance =
          weight * scattered_light(light, single_phase(medium.volumes[v].phase_index, point.t),
                                   point.position, certain_depth);
      sink_.add_of_volume(medium.volumes[v].setting, radiance * (factor * share_));
      sum += radiance;
    }
    return sum * factor;
  }

  /// Radiance that one light scatters at a point into the ray, per unit of weight.
  /// `certain_depth`: optical depth before which no shadow ray ends at random.
  Rgb scattered_light(std::size_t index, const SinglePhase& single, const Vec3f& point,
                      float certain_depth) {
    const Vec3f& direction = ray_.direction;
    const Light& light = world_.lights[index];
    const bool surrounds = world_.lights.traits(index).surrounds;
    const PhaseFunction& phase = single.phase;
    const MediumVertex vertex{point, direction, phase};
    struct Arriving {
      Rgb through, phase; ///< transmittance of the shadow ray, and how much of it is scattered
    };
    const auto arriving = [&](const Segment& shadow) -> Arriving {
      const float cosine = dot(direction, shadow.ray.direction);
      ++shadow_rays_;
      Rgb taken_out;
      const Rgb through =
          estimate_transmittance(world_.medium, shadow, rng_.uniform(), &taken_out, certain_depth);
      return {through, single.weight(surrounds, phase.evaluate(cosine), cosine, taken_out)};
    };
    Rgb sum;
    if (const auto direct = sample_direct_light(world_, light, vertex, rng_, [&](const Vec3f& wi) {
          return phase.evaluate(dot(direction, wi));
        })) {
      const auto [through, scattered] = arriving(direct->segment);
      sum += direct->light * (scattered * direct->weight) * through;
    }
    if (light.is_delta())
      return sum;
    const float u_lobe = rng_.uniform(), u2 = rng_.uniform(), v2 = rng_.uniform();
    const Vec3f wi = phase.sample(direction, u_lobe, u2, v2);
    const LightHit hit = light.emitted_radiance({{point, wi}});
    if (max_component(hit.radiance) > 0 && unoccluded(world_, Vec3d(point), wi, hit.distance)) {
      const auto [through, scattered] = arriving({{point, wi}, 0, hit.distance});
      sum += hit.radiance * through * scattered /
             (phase.evaluate(dot(direction, wi)) + light.incident_pdf(point, wi));
    }
    return sum;
  }

  SinglePhase single_phase(int index, float t) const {
    const Medium& medium = world_.medium;
    const auto i = static_cast<std::size_t>(index);
    if (!medium.peak)
      return {medium.phases[i]};
    const PeakTakenOut& peak = *medium.peak;
    ProfileCursor cursor(profile_);
    cursor.move_to(t);
    return {peak.original[i], &peak.gathered[i], &peak.aureoles[i], peak.forward[i],
            transmittance_of(cursor.taken_out(medium))};
  }

  const World& world_;
  const Ray& ray_;
  const DepthProfile& profile_;
  DistanceSampler distances_;
  LightDraw light_draw_;
  Rng& rng_;
  std::uint64_t& shadow_rays_;
  const RaySink& sink_;
  float share_;                      ///< what one sample counts
  std::vector<SampledLight> lights_; ///< by index
  std::vector<DrawnLight> drawn_;    ///< for the present sample
};

} // namespace

GroupedLight direct_light(const World& world, const Ray& ray, const DepthProfile& profile,
                          const LightSampling& sampling, Rng& rng, std::uint64_t& shadow_rays,
                          const RaySink& sink) {
  constexpr int samples_per_check = 16;
  const std::vector<bool>& sampled = sampling.sampled;
  GroupedLight sum;
  if (profile.empty() || std::find(sampled.begin(), sampled.end(), true) == sampled.end())
    return sum;
  const float share = 1 / static_cast<float>(sampling.samples);
  const bool by_shadow = sampling.shadows && !sampling.shadows->empty();
  RayLighting lighting(world, ray, profile, sampling, rng, shadow_rays, sink);
  for (int i = 0; i < sampling.samples; ++i) {
    if (i % samples_per_check == samples_per_check - 1 && sampling.stop && sampling.stop->stopped())
      break;
    sum += lighting.by_medium((static_cast<float>(i) + rng.uniform()) * share);
    if (by_shadow)
      sum += lighting.by_shadow((static_cast<float>(i) + rng.uniform()) * share);
    sum += lighting.by_nearness((static_cast<float>(i) + rng.uniform()) * share);
  }
  return sum * (share * sampling.weight);
}

ShadowLattices make_shadow_lattices(const World& world, const std::vector<bool>& sampled,
                                    double rays) {
  ShadowLattices lattices(world.lights.size());
  for (std::size_t l = 0; l < lattices.size(); ++l)
    if (const Vec3f* towards = world.lights[l].narrow_direction(); towards && sampled[l])
      lattices[l] = std::make_unique<ShadowLattice>(world.medium, *towards, rays);
  return lattices;
}

} // namespace vdbeam
