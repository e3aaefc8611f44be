// SPDX-License-Identifier: Apache-2.0
// What no public function takes: each option and argument outside of its range is refused with Error(invalid_input), whose
// sentence names it, before anything is computed from it.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kontur/drawing/reconcile.h"
#include "kontur/drawing/tidy.h"
#include "kontur/extract/isolines.h"
#include "kontur/io/contours/markups.h"
#include "kontur/kontur.h"
#include "kontur/measure/components.h"
#include "kontur/phantom/dense_liver.h"
#include "kontur/stages.h"
#include "kontur/view/shade.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Row {
    std::string what;
    std::function<void()> call;
    std::string part;  ///< of the sentence
};

void expect_refused(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        SCOPED_TRACE(row.what);
        EXPECT_KONTUR_ERROR(row.call(), ErrorKind::invalid_input, row.part);
    }
}

template <class Field>
struct Given {
    using Type = Field;
};
template <class Field>
struct Given<std::optional<Field>> {
    using Type = Field;
};

/// One row for each value that a field must not have.
template <class Options, class Field>
void add(std::vector<Row>& rows, const std::string& what, Field Options::*field,
         const std::vector<typename Given<Field>::Type>& values, const std::function<void(const Options&)>& call,
         const std::string& part) {
    for (const auto value : values) {
        Options options;
        options.*field = value;
        rows.push_back({what + " = " + std::to_string(value), [=] { call(options); }, part});
    }
}

const std::vector<double> kNotAbove0{0, -1, kNan, kInfinite}, kBelow0{-1, kNan, kInfinite};

const ContourSet& contours() {
    static const ContourSet set = test::three_circles();
    return set;
}

const PreparedContours& prepared() {
    static const PreparedContours points = prepare(contours());
    return points;
}

Grid grid() { return grid_around(bounding_box(contours()), {2, 2, 2}, 4); }

const Segmentation& segmentation() {
    static const Segmentation made = segment(contours(), grid(), {.mesh = true});
    return made;
}

Mask short_mask() {
    Mask mask = segmentation().mask;
    mask.values.pop_back();
    return mask;
}

Image short_image() { return {grid(), std::vector<float>(5)}; }

TriangleMesh broken_mesh() {
    TriangleMesh mesh = *segmentation().mesh;
    mesh.triangles.front()[1] = static_cast<std::uint32_t>(mesh.points.size());
    return mesh;
}

