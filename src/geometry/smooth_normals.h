#pragma once

#include "geometry/mesh.h"

namespace vdbeam {

/// The normals of a curved surface that the triangles stand for: at each corner the mean, weighted
/// by their angles there, of the normals of those triangles around that point which differ from
/// the corner's own by `degrees` at most (Thuermer and Wuethrich, Computing Vertex Normals from
/// Polygonal Facets, 1998). Unit vectors.
std::vector<CornerNormals> smooth_normals(const Mesh& mesh, double degrees);

} // namespace vdbeam
