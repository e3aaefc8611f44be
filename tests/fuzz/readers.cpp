// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fuzz/scratch_folder.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/csv.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/read_provenance.h"
#include "kontur/measure/contour_check.h"

namespace kontur::fuzz {
namespace {

constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 22;

/// Whatever was read must keep what the types promise.
void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

/// What a file says of itself goes on into others.
void provenance(const std::filesystem::path& path) {
    for (const auto& [name, value] : read_provenance(path))
        require(printable_utf8(name + value) == name + value, "provenance can be written again");
}

/// Takes every choice that a careful user would be asked for, so that more of the readers is reached.
void image(const std::string& name, Bytes bytes) {
    ReadImageOptions options;
    options.frame = 1;
    options.prefer = NiftiTransform::sform;
    options.allow_missing_geometry = true;
    options.max_voxels = options.dicom.max_voxels = kMaxVoxels;
    const auto path = scratch().file(name, bytes);
    const Image image = read_image(path, options);
    check_grid(image.grid);
    require(std::visit([](const auto& v) { return static_cast<std::int64_t>(v.size()); }, image.samples) ==
                image.grid.voxel_count(),
            "as many samples as voxels");
    provenance(path);
}

void check(const ContourSet& contours) {
    // Findings compare contours pairwise: of thousands of them, only so many are of use here.
    if (contours.contours.size() <= 50) check_contour_set(contours);
}

void contours(const std::string& name, Bytes bytes) {
    const auto path = scratch().file(name, bytes);
    check(read_contours(path).contours);
    provenance(path);
}

void mesh(const std::string& name, Bytes bytes) {
    const auto path = scratch().file(name, bytes);
    const TriangleMesh mesh = read_mesh(path);
    for (const Vec3& p : mesh.points) require(is_finite(p), "points are finite");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) require(corner < mesh.points.size(), "triangles have corners");
    provenance(path);
}

/// The same file may hold contours and a surface.
void polydata(const std::string& name, Bytes bytes) {
    try {
        contours(name, bytes);
    } catch (const Error&) {
        // a surface, perhaps
    }
    mesh(name, bytes);
}

}  // namespace

void nifti(Bytes bytes) { image(!bytes.empty() && bytes[0] == 0x1f ? "x.nii.gz" : "x.nii", bytes); }
void nrrd(Bytes bytes) { image("x.nrrd", bytes); }
void metaimage(Bytes bytes) { image("x.mha", bytes); }
/// The first bytes are the header's file, the others that of the voxels.
void nifti_pair(Bytes bytes) {
    constexpr std::size_t kHeaderBytes = 352;
    const std::size_t head = std::min(bytes.size(), kHeaderBytes);
    scratch().file("x.img", bytes.subspan(head));
    image("x.hdr", bytes.first(head));
}
void mgh(Bytes bytes) { image(!bytes.empty() && bytes[0] == 0x1f ? "x.mgz" : "x.mgh", bytes); }
void gipl(Bytes bytes) { image("x.gipl", bytes); }
void dicom(Bytes bytes) { image("x.dcm", bytes); }
void dicom_seg(Bytes bytes) {
    const auto path = scratch().file("x.dcm", bytes);
    const DicomSegmentation found = read_dicom_segmentation(path, kMaxVoxels);
    for (const DicomSegment& segment : found.segments) read_dicom_seg(path, segment.number, kMaxVoxels);
    require(read_dicom_seg_masks(path, kMaxVoxels).size() == found.segments.size(), "a mask for each segment");
    provenance(path);
}
void rtstruct(Bytes bytes) {
    const auto path = scratch().file("x.dcm", bytes);
    for (const Roi& roi : read_rtstruct(path).rois) check(roi.contours);
    provenance(path);
}
void contour_json(Bytes bytes) { contours("x.json", bytes); }
void markups(Bytes bytes) { contours("x.mrk.json", bytes); }
void stl(Bytes bytes) { mesh("x.stl", bytes); }
void ply(Bytes bytes) { mesh("x.ply", bytes); }
void obj(Bytes bytes) { mesh("x.obj", bytes); }
void vtk(Bytes bytes) { polydata("x.vtk", bytes); }
void vtp(Bytes bytes) { polydata("x.vtp", bytes); }
void csv(Bytes bytes) {
    const app::CsvTable table = app::read_csv(scratch().file("x.csv", bytes));
    for (const auto& row : table.rows) require(row.size() == table.columns.size(), "each row has each column");
}

}  // namespace kontur::fuzz