TEST(Preconditions, OfPreparingContours) {
    std::vector<Row> rows;
    const std::function<void(const PrepareOptions&)> call = [](const PrepareOptions& o) { prepare(contours(), o); };
    add<PrepareOptions>(rows, "quality", &PrepareOptions::quality, {0, -1, 1.01, kNan}, call, "quality");
    add<PrepareOptions>(rows, "least_segments", &PrepareOptions::least_segments, {-1}, call, "segments is -1");
    add<PrepareOptions>(rows, "copy_shift_mm", &PrepareOptions::copy_shift_mm, kBelow0, call, "copy");
    add<PrepareOptions>(rows, "click_margin_mm", &PrepareOptions::click_margin_mm, kNotAbove0, call, "margin");
    add<PrepareOptions>(rows, "corner_spacing_mm", &PrepareOptions::corner_spacing_mm, kNotAbove0, call, "corners");
    rows.push_back({"threads", [] { prepare(contours(), {}, {.threads = -1}); }, "threads is -1"});

    const Contour& contour = contours().contours.front();
    const std::function<void(const ReduceOptions&)> reducing = [&](const ReduceOptions& o) { reduce(contour, o); };
    add<ReduceOptions>(rows, "reduce", &ReduceOptions::quality, {0, -1, 2, kNan}, reducing, "quality");
    add<ReduceOptions>(rows, "min_points", &ReduceOptions::min_points, {0, 1}, reducing, "points");
    rows.push_back({"subdivide", [&] { subdivide(contour, -1); }, "segments"});
    for (const double length : kNotAbove0) {
        const std::vector<bool> flags(contour.points.size());
        rows.push_back({"nearest", [=] { subdivide_to_corners(contours().contours[0], flags, length, 1); }, "corners"});
        rows.push_back({"longest", [=] { subdivide_to_corners(contours().contours[0], flags, 1, length); }, "corners"});
    }
    rows.push_back({"flags", [&] { subdivide_to_corners(contour, {true}, 0.1, 1); }, "flags"});
    rows.push_back({"orient", [] { orient(Contour{}); }, "points of the contour is 0"});

    const std::function<void(const TidyOptions&)> tidying = [](const TidyOptions& o) {
        ContourSet set = contours();
        tidy(set, o);
    };
    add<TidyOptions>(rows, "spike", &TidyOptions::spike_tolerance_mm, kBelow0, tidying, "spikes");
    add<TidyOptions>(rows, "thin", &TidyOptions::thin_tolerance_mm, kBelow0, tidying, "thinning");

    const std::function<void(const ReconcileOptions&)> reconciling = [](const ReconcileOptions& o) {
        std::vector<BoundaryPoint> points = prepared().points;
        reconcile(points, {}, 40, o);
    };
    add<ReconcileOptions>(rows, "offset", &ReconcileOptions::offset_mm, kNotAbove0, reconciling, "offset");
    add<ReconcileOptions>(rows, "strength", &ReconcileOptions::strength, kBelow0, reconciling, "strength");
    add<ReconcileOptions>(rows, "reach", &ReconcileOptions::reach, kNotAbove0, reconciling, "reach");

    const std::function<void(const ContourCheckOptions&)> checking = [](const ContourCheckOptions& o) {
        check_contours(contours(), o);
    };
    add<ContourCheckOptions>(rows, "plane", &ContourCheckOptions::plane_tolerance_mm, kBelow0, checking, "tolerance");
    add<ContourCheckOptions>(rows, "line", &ContourCheckOptions::line_tolerance_mm, kBelow0, checking, "tolerance");
    for (const double value : kBelow0)
        rows.push_back(
            {"disagreement", [=] { check_contour_set(contours(), {.limits = {}, .disagreement_mm = value}); }, "disagree"});
    expect_refused(rows);
}

TEST(Preconditions, OfPlacingConstraints) {
    std::vector<Row> rows;
    const std::vector<BoundaryPoint>& points = prepared().points;
    const std::vector<double> slopes(points.size(), 1.0);
    const std::function<void(const PlaceOptions&)> call = [&](const PlaceOptions& o) {
        place_constraints(points, slopes, {}, o);
    };
    add<PlaceOptions>(rows, "normal_offset_mm", &PlaceOptions::normal_offset_mm, kNotAbove0, call, "normal offset");
    add<PlaceOptions>(rows, "merge_distance_mm", &PlaceOptions::merge_distance_mm, kBelow0, call, "merge distance");
    for (const double value : {0.0, -0.5, 1.5, kNan}) {
        std::vector<double> odd = slopes;
        odd[3] = value;
        rows.push_back({"slope", [=, &points] { place_constraints(points, odd, {}); }, "slope 4"});
    }
    rows.push_back({"no slopes", [&] { place_constraints(points, {}, {}); }, "0 slopes for"});

    const auto with_point = [&](const std::function<void(BoundaryPoint&)>& spoil, const std::string& part) {
        std::vector<BoundaryPoint> spoilt = points;
        spoil(spoilt[1]);
        rows.push_back({"point", [=] { place_constraints(spoilt, slopes, {}); }, part});
    };
    with_point([](BoundaryPoint& p) { p.position.y = kNan; }, "point 2 is not finite");
    with_point([](BoundaryPoint& p) { p.inplane_normal.z = kInfinite; }, "point 2 is not finite");
    with_point([](BoundaryPoint& p) { p.gap_mm = 0; }, "gap of point 2");
    with_point([](BoundaryPoint& p) { p.gap_mm = kNan; }, "gap of point 2");
    with_point([](BoundaryPoint& p) { p.trust = 0; }, "trust in point 2");
    with_point([](BoundaryPoint& p) { p.trust = kNan; }, "trust in point 2");
    const auto with_single = [&](const PointConstraint& single) {
        rows.push_back({"single", [=] { place_constraints({}, {}, std::vector{single}); }, "single point 1"});
    };
    with_single({{kNan, 0, 0}, 1});
    with_single({{0, 0, 0}, kInfinite});
    with_single({{0, 0, 0}, 1, -1});
    expect_refused(rows);
}

