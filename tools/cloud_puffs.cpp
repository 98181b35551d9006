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

/// A leaning stack of balls from the base to `height`, narrowest at half height.
void add_tower(std::vector<Puff>& puffs, const Vec3f& foot, float height, float radius,
               Dice& dice) {
  const int count = std::max(static_cast<int>(1.6f * height / radius), 2);
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const float angle = turn * dice.next(), away = 0.35f * radius * dice.next();
    const float r = radius * (1.1f - 0.45f * std::sin(0.5f * turn * t)) * dice.between(0.85f, 1.1f);
    puffs.push_back(
        {foot + Vec3f(away * std::cos(angle) + 0.12f * height * t * t,
                      0.6f * radius + t * (height - 1.4f * radius), away * std::sin(angle)),
         r});
  }
}

/// A thin, wide shelf of flat balls around the top of the tower, longest along x.
void add_anvil(std::vector<Puff>& puffs, const Vec3f& top, float reach, Dice& dice) {
  for (int i = 0; i < 170; ++i) {
    const float angle = turn * dice.next(), away = std::sqrt(dice.next());
    const float x = reach * (0.3f + away * std::cos(angle)),
                z = 0.62f * reach * away * std::sin(angle);
    const float r = reach * dice.between(0.16f, 0.3f) * (1.2f - 0.6f * away);
    const float rise = 0.05f * reach * (away - 0.6f) + 0.03f * reach * dice.next();
    puffs.push_back({top + Vec3f(x, rise, z), r, 0.62f - 0.42f * away});
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

CloudForm cumulus_form(const Vec3f& middle, float width, float smallest, Dice& dice) {
  CloudForm form;
  for (int i = 0; i < 16; ++i) {
    const float angle = turn * dice.next(), away = 0.36f * std::sqrt(dice.next());
    const float dome = 1 - away / 0.5f;
    const float radius = width * dice.between(0.09f, 0.15f) * (0.6f + 0.7f * dome);
    const float rise = width * (0.05f + 0.4f * dome * dice.next());
    form.puffs.push_back({middle + Vec3f(width * 1.15f * away * std::cos(angle), rise,
                                         width * 0.9f * away * std::sin(angle)),
                          radius});
  }
  grow(form.puffs, 4, smallest, dice);
  form.base = middle.y();
  form.detail = 0.05f * width;
  form.crisp = 0.012f * width;
  form.wispy = 0.06f * width;
  form.fraying = 1e30f;
  return form;
}

CloudForm storm_form(float extent, float smallest, Dice& dice) {
  CloudForm form;
  const float height = 0.72f * extent;
  const Vec3f foot(-0.12f * extent, 0, 0);
  add_tower(form.puffs, foot, height, 0.14f * extent, dice);
  add_tower(form.puffs, foot + Vec3f(0.1f * extent, 0, 0.06f * extent), 0.8f * height,
            0.11f * extent, dice);
  for (int i = 1; i < 7; ++i) {
    const float share = 0.66f - 0.085f * static_cast<float>(i);
    const Vec3f side(-0.055f * extent * static_cast<float>(i) + 0.05f * extent * dice.next(), 0,
                     extent * dice.between(-0.12f, 0.12f));
    add_tower(form.puffs, foot + side, share * height,
              0.085f * extent * (1 - 0.06f * static_cast<float>(i)), dice);
  }
  add_anvil(form.puffs, foot + Vec3f(0.1f * extent, 0.95f * height, 0), 0.42f * extent, dice);
  grow(form.puffs, 4, smallest, dice);
  form.detail = 0.03f * extent;
  form.crisp = 0.007f * extent;
  form.wispy = 0.026f * extent;
  form.fraying = 0.84f * height;
  return form;
}

} // namespace vdbeam
