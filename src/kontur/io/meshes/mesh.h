// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kontur/shape/mesh.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// Writes a mesh in the format of the path's extension, whole or not at all. Coordinates are mm in LPS and the file says so
/// (`SPACE=LPS` in the STL header or a comment, as 3D Slicer reads it):
/// - .stl: binary; 32-bit coordinates, facet normals computed from the triangles, points repeated per triangle;
/// - .ply: binary little endian; 64-bit coordinates, point normals if the mesh has them;
/// - .obj: text with six decimals, point normals if the mesh has them.
/// Throws Error(unsupported) for another extension; Error(invalid_input) for a coordinate that is NaN, infinite or beyond
/// the format's range, an index without a point or a wrong number of normals; Error(too_large) for more than 2^32 - 1
/// triangles in an STL file; Error(io) naming file and reason.
/// `provenance` goes into comments of PLY and OBJ and, shortened to the digits of the contours' digest, into STL's header.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const Provenance& provenance = {});

/// A number for each point of a mesh.
struct PointValues {
    std::string name;  ///< a word of letters, digits and underscores
    std::vector<double> values;
};

/// A .ply whose points have one more property, a float of that name. Throws as write_mesh does, and Error(invalid_input) for
/// other than one value for each point.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const PointValues& values,
                const Provenance& provenance = {});

/// Reads STL and PLY (text and binary; PLY of both byte orders) or OBJ, recognised by the path's extension. A file that
/// declares `SPACE=RAS` is turned to LPS; one that declares nothing is taken as LPS mm. STL points with identical
/// coordinates, as 32-bit floats, become one, and triangles that collapse by that are dropped; polygons of PLY and OBJ are
/// cut into fans. OBJ normals are kept where every point has exactly one. Throws Error(corrupt_file), before any
/// allocation by a declared count, for a file that holds less or other than it declares; Error(unsupported) for another
/// extension; Error(too_large) for more than 2^32 - 1 points; Error(io).
TriangleMesh read_mesh(const std::filesystem::path& path);

}  // namespace kontur