TEST(Preconditions, OfFitting) {
    std::vector<Row> rows;
    const std::function<void(const FitOptions&)> call = [](const FitOptions& o) { fit(prepared(), o); };
    add<FitOptions>(rows, "rounds", &FitOptions::rounds, {-1}, call, "rounds is -1");
    add<FitOptions>(rows, "most_solves", &FitOptions::most_solves, {0, -1}, call, "solves with all points is");
    add<FitOptions>(rows, "bounds", &FitOptions::bounds_tolerance_mm, kBelow0, call, "the bounds' tolerance");
    add<FitOptions>(rows, "start_smoothing", &FitOptions::start_smoothing, kBelow0, call, "smoothing");
    add<FitOptions>(rows, "smoothing_factor", &FitOptions::smoothing_factor, kBelow0, call, "factor");
    add<FitOptions>(rows, "least_slope", &FitOptions::least_slope, {0, -0.1, 1.1, kNan}, call, "least slope");
    add<FitOptions>(rows, "early", &FitOptions::early_tolerance_factor, kNotAbove0, call, "early");
    add<FitOptions>(rows, "tilt_points", &FitOptions::tilt_points, {0}, call, "0 points");
    for (const std::vector<double>& slopes :
         {std::vector<double>(3, 1.0), std::vector<double>(prepared().points.size(), kNan),
          std::vector<double>(prepared().points.size(), 0.0), std::vector<double>(prepared().points.size() + 1, 1.0)}) {
        FitOptions options;
        options.start_slopes = slopes;
        rows.push_back({"start_slopes", [=] { call(options); }, "slope"});
    }
    for (const double value : kNotAbove0) {
        FitOptions options;
        options.normal_offset_mm = value;
        rows.push_back({"offset", [=] { call(options); }, "normal offset"});
    }
    rows.push_back({"nothing to fit", [] { fit({}, {}); }, "there are 0 points"});

    const ConstraintSet constraints =
        place_constraints(prepared().points, std::vector<double>(prepared().points.size(), 1.0), {}).constraints;
    const std::function<void(const SolveOptions&)> solving = [&](const SolveOptions& o) { solve(constraints, o); };
    add<SolveOptions>(rows, "smoothing", &SolveOptions::smoothing, kBelow0, solving, "smoothing");
    add<SolveOptions>(rows, "tolerance_mm", &SolveOptions::tolerance_mm, kNotAbove0, solving, "tolerance");
    add<SolveOptions>(rows, "max_iterations", &SolveOptions::max_iterations, {0, -1}, solving, "iterations");
    add<SolveOptions>(rows, "max_memory_mb", &SolveOptions::max_memory_mb, {0, -1, kNan}, solving, "memory");
    rows.push_back({"threads", [&] { solve(constraints, {}, {.threads = -2}); }, "threads"});
    ConstraintSet values = constraints, trust = constraints, positions = constraints;
    values.values.pop_back();
    trust.trust.pop_back();
    positions.centers[7].x = kNan;
    rows.push_back({"values", [=] { solve(values); }, "values"});
    rows.push_back({"trust", [=] { solve(trust); }, "trust"});
    rows.push_back({"positions", [=] { solve(positions); }, "constraint 8"});
    rows.push_back({"previous",
                    [&] {
                        PreviousSolve previous{constraints.centers, {1, 2}};
                        solve(constraints, {}, {}, &previous);
                    },
                    "weights"});
    expect_refused(rows);
}

