#pragma once

#include "geometry/mesh.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Gives a mesh the normals of its file, one for each position and of any length, as unit vectors.
/// They are zero at corners where the file's is not finite or has no length, and the triangle's own
/// where it points to the back of a triangle whose other normals point to its front. Where all
/// three point to the back they are turned round: the order of the vertices says what the front is.
/// The mesh's notes report the first and the last case, in lines that open with `label`.
void take_normals(const std::vector<Vec3f>& normals, const std::string& label, Mesh& mesh);

/// Gives corners without a normal that of `smooth_normals`, or with 0 degrees that of the triangle.
/// Leaves out all normals where every triangle stays flat.
void complete_normals(Mesh& mesh, double degrees);

} // namespace vdbeam
