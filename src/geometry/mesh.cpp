#include "geometry/mesh.h"

#include "geometry/corner_normals.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

/// A coordinate that single precision can square.
bool usable(const Vec3d& p) {
  constexpr double largest = 1e15;
  return std::abs(p.x) < largest && std::abs(p.y) < largest && std::abs(p.z) < largest;
}

/// Dropped triangles by what is wrong with them.
struct Dropped {
  std::size_t indices = 0, values = 0, degenerate = 0;

  std::string text() const {
    std::string list;
    const auto add = [&list](std::size_t count, const char* what) {
      if (count > 0)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, what);
    };
    add(indices, "with wrong indices");
    add(values, "with vertices that are not finite");
    add(degenerate, "without area");
    return list;
  }
};

bool has_area(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3d normal = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
  return dot(normal, normal) > 0;
}

} // namespace

Mesh repair_mesh(const RawMesh& raw, const std::string& label) {
  Mesh mesh;
  Dropped dropped;
  std::vector<std::array<std::uint32_t, 3>> sound;
  Boxd bounds;
  for (const auto& triangle : raw.triangles) {
    bool inside = true, finite = true;
    for (const std::uint32_t index : triangle)
      inside = inside && index < raw.positions.size();
    for (int i = 0; inside && i < 3; ++i)
      finite = finite && usable(raw.positions[triangle[i]]);
    dropped.indices += !inside;
    dropped.values += inside && !finite;
    if (!inside || !finite)
      continue;
    sound.push_back(triangle);
    for (const std::uint32_t index : triangle)
      bounds.extend(raw.positions[index]);
  }
  if (!sound.empty())
    mesh.center = bounds.center();
  mesh.positions.reserve(raw.positions.size());
  for (const Vec3d& p : raw.positions)
    mesh.positions.push_back(usable(p) ? Vec3f(p - mesh.center) : Vec3f());
  mesh.uvs = raw.uvs;
  mesh.triangles.reserve(sound.size());
  for (const auto& t : sound) {
    if (has_area(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]))
      mesh.triangles.push_back(t);
    else
      ++dropped.degenerate;
  }
  if (const std::string text = dropped.text(); !text.empty())
    mesh.notes.push_back(fmt::format("{}: triangles left out: {}", label, text));
  if (mesh.triangles.empty())
    throw FrameError(label + ": holds no triangle that can be used");
  if (!raw.normals.empty())
    take_normals(raw.normals, label, mesh);
  return mesh;
}

} // namespace vdbeam