TEST(Preconditions, OfTheFunction) {
    std::vector<Row> rows;
    const ImplicitFunction& function = segmentation().function;
    const std::vector<Vec3> points(3);
    std::vector<double> two(2), three(3);
    std::vector<Vec3> two_gradients(2), three_gradients(3);
    FastFunction fast(function);
    rows.push_back({"values", [&] { function.values(points, two); }, "2 values for 3 points"});
    rows.push_back({"gradients", [&] { function.gradients(points, two_gradients); }, "2 gradients for 3 points"});
    rows.push_back({"both", [&] { function.values_and_gradients(points, two, three_gradients); }, "2 values"});
    rows.push_back({"both", [&] { function.values_and_gradients(points, three, two_gradients); }, "2 gradients"});
    rows.push_back({"threads", [&] { function.values(points, three, {.threads = -1}); }, "threads"});
    rows.push_back({"fast values", [&] { fast.values(points, two); }, "2 values for 3 points"});
    rows.push_back({"fast gradients", [&] { fast.gradients(points, two_gradients); }, "2 gradients for 3 points"});
    rows.push_back({"weights",
                    [&] {
                        ImplicitFunction(Kernel::triharmonic, {}, PointArrays(points), {1, 2}, {0, 0, 0, 0});
                    },
                    "2 weights for 3 centres"});
    for (const double scale : kNotAbove0)
        rows.push_back({"frame",
                        [=] {
                            ImplicitFunction(Kernel::triharmonic, {{}, scale}, PointArrays(points), three, {0, 0, 0, 0});
                        },
                        "scale"});
    const std::function<void(const FastOptions&)> call = [&](const FastOptions& o) { FastFunction(function, o); };
    add<FastOptions>(rows, "tolerance_mm", &FastOptions::tolerance_mm, kNotAbove0, call, "values");
    add<FastOptions>(rows, "gradient_tolerance", &FastOptions::gradient_tolerance, kNotAbove0, call, "gradients");
    add<FastOptions>(rows, "expected_points", &FastOptions::expected_points, {-1}, call, "expected points");
    rows.push_back({"fast values", [&] { fast.values(points, three, {.threads = -1}); }, "threads"});
    expect_refused(rows);
}

TEST(Preconditions, OfSegmenting) {
    std::vector<Row> rows;
    const auto refuse = [&](const std::string& part, const std::function<void(SegmentOptions&)>& spoil) {
        SegmentOptions options;
        spoil(options);
        rows.push_back({part, [=] { segment(contours(), grid(), options); }, part});
    };
    for (const double value : kNotAbove0) {
        refuse("normal offset", [=](SegmentOptions& o) { o.normal_offset_mm = value; });
        refuse("tolerance", [=](SegmentOptions& o) { o.tolerance_mm = value; });
    }
    for (const double value : kBelow0) refuse("smoothing", [=](SegmentOptions& o) { o.smoothing = value; });
    for (const double value : {0.0, 1.5, kNan}) refuse("quality", [=](SegmentOptions& o) { o.quality = value; });
    for (const double value : {0.0, -5.0, kNan})
        refuse("max_memory_mb", [=](SegmentOptions& o) { o.max_memory_mb = value; });
    rows.push_back({"threads", [] { segment(contours(), grid(), {}, {.threads = -1}); }, "threads"});

    Grid empty = grid(), flat = grid(), unknown = grid();
    empty.size.j = 0;
    flat.index_to_mm.set_column(1, {});
    unknown.index_to_mm.translation.x = kNan;
    const std::vector<Vec3> starts{contours().contours[0].points[0]};
    const Body body = metastasis();
    for (const Grid& odd : {empty, flat, unknown}) {
        rows.push_back({"segment", [=] { segment(contours(), odd); }, "grid"});
        rows.push_back({"track", [=] { track_surface(segmentation().function, odd, starts, {.threads = 1}); }, "grid"});
        rows.push_back(
            {"adaptive", [=] { track_surface_adaptively(segmentation().function, odd, starts, {.threads = 1}); }, "grid"});
        rows.push_back({"everywhere", [=] { sample_everywhere(segmentation().function, odd, {.threads = 1}); }, "grid"});
        rows.push_back({"rasterize", [=] { rasterize(contours(), odd); }, "grid"});
        rows.push_back({"phantom", [=] { make_phantom_image(odd); }, "grid"});
        rows.push_back({"truth", [=] { make_truth_mask(body, odd); }, "grid"});
    }
    for (const double value : kNotAbove0) {
        rows.push_back({"grid_around", [=] { grid_around(bounding_box(contours()), {1, value, 1}, 0); }, "spacing"});
        rows.push_back(
            {"preview", [=] { preview_surface(segmentation().function, starts, {.spacing_mm = value}); }, "spacing"});
        rows.push_back({"band", [=] { SurfaceBand(segmentation().function, starts, {.spacing_mm = value}); }, "spacing"});
        if (value != kInfinite)
            rows.push_back({"spline", [=] { spline(contours().contours[0].points, true, value); }, "step"});
    }
    for (const double value : {kNan, kInfinite})
        rows.push_back({"margin", [=] { grid_around(bounding_box(contours()), {1, 1, 1}, value); }, "margin"});
    const SurfaceLattice surface = track_surface(segmentation().function, grid(), starts, {.threads = 1});
    rows.push_back({"fill", [&] { fill(surface, {.threads = -1}); }, "threads"});
    rows.push_back({"polygonize", [&] { polygonize(surface, segmentation().function, {.threads = -1}); }, "threads"});
    rows.push_back({"residual", [&] { residual(segmentation().function, contours(), {.threads = -1}); }, "threads"});
    expect_refused(rows);
}

