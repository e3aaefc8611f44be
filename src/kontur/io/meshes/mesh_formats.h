// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/geometry/patient_frame.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/meshes/region_mesh.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/provenance.h"

// One writer and one parser per mesh format; internal to `read_mesh` and `write_mesh`, which check the mesh and add the
// file's name to errors. Parsers take the whole file.
namespace kontur {

/// What a .ply holds beside points, normals and triangles; null: nothing.
struct PlyExtras {
    const PointValues* values = nullptr;
    const MeshRegions* regions = nullptr;
};

void write_stl(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance);
void write_ply(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance);
void write_ply(AtomicFile& file, const TriangleMesh& mesh, const PlyExtras& extras, const Provenance& provenance);
void write_obj(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance);
void write_vtk(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance);
void write_vtp(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance);

TriangleMesh parse_stl(std::string_view bytes);
TriangleMesh parse_ply(std::string_view bytes);
TriangleMesh parse_obj(std::string_view bytes);
TriangleMesh parse_vtk_mesh(std::string_view bytes);
TriangleMesh parse_vtp_mesh(std::string_view bytes);

/// The frame that a header or comment declares by SPACE=LPS or SPACE=RAS; `otherwise` when it declares none.
PatientFrame declared_frame(std::string_view text, PatientFrame otherwise);

/// A triangle fan over a polygon's corners.
void append_polygon(TriangleMesh& mesh, const std::vector<std::uint32_t>& corners);

/// Cuts the next word (up to blanks) off `text`; empty at the end.
std::string_view take_word(std::string_view& text);
/// Cuts the next line (without LF or CRLF) off `text`.
std::string_view take_line(std::string_view& text);
/// A whole word as a number; throws Error(corrupt_file) naming the word.
double number_of(std::string_view word);
std::int64_t integer_of(std::string_view word);

}  // namespace kontur
