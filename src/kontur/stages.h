// SPDX-License-Identifier: Apache-2.0
#pragma once

// The stages of `segment`, each to be called by itself, and the tools beside them. UNSTABLE: names, options and results of
// these follow the method and change with it in any version; kontur.h does not.

// What the lines say.
#include "kontur/drawing/corners.h"
#include "kontur/drawing/drawing.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/drawing/reduce.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/self_intersections.h"

// Lines become a function.
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/fit/residual.h"
#include "kontur/fit/sides.h"
#include "kontur/function/fast_function.h"
#include "kontur/image/follow_image.h"
#include "kontur/solve/constraint_set.h"
#include "kontur/solve/solve.h"

// The function becomes voxels, triangles or lines.
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/rasterize.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/extract/surface_band.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"

// Lines along the edges of an image, and curves through points.
#include "kontur/shape/spline.h"
#include "kontur/view/livewire.h"

// Contours and scans of the phantom for measuring, beside its cases.
#include "kontur/phantom/dense_liver.h"
#include "kontur/phantom/volumes.h"

// The result against its own drawing.
#include "kontur/drawing_check.h"