TEST(Preconditions, OfEditing) {
    std::vector<Row> rows;
    const std::function<void(const EditorOptions&)> editing = [](const EditorOptions& o) { Editor{o}; };
    const std::function<void(const EditorOptions&)> live = [](const EditorOptions& o) {
        LiveEditor(o, [](const EditorUpdate&) {});
    };
    for (const auto& call : {editing, live}) {
        add<EditorOptions>(rows, "preview", &EditorOptions::preview_spacing_mm, kBelow0, call, "preview's spacing");
        add<EditorOptions>(rows, "finished", &EditorOptions::finished_spacing_mm, kBelow0, call,
                           "finished surface's spacing");
        add<EditorOptions>(rows, "points", &EditorOptions::preview_points, {0}, call, "0 points");
    }
    const auto refuse = [&](const std::string& part, const std::function<void(SegmentOptions&)>& spoil) {
        EditorOptions options;
        spoil(options.segment);
        rows.push_back({"preview", [=] { Editor(options).preview(contours()); }, part});
        rows.push_back({"finish", [=] { Editor(options).finish(contours()); }, part});
    };
    for (const double value : kNotAbove0) {
        refuse("normal offset", [=](SegmentOptions& o) { o.normal_offset_mm = value; });
        refuse("tolerance", [=](SegmentOptions& o) { o.tolerance_mm = value; });
    }
    for (const double value : kBelow0) refuse("smoothing", [=](SegmentOptions& o) { o.smoothing = value; });
    for (const double value : {0.0, 1.5, kNan}) refuse("quality", [=](SegmentOptions& o) { o.quality = value; });
    rows.push_back({"preview", [] { Editor().preview(contours(), {.threads = -1}); }, "threads"});
    rows.push_back({"finish", [] { Editor().finish(contours(), {.threads = -1}); }, "threads"});
    expect_refused(rows);
}

