#include "lights/entry_sampler.h"

#include "math/sampling.h"

namespace vdbeam {
namespace {

// Where the infinite line p + t d runs inside the box of the given duals; false where it misses.
bool pierce(const Vec3f& corner, const std::array<Vec3f, 3>& duals, const Vec3f& p, const Vec3f& d,
            float& t_enter) {
  float enter = -infinity, leave = infinity;
  for (const Vec3f& dual : duals) {
    const float x = dot(dual, p - corner), slope = dot(dual, d);
    if (slope == 0) {
      if (x < 0 || x > 1)
        return false;
      continue;
    }
    const float a = -x / slope, b = (1 - x) / slope;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  t_enter = enter;
  return enter < leave;
}

} // namespace

EntrySampler::EntrySampler(const std::vector<Parallelepiped>& boxes) {
  for (const Parallelepiped& box : boxes) {
    const float volume = dot(box.edges[0], cross(box.edges[1], box.edges[2]));
    if (!(std::abs(volume) > 0))
      continue;
    Box result{box.corner, box.edges, {}, {}};
    for (int i = 0; i < 3; ++i) {
      const Vec3f normal = cross(box.edges[(i + 1) % 3], box.edges[(i + 2) % 3]);
      result.duals[i] = normal / volume;
      result.faces[i] = {volume > 0 ? normal : -normal, i};
      surface_area_ += 2 * length(normal);
    }
    boxes_.push_back(result);
  }
}

float EntrySampler::projected_area(const Vec3f& direction) const {
  float sum = 0;
  for (const Box& box : boxes_)
    for (const Face& face : box.faces)
      sum += std::abs(dot(face.area, direction));
  return sum;
}

Vec3f EntrySampler::face_point(const Box& box, int axis, bool far_side, float u, float v) const {
  const Vec3f base = far_side ? box.corner + box.edges[axis] : box.corner;
  return base + box.edges[(axis + 1) % 3] * u + box.edges[(axis + 2) % 3] * v;
}

EntrySampler::Entry EntrySampler::first_entry(std::size_t chosen, const Vec3f& point,
                                              const Vec3f& direction, float measure) const {
  int pierced = 1; // the chosen box, whatever rounding makes of a grazing line
  float first = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    float t = 0;
    if (i == chosen || !pierce(boxes_[i].corner, boxes_[i].duals, point, direction, t))
      continue;
    ++pierced;
    first = std::min(first, t);
  }
  return {point + direction * first, direction, measure / static_cast<float>(pierced)};
}

EntrySampler::Entry EntrySampler::sample_line(const Vec3f& direction, float u_face, float u,
                                              float v) const {
  const float total = projected_area(direction);
  float left = u_face * total;
  std::size_t chosen = boxes_.size();
  int axis = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const float area = std::abs(dot(boxes_[i].faces[k].area, direction));
      if (left < 0 || area <= 0)
        continue;
      chosen = i, axis = k; // the last face of any size takes what rounding leaves over
      left -= area;
    }
  if (chosen == boxes_.size())
    return {{}, direction, 0};
  const Box& box = boxes_[chosen];
  const bool far_side = dot(box.faces[axis].area, direction) < 0;
  return first_entry(chosen, face_point(box, axis, far_side, u, v), direction, total);
}

EntrySampler::Entry EntrySampler::sample_surface(float u_face, float u, float v, float u_direction,
                                                 float v_direction) const {
  float left = u_face * surface_area_;
  std::size_t chosen = boxes_.size();
  int axis = 0;
  bool far_side = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (int k = 0; k < 6; ++k) {
      const float area = length(boxes_[i].faces[k / 2].area);
      if (left < 0 || area <= 0)
        continue;
      chosen = i, axis = k / 2, far_side = k % 2 == 1;
      left -= area;
    }
  if (chosen == boxes_.size())
    return {{}, {0, 0, 1}, 0};
  const Box& box = boxes_[chosen];
  const Vec3f outward = normalize(box.faces[axis].area);
  const Vec3f inward = far_side ? -outward : outward;
  // Cosine-weighted: density cos / pi cancels the cosine of the projected area.
  const Vec3f direction = direction_about(inward, std::sqrt(1 - u_direction), 2 * pi * v_direction);
  return first_entry(chosen, face_point(box, axis, far_side, u, v), direction, pi * surface_area_);
}

} // namespace vdbeam
