// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// A line through points in mm (LPS). A closed one's last point is joined to its first, which it does not repeat.
struct Polyline {
    std::vector<Vec3> points;
    bool closed = false;
};

/// The mesh's surface cut by a plane: closed lines where the mesh is closed, open ones where they end at its border.
/// A point of the mesh that lies on the plane counts as lying on the normal's side, so a closed mesh always gives closed
/// lines; a plane that only touches the mesh gives none. Order and direction of the lines are not specified, but the same
/// for the same mesh. Linear in the number of triangles. Throws Error(invalid_input) as check_mesh does.
std::vector<Polyline> outline(const TriangleMesh& mesh, const Plane& plane);

/// Points in mm where a contour's line crosses the plane.
std::vector<Vec3> crossings(const Contour& contour, const Plane& plane);

}  // namespace kontur