TEST(Preconditions, OfWhatComesAfter) {
    std::vector<Row> rows;
    const Mask& mask = segmentation().mask;
    const std::vector<Plane> planes{contours().contours[0].plane};
    const std::function<void(const TraceOptions&)> tracing = [&](const TraceOptions& o) { trace(mask, planes, o); };
    add<TraceOptions>(rows, "step_mm", &TraceOptions::step_mm, kBelow0, tracing, "step_mm");
    add<TraceOptions>(rows, "tolerance_mm", &TraceOptions::tolerance_mm, kBelow0, tracing, "tolerance_mm");
    add<TraceOptions>(rows, "min_area_mm2", &TraceOptions::min_area_mm2, kBelow0, tracing, "min_area_mm2");
    rows.push_back({"trace", [&] { trace(mask, planes, {}, {.threads = -1}); }, "threads"});
    rows.push_back({"compare", [&] { compare(mask, mask, {.threads = -1}); }, "threads"});
    const std::function<void(const PhantomOptions&)> painting = [](const PhantomOptions& o) {
        make_phantom_image(grid(), o);
    };
    add<PhantomOptions>(rows, "noise_hu", &PhantomOptions::noise_hu, kBelow0, painting, "noise");
    rows.push_back({"phantom", [] { make_phantom_image(grid(), {}, {.threads = -1}); }, "threads"});
    rows.push_back({"dense liver", [] { dense_liver_case({.points = 0}); }, "points"});

    rows.push_back({"trace", [&] { trace(short_mask(), planes); }, "values for a grid"});
    rows.push_back({"compare", [&] { compare(mask, short_mask()); }, "values for a grid"});
    rows.push_back({"components", [] { component_sizes(short_mask()); }, "values for a grid"});
    rows.push_back({"slices", [] { slice_contours(short_mask(), segmentation().function); }, "values for a grid"});
    rows.push_back({"slices", [&] { slice_contours(mask, segmentation().function, {.threads = -1}); }, "threads"});
    rows.push_back({"box", [] { bounding_box(short_mask()); }, "values for a grid"});
    rows.push_back({"label", [] { select_label(short_image(), 1); }, "values for a grid"});
    rows.push_back({"nonzero", [] { select_nonzero(short_image()); }, "values for a grid"});
    const Plane plane = contours().contours[0].plane;
    rows.push_back({"reslice", [=] { reslice(short_image(), centered_reslice(plane, 4, 4, 1), 0); }, "values for a grid"});
    const std::vector<double> values(3);
    rows.push_back({"isolines", [=] { isolines({.plane = plane, .columns = 2, .rows = 2}, values); }, "values"});

    const TriangleMesh& mesh = *segmentation().mesh;
    rows.push_back({"picture", [&] { make_picture(mesh, contours(), nullptr, {.width_px = 10}); }, "picture"});
    rows.push_back({"picture", [&] { make_picture(mesh, contours(), nullptr, {}, {.threads = -1}); }, "threads"});
    rows.push_back({"picture", [] { make_picture(broken_mesh(), contours(), nullptr); }, "mesh"});
    for (const double width : kNotAbove0)
        rows.push_back({"window",
                        [=, &mesh] {
                            make_picture(mesh, contours(), nullptr, {.window = Window{40, width}});
                        },
                        "window's width"});
    for (const double center : {kNan, kInfinite})
        rows.push_back({"window",
                        [=, &mesh] {
                            make_picture(mesh, contours(), nullptr, {.window = Window{center, 1}});
                        },
                        "window's centre"});
    rows.push_back({"picture",
                    [&] {
                        const Image image = short_image();
                        make_picture(mesh, contours(), &image);
                    },
                    "values for a grid"});
    rows.push_back({"outline", [=] { outline(broken_mesh(), plane); }, "mesh"});
    rows.push_back({"volume", [] { signed_volume_mm3(broken_mesh()); }, "mesh"});
    rows.push_back({"topology", [] { topology(broken_mesh()); }, "mesh"});
    const Camera none{plane, 0, 10, 1}, tiny{plane, 10, 10, 0}, good{plane, 10, 10, 1};
    rows.push_back({"shade", [&] { shade(mesh, none); }, "pixels"});
    rows.push_back({"shade", [&] { shade(mesh, tiny); }, "pixel"});
    rows.push_back({"shade", [&] { shade(mesh, good, {.samples = 0}); }, "samples"});
    rows.push_back({"shade", [&] { shade(broken_mesh(), good); }, "mesh"});
    rows.push_back({"shade", [&] { shade(mesh, good, {}, {.threads = -1}); }, "threads"});
    for (const double part : {-0.1, 1.1, kNan})
        for (const Vec3& color : {Vec3{part, 0, 0}, Vec3{0, part, 0}, Vec3{0, 0, part}})
            rows.push_back({"colour", [=, &mesh] { shade(mesh, good, {.color = color}); }, "of the material"});

    const std::vector<float> slice(12);
    const EdgeMap edges(slice, 4, 3);
    rows.push_back({"edges", [&] { EdgeMap(slice, 4, 4); }, "4 x 4"});
    rows.push_back({"seed", [&] { LiveWire(edges, {4, 0}); }, "seed"});
    rows.push_back({"reach", [&] { LiveWire(edges, {1, 1}, -1); }, "reach"});
    expect_refused(rows);
}

