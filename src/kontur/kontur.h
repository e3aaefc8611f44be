// SPDX-License-Identifier: Apache-2.0
#pragma once

// The public interface, in the order of the flow. The stages of `segment` have a header of their own, stages.h.

// What goes in and comes out.
#include "kontur/base/error.h"
#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/structure_attributes.h"
#include "kontur/shape/volume.h"

// Files to shapes and back.
#include "kontur/io/bytes/png.h"
#include "kontur/io/contours.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/meshes/region_mesh.h"
#include "kontur/io/read_provenance.h"

// Is the drawing sound?
#include "kontur/measure/contour_check.h"

// Contours to a mask, a surface and a function: of one structure, of several, of a mask to be corrected, of a label map with
// gaps, while they are edited.
#include "kontur/correct/suggest_to_look_at.h"
#include "kontur/correct_mask.h"
#include "kontur/editor.h"
#include "kontur/fill_labels.h"
#include "kontur/live_editor.h"
#include "kontur/segment.h"
#include "kontur/segment_moving.h"
#include "kontur/segment_options.h"
#include "kontur/segment_report.h"
#include "kontur/segment_together.h"

// Structures that follow others by rules.
#include "kontur/derive/derive.h"

// How sure the surface is, and where to draw next.
#include "kontur/suggest.h"

// The result beside another one, as contours, and as pictures.
#include "kontur/extract/trace.h"
#include "kontur/measure/compare.h"
#include "kontur/measure/differences.h"
#include "kontur/view/outline.h"
#include "kontur/view/picture.h"
#include "kontur/view/reslice.h"

// Bodies with exact truth.
#include "kontur/phantom/bodies.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/phantom.h"
