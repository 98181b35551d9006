#include "cloud_puffs.h"

#include <cmath>

namespace vdbeam {

namespace {

using openvdb::Vec3f;

constexpr float turn = 6.2831853f;

/// A direction that points upwards or at most a little down.
Vec3f mostly_up(Dice& dice) {
  const float y = dice.between(-0.25f, 1), angle = turn * dice.next();
  const float across = std::sqrt(std::max(1 - y * y, 0.0f));
  return {across * std::cos(angle), y, across * std::sin(angle)};
}

/// A leaning stack of balls from the base to `height`, widest at the foot.
void add_tower(std::vector<Puff>& puffs, const Vec3f& foot, float height, float radius,
               Dice& dice) {
  const int count = std::max(static_cast<int>(2.2f * height / radius), 3);
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const float angle = turn * dice.next(), away = 0.6f * radius * dice.next();
    const float r = radius * (1.05f - 0.35f * t) * dice.between(0.7f, 1.1f);
    puffs.push_back(
        {foot + Vec3f(away * std::cos(angle) + 0.1f * height * t * t,
                      0.6f * radius + t * (height - 1.4f * radius), away * std::sin(angle)),
         r});
  }
}

/// A thin, wide shelf of flat balls around the top of the tower, longest along x; thinner and
/// higher outwards.
void add_anvil(std::vector<Puff>& puffs, const Vec3f& top, float reach, Dice& dice) {
  for (int i = 0; i < 260; ++i) {
    const float angle = turn * dice.next(), away = std::sqrt(dice.next());
    const float x = reach * (0.14f + away * std::cos(angle)),
                z = 0.7f * reach * away * std::sin(angle);
    const float far = std::sqrt(x * x + z * z) / reach;
    const float r = reach * dice.between(0.1f, 0.22f) * (1.15f - 0.35f * far);
    const float rise = reach * (0.05f * far + 0.02f * dice.next());
    puffs.push_back({top + Vec3f(x, rise, z), r, std::max(0.66f - 0.3f * far, 0.24f)});
  }
}

} // namespace

void grow(std::vector<Puff>& puffs, int levels, float smallest, Dice& dice) {
  std::size_t first = 0;
  for (int level = 0; level < levels; ++level) {
    const std::size_t last = puffs.size();
    for (std::size_t parent = first; parent < last; ++parent)
      for (int child = 0; child < 7; ++child) {
        const Puff from = puffs[parent];
        const float radius = from.radius * dice.between(0.34f, 0.56f);
        const Vec3f way = mostly_up(dice);
        const float out = from.radius * dice.between(0.78f, 0.98f);
        if (radius >= smallest && from.flatness == 1)
          puffs.push_back({from.centre + way * out, radius});
      }
    first = last;
  }
}

CloudForm cumulus_form(const Vec3f& middle, float width, float tallness, float smallest,
                       Dice& dice) {
  CloudForm form;
  const float lean = dice.between(-0.12f, 0.12f);
  const int towers = 4 + static_cast<int>(3 * dice.next());
  for (int i = 0; i < towers; ++i) {
    // The first tower stands in the middle and is the highest.
    const float angle = turn * dice.next();
    const float away = i == 0 ? 0.08f * dice.next() : dice.between(0.14f, 0.34f);
    const float height = tallness * width * (0.62f - 1.1f * away) * dice.between(0.75f, 1.1f);
    const float radius = width * dice.between(0.1f, 0.15f) * (1.25f - 1.2f * away);
    const int count = std::max(static_cast<int>(2.2f * height / radius), 2);
    for (int j = 0; j < count; ++j) {
      const float t = static_cast<float>(j) / static_cast<float>(count - 1);
      const float side = turn * dice.next(), out = 0.5f * radius * dice.next();
      form.puffs.push_back(
          {middle + Vec3f(width * 1.2f * away * std::cos(angle) + out * std::cos(side) +
                              lean * height * t,
                          0.2f * radius + t * (height - 0.8f * radius),
                          width * 0.9f * away * std::sin(angle) + out * std::sin(side)),
           radius * (1.1f - 0.35f * t) * dice.between(0.75f, 1.1f)});
    }
  }
  grow(form.puffs, 3, smallest, dice);
  form.base = middle.y();
  form.detail = 0.11f * width;
  form.crisp = 0.006f * width;
  form.wispy = 0.05f * width;
  form.fraying = 1e30f;
  return form;
}

CloudForm storm_form(float extent, float smallest, Dice& dice) {
  CloudForm form;
  const float height = 0.62f * extent;
  const Vec3f foot(-0.06f * extent, 0, 0);
  add_tower(form.puffs, foot, height, 0.115f * extent, dice);
  add_tower(form.puffs, foot + Vec3f(0.1f * extent, 0, 0.05f * extent), 0.8f * height,
            0.088f * extent, dice);
  add_tower(form.puffs, foot + Vec3f(0.02f * extent, 0, 0.13f * extent), 0.56f * height,
            0.075f * extent, dice);
  // The flanking line: ever lower and younger towers.
  for (int i = 1; i < 10; ++i) {
    const float share = (0.62f - 0.055f * static_cast<float>(i)) * dice.between(0.75f, 1.2f);
    const Vec3f side(-0.042f * extent * static_cast<float>(i) + 0.04f * extent * dice.next(), 0,
                     extent * dice.between(-0.1f, 0.16f));
    add_tower(form.puffs, foot + side, share * height,
              0.068f * extent * (1 - 0.045f * static_cast<float>(i)), dice);
  }
  for (int i = 0; i < 9; ++i) {
    const Vec3f side(extent * dice.between(-0.3f, 0.28f), 0, extent * dice.between(-0.2f, 0.2f));
    add_tower(form.puffs, foot + side, height * dice.between(0.1f, 0.24f),
              0.06f * extent * dice.between(0.7f, 1.1f), dice);
  }
  form.tower = foot + Vec3f(0.1f * height, 0, 0);
  form.tower_radius = 0.135f * extent;
  add_anvil(form.puffs, form.tower + Vec3f(0, 0.9f * height, 0), 0.44f * extent, dice);
  grow(form.puffs, 3, smallest, dice);
  form.detail = 0.04f * extent;
  form.crisp = 0.003f * extent;
  form.wispy = 0.02f * extent;
  form.fraying = 0.84f * height;
  return form;
}

} // namespace vdbeam