TEST(Preconditions, OfReading) {
    const test::TemporaryFolder folder;
    const std::filesystem::path series = folder.path(), markups = series / "a.mrk.json", image = series / "a.nrrd";
    write_markups(markups, contours());
    write_mask(image, segmentation().mask);
    std::vector<Row> rows;
    const std::function<void(const ReadContoursOptions&)> one = [=](const ReadContoursOptions& o) {
        read_contours(markups, o);
    };
    const std::function<void(const ReadContoursOptions&)> several = [=](const ReadContoursOptions& o) {
        read_contours(std::vector{markups}, o);
    };
    const std::function<void(const ReadMarkupsOptions&)> curves = [=](const ReadMarkupsOptions& o) {
        read_markups(markups, o);
    };
    add<ReadContoursOptions>(rows, "one", &ReadContoursOptions::plane_tolerance_mm, kBelow0, one, "tolerance");
    add<ReadContoursOptions>(rows, "several", &ReadContoursOptions::plane_tolerance_mm, kBelow0, several, "tolerance");
    add<ReadMarkupsOptions>(rows, "markups", &ReadMarkupsOptions::plane_tolerance_mm, kBelow0, curves, "tolerance for");

    const std::vector<std::int64_t> limits{0, -1};
    for (const std::function<void(const ReadImageOptions&)>& call :
         std::vector<std::function<void(const ReadImageOptions&)>>{
             [=](const ReadImageOptions& o) { read_image(image, o); },
             [=](const ReadImageOptions& o) { read_grid(image, o); },
             [=](const ReadImageOptions& o) { read_mask(image, {}, o); }})
        add<ReadImageOptions>(rows, "limit", &ReadImageOptions::max_voxels, limits, call, "limit of voxels");
    for (const std::function<void(const DicomSeriesOptions&)>& call :
         std::vector<std::function<void(const DicomSeriesOptions&)>>{
             [=](const DicomSeriesOptions& o) { read_dicom_series(series, o); },
             [=](const DicomSeriesOptions& o) { read_dicom_grid(series, o); }})
        add<DicomSeriesOptions>(rows, "limit", &DicomSeriesOptions::max_voxels, limits, call, "limit of voxels");
    for (const std::int64_t limit : limits) {
        rows.push_back({"segments", [=] { read_dicom_segmentation(image, limit); }, "limit of voxels"});
        rows.push_back({"labels", [=] { read_dicom_seg(image, {}, limit); }, "limit of voxels"});
        rows.push_back({"masks", [=] { read_dicom_seg_masks(image, limit); }, "limit of voxels"});
    }
    expect_refused(rows);
}

TEST(Preconditions, OfWriting) {
    const test::TemporaryFolder folder;
    std::vector<Row> rows;
    for (const char* name : {"a.nii.gz", "a.nrrd", "a.mha", "a.seg.nrrd"}) {
        const auto path = folder.path() / name;
        rows.push_back({name, [=] { write_mask(path, short_mask()); }, "values for a grid"});
        rows.push_back({name, [=] { write_image(path, short_image()); }, "values for a grid"});
        for (const std::int64_t label : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{65536}})
            rows.push_back({name, [=] { write_mask(path, segmentation().mask, {.label = label}); }, "label value"});
    }
    for (const double part : {-0.1, 1.1, kNan}) {
        const auto path = folder.path() / "a.seg.nrrd";
        rows.push_back({"colour",
                        [=] {
                            write_mask(path, segmentation().mask, {.color = {part, 0, 0}});
                        },
                        "red of segment"});
        const Image labels{grid(), segmentation().mask.values};
        rows.push_back({"colour", [=] { write_image(path, labels, {{1, "a", {0, 0, part}}}); }, "blue of segment 'a'"});
    }
    const auto mesh = folder.path() / "a.stl", picture = folder.path() / "a.png";
    rows.push_back({"mesh", [=] { write_mesh(mesh, broken_mesh()); }, "mesh"});
    rows.push_back({"picture", [=] { write_png(picture, {3, 3, std::vector<std::uint8_t>(5)}); }, "3 x 3"});
    expect_refused(rows);
}

}  // namespace
}  // namespace kontur
