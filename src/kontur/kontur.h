// SPDX-License-Identifier: Apache-2.0
#pragma once

// Everything public, in the order of the flow.

// What all stages share.
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/geometry.h"
#include "kontur/base/parallel.h"
#include "kontur/base/printable.h"
#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/shape/sha256.h"

// What goes in and comes out.
#include "kontur/shape/box_tree.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/predicates.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/repeated_contours.h"
#include "kontur/shape/rgb_image.h"
#include "kontur/shape/section.h"
#include "kontur/shape/self_contacts.h"
#include "kontur/shape/spline.h"
#include "kontur/shape/structure_attributes.h"
#include "kontur/shape/volume.h"

// Files to shapes.
#include "kontur/io/contours.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/contours/markups.h"
#include "kontur/io/dicom/dicom_identity.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/file_digest.h"
#include "kontur/io/image.h"
#include "kontur/io/read_provenance.h"

// What the contours say.
#include "kontur/drawing/corners.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/drawing/reduce.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/fit/prepare.h"

// The function: sums of a kernel.
#include "kontur/function/fast_function.h"
#include "kontur/function/implicit_function.h"
#include "kontur/function/kernel.h"

// Contours become a function.
#include "kontur/fit/fit.h"
#include "kontur/fit/residual.h"
#include "kontur/solve/constraint_set.h"
#include "kontur/solve/solve.h"

// The image between the contours.
#include "kontur/image/follow_image.h"

// The function becomes voxels or triangles; a mask becomes contours.
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/rasterize.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/extract/surface_band.h"
#include "kontur/extract/trace.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"

// How sure the surface is, and where to draw next.
#include "kontur/sampling/drawn_lines.h"
#include "kontur/sampling/surface_samples.h"
#include "kontur/sureness/candidate_planes.h"
#include "kontur/sureness/expected_dice.h"
#include "kontur/sureness/suggest_plane.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "kontur/sureness/uncertainty_map.h"

// All of it at once.
#include "kontur/editor.h"
#include "kontur/fill_labels.h"
#include "kontur/live_editor.h"
#include "kontur/report.h"
#include "kontur/segment.h"
#include "kontur/segment_options.h"
#include "kontur/segment_report.h"
#include "kontur/segment_together.h"

// Judging and showing the result.
#include "kontur/measure/compare.h"
#include "kontur/measure/components.h"
#include "kontur/measure/contour_check.h"
#include "kontur/view/livewire.h"
#include "kontur/view/outline.h"
#include "kontur/view/picture.h"
#include "kontur/view/reslice.h"

// Shapes to files.
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/png.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/meshes/region_mesh.h"

// Bodies with exact truth.
#include "kontur/phantom/bodies.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/phantom.h"
