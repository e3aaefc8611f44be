// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/reduce.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/fit/sides.h"
#include "kontur/solve/solve.h"
#include "segment_words.h"

namespace kontur::python {
namespace {

/// One member of each element as an array, shape (n, 3).
template <class Element>
std::vector<Vec3> column(const std::vector<Element>& elements, Vec3 Element::*member) {
    std::vector<Vec3> values(elements.size());
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = elements[n].*member;
    return values;
}

/// What the contours mean goes with how they are prepared.
struct Preparing {
    FillRule fill_rule = FillRule::even_odd;
    PrepareOptions options;
};

Keywords<Preparing> prepare_keywords() {
    const auto option = [](auto member) {
        return [member](Preparing & p) -> auto& { return p.options.*member; };
    };
    return Keywords<Preparing>()
        .field("quality", option(&PrepareOptions::quality), "Fraction of each contour's points to keep, in (0, 1].")
        .field("least_segments", option(&PrepareOptions::least_segments),
               "Contours of fewer segments, times quality, are subdivided; 0: the paper's rule.")
        .field("fill_rule", &Preparing::fill_rule, "What contours inside others mean.")
        .field("gaps", option(&PrepareOptions::gaps), "Keep normal constraints clear of the opposite wall.")
        .field("click_margin_mm", option(&PrepareOptions::click_margin_mm),
               "How far f must be from 0 at interior and exterior points; None: 0.45 % of the drawing's diameter.")
        .field(
            "conflicts", [](Preparing& p) -> Conflicts& { return p.options.reconcile.conflicts; },
            "Which of two contours that contradict each other yields: both, the earlier one, or none.")
        .field("bounds", option(&PrepareOptions::bounds),
               "Keep f on the drawn planes' sides, and end the object beyond the last of them.")
        .field("copy_shift_mm", option(&PrepareOptions::copy_shift_mm),
               "> 0: coplanar contours get a copy of the first one, shifted by this.");
}

template <class Options, class Access>
Keywords<Options>& solve_fields(Keywords<Options>& keywords, Access access) {
    const auto to = [access](auto member) {
        return [ access, member ](Options & options) -> auto& { return access(options).*member; };
    };
    return keywords
        .field("kernel", to(&SolveOptions::kernel), "Radial function: r^3 that goes back to a mean outside, r^3 or r.")
        .field("ball", to(&SolveOptions::ball),
               "Centre and radius in mm of what was drawn, as `ContourSet.smallest_ball`: the unit, of which the screened "
               "kernel's length is 4; None: the smallest one of all constraints (`fit`: the prepared contours').")
        .field("solver", to(&SolveOptions::solver), "'automatic' is iterative; 'dense' is LAPACK's dsysv, the paper's.")
        .field("smoothing", to(&SolveOptions::smoothing),
               "On unit coordinates; 0 interpolates exactly; None: 1e-5, and 0 where `fit` takes in-plane normals.")
        .field("tolerance_mm", to(&SolveOptions::tolerance_mm),
               "Of the iterative solver, at all constraints; None: 1.5e-5 of the ball's diameter.")
        .field("max_iterations", to(&SolveOptions::max_iterations), "Of the iterative solver.")
        .field("max_memory_mb", to(&SolveOptions::max_memory_mb), "A dense matrix larger than this is refused.");
}

Keywords<SolveOptions> solve_keywords() {
    Keywords<SolveOptions> keywords;
    return solve_fields(keywords, [](SolveOptions& o) -> SolveOptions& { return o; });
}

Keywords<FitOptions> fit_keywords() {
    Keywords<FitOptions> keywords;
    keywords
        .field("normals", &FitOptions::normals,
               "Direction of the surface at a contour: from all contours together, or the contour's alone.")
        .field("rounds", &FitOptions::rounds,
               "Surface normals: how often the tilts are read from the fit and given back to it.")
        .field("start_smoothing", &FitOptions::start_smoothing, "Smoothing of the first fit, on unit coordinates.")
        .field("smoothing_factor", &FitOptions::smoothing_factor, "And its factor from round to round.")
        .field("least_slope", &FitOptions::least_slope, "Lower bound of the cosine of the tilt.")
        .field("early_tolerance_factor", &FitOptions::early_tolerance_factor,
               "On tolerance_mm, in the rounds before the last.")
        .field("tilt_points", &FitOptions::tilt_points, "About how many of the points take part in these rounds.")
        .field("most_points", &FitOptions::most_points, "The last fit uses about as many points; 0: all.")
        .field("line_tolerance_mm", &FitOptions::line_tolerance_mm,
               "Points that the others of their line show as exactly as this are left out; 0: none; None: 1e-4 of the "
               "diameter.")
        .field("most_solves", &FitOptions::most_solves,
               "At most so many with all points, while other bounds should be held than were; 1: whatever is held.")
        .field("bounds_tolerance_mm", &FitOptions::bounds_tolerance_mm,
               "By so much f may leave a bound without being solved again; None: twice tolerance_mm.")
        .field("normal_offset_mm", &FitOptions::normal_offset_mm,
               "Length of the normal constraints; None: 1.35 % of the drawing's diameter, in-plane normals 0.45 %.")
        .field("both_sides", &FitOptions::both_sides,
               "Normal constraints inside as well as outside, at about every second point; None: with surface normals.")
        .field("normal_spacing_mm", &FitOptions::normal_spacing_mm,
               "Along a line, from one point with normal constraints to the next, at least; None: 0.75 of their length, "
               "in-plane normals 0.")
        .field("slope_noise", &FitOptions::slope_noise,
               "Standard deviation of the slopes: of a normal constraint this times its length; None: 0.21, in-plane "
               "normals 0.")
        .field("merge_distance_mm", &FitOptions::merge_distance_mm,
               "A constraint closer than this to an earlier one is left out; None: 0.06 % of the drawing's diameter.");
    return solve_fields(keywords, [](FitOptions& o) -> SolveOptions& { return o.solve; });
}

void bind_types(py::module_& m) {
    py::class_<ContourOrientation> orientation(m, "ContourOrientation", "A contour's outward side.");
    orientation.def_readonly("normals", &ContourOrientation::normals,
                             "ndarray, shape (n, 3): unit, in the plane, out of the object.");
    orientation.def_readonly("crossings", &ContourOrientation::crossings,
                             "ndarray, shape (m, 3): mm, where the contour crosses itself.");

    py::class_<PreparedContours> prepared(m, "PreparedContours", "Contours as the fit sees them.");
    prepared.def_property_readonly(
        "positions", [](const PreparedContours& p) { return column(p.points, &BoundaryPoint::position); },
        "ndarray, shape (n, 3): mm.");
    prepared.def_property_readonly(
        "inplane_normals", [](const PreparedContours& p) { return column(p.points, &BoundaryPoint::inplane_normal); },
        "ndarray, shape (n, 3): unit, outward, in the contour's plane.");
    prepared.def_property_readonly(
        "plane_normals", [](const PreparedContours& p) { return column(p.points, &BoundaryPoint::plane_normal); },
        "ndarray, shape (n, 3): unit normals of the contours' planes.");
    prepared.def_property_readonly(
        "contours",
        [](const PreparedContours& p) {
            std::vector<std::int32_t> contours;
            for (const BoundaryPoint& point : p.points) contours.push_back(point.contour);
            const auto count = static_cast<py::ssize_t>(contours.size());
            return owning_array(std::move(contours), {count});
        },
        "ndarray, shape (n,), int32: index of each point's contour.");
    prepared.def_property_readonly(
        "trust",
        [](const PreparedContours& p) {
            std::vector<double> trust;
            for (const BoundaryPoint& point : p.points) trust.push_back(point.trust);
            const auto count = static_cast<py::ssize_t>(trust.size());
            return owning_array(std::move(trust), {count});
        },
        "ndarray, shape (n,): above 0, how closely the surface is to follow each point; its contour's weight until "
        "`reconcile`.");
    prepared.def_readonly("crossings", &PreparedContours::crossings,
                          "ndarray, shape (m, 3): mm, where contours cross themselves.");
    prepared.def_readonly(
        "bounds", &PreparedContours::bounds,
        "list of Bound: in the drawn planes, beyond the last of them, and at interior and exterior points.");
    prepared.def_readonly("ball", &PreparedContours::ball,
                          "(ndarray, float): centre and radius of the smallest ball around all that was drawn, mm.");
    prepared.def_readonly("notes", &PreparedContours::notes, "list of str: choices made for you and doubts.");
    prepared.def_readonly("coplanar", &PreparedContours::coplanar, "bool: all contours lie in one plane.");

    py::class_<Bound> bound(m, "Bound", "An interval that f is to keep at a place.");
    bound.def_readonly("position", &Bound::position, "ndarray, shape (3,): mm.");
    bound.def_readonly("least_mm", &Bound::least_mm, "float: may be -inf.");
    bound.def_readonly("most_mm", &Bound::most_mm, "float: may be inf.");
    bound.def_readonly("noise_mm", &Bound::noise_mm, "float: standard deviation.");

    py::class_<SolveReport> report(m, "SolveReport", "What the solver did.");
    report.def_readonly("solver", &SolveReport::solver, "str: the one that ran.");
    report.def_readonly("centres", &SolveReport::centres, "int: number of weights.");
    report.def_readonly("iterations", &SolveReport::iterations, "int: 0 for direct solvers.");
    report.def_readonly("residual", &SolveReport::residual, "float: largest error at a constraint, mm.");
    report.def_readonly("matrix_mb", &SolveReport::matrix_mb, "float: of the factorised matrix or of the preconditioner.");

    py::class_<Solution> solution(m, "Solution", "A function through constraints.");
    solution.def_readonly("function", &Solution::function, "ImplicitFunction");
    solution.def_readonly("report", &Solution::report, "SolveReport");

    py::class_<FittedFunction> fit_type(m, "FittedFunction", "A function fitted to contours.");
    fit_type.def_readonly("function", &FittedFunction::function, "ImplicitFunction");
    fit_type.def_readonly("report", &FittedFunction::report, "SolveReport: of the last solve.");
    fit_type.def_readonly("solves", &FittedFunction::solves, "int: of any part of the points.");
    fit_type.def_readonly("full_solves", &FittedFunction::full_solves, "int: of all points.");
    fit_type.def_readonly("iterations", &FittedFunction::iterations, "int: over all solves.");
    fit_type.def_readonly("merged", &FittedFunction::merged, "int: near-duplicate constraints left out.");
    fit_type.def_readonly("bounded", &FittedFunction::bounded, "int: bounds at which f is held.");
    fit_type.def_readonly("constraints", &FittedFunction::constraints, "int: kept.");
    fit_type.def_readonly("tilt_change_degrees", &FittedFunction::tilt_change_degrees, "float: mean, in the last round.");
    fit_type.def_property_readonly(
        "slopes",
        [](const FittedFunction& f) {
            return py::array_t<double>(static_cast<py::ssize_t>(f.slopes.size()), f.slopes.data());
        },
        "ndarray, shape (n,): cosine of the surface's tilt at each prepared point.");
}

void bind_steps(py::module_& m) {
    define(m, "orient",
           "The ContourOrientation of a contour: its outward side, by the even-odd rule where it crosses itself.", &orient,
           py::arg("contour"));
    define(
        m, "reduce", R"(Removes the points that matter least for a contour's shape.

Parameters
----------
contour : Contour
quality : float
    Fraction of the points to keep, in (0, 1].
min_points : int
    A contour is never reduced below this many points.

Returns
-------
Contour
)",
        [](const Contour& contour, double quality, std::size_t min_points) {
            return reduce(contour, ReduceOptions{quality, min_points});
        },
        py::arg("contour"), py::arg("quality") = ReduceOptions{}.quality,
        py::arg("min_points") = ReduceOptions{}.min_points);
    define(m, "subdivide", "The Contour with long segments subdivided; `least_segments` 0 is the paper's rule alone.",
           static_cast<Contour (*)(const Contour&, int)>(&subdivide), py::arg("contour"), py::arg("least_segments") = 0);
    const auto preparing = prepare_keywords();
    define(
        m, "prepare",
        R"(Reduces, subdivides and orients every contour, finds bounds, and trusts contours less where they contradict.

Parameters
----------
contours : ContourSet
@options

Returns
-------
PreparedContours
)",
        [preparing](const ContourSet& contours, const py::kwargs& given) {
            const Preparing preparation = preparing.parse("prepare", given);
            return unlocked([&] {
                const Drawing drawing = read_drawing(contours, preparation.fill_rule);
                PreparedContours prepared = prepare(drawing, preparation.options);
                prepared.notes.insert(prepared.notes.begin(), drawing.notes.begin(), drawing.notes.end());
                return prepared;
            });
        },
        py::arg("contours"), py::kw_only(), KeywordText(preparing));
    const auto reconciling =
        Keywords<ReconcileOptions>()
            .field("conflicts", &ReconcileOptions::conflicts,
                   "Which of two contours yields: both, the earlier one, or none.")
            .field("offset_mm", &ReconcileOptions::offset_mm,
                   "Disagreements far below it do not matter; None: 0.45 % of the drawing's diameter.")
            .field("strength", &ReconcileOptions::strength,
                   "A point in the middle of a disagreement as large as the offset gets 1 / (1 + strength) trust.")
            .field("reach", &ReconcileOptions::reach,
                   "How far around a crossing, in multiples of the disagreement, contours yield.");
    define(
        m, "reconcile", R"(Lowers the trust in points about every crossing at which contours disagree.

Parameters
----------
prepared : PreparedContours
crossings : sequence of Crossing
    From `find_crossings` on the set that was prepared with ``conflicts="exact"``.
@options

Returns
-------
PreparedContours
)",
        [reconciling](PreparedContours prepared, const std::vector<Crossing>& crossings, const py::kwargs& given) {
            reconcile(prepared.points, crossings, prepared.ball.diameter(), reconciling.parse("reconcile", given));
            return prepared;
        },
        py::arg("prepared"), py::arg("crossings"), py::kw_only(), KeywordText(reconciling));
    const auto fitting = fit_keywords();
    define(
        m, "fit", R"(Fits the implicit function to prepared contours.

Parameters
----------
prepared : PreparedContours
@threads
@progress
@options

Returns
-------
FittedFunction
)",
        [fitting](const PreparedContours& prepared, int threads, const py::object& progress, const py::object& stop,
                  const py::kwargs& given) {
            const FitOptions options = fitting.parse("fit", given);
            return run({progress, stop, threads}, [&](const Work& work) { return fit(prepared, options, work); });
        },
        py::arg("prepared"), py::kw_only(), kThreads, kProgress, kStop, KeywordText(fitting));
    const auto solving = solve_keywords();
    define(
        m, "solve", R"(The variational interpolant through constraints (Turk and O'Brien 2002).

With the screened kernel it is the function that departs least from its mean, with the others the smoothest one.

Parameters
----------
constraints : ConstraintSet
@threads
@progress
@options

Returns
-------
Solution

Raises
------
SingularSystemError
    When centres coincide or, but for the screened kernel, all lie in one plane.

Examples
--------
>>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [.2, .2, .2]])
>>> solution = kontur.stages.solve(kontur.stages.ConstraintSet(corners, [0, 0, 0, 0, 1]), solver="dense", smoothing=0)
>>> bool(abs(solution.function(corners[4]) - 1) < 1e-9)
True
)",
        [solving](const ConstraintSet& constraints, int threads, const py::object& progress, const py::object& stop,
                  const py::kwargs& given) {
            const SolveOptions options = solving.parse("solve", given);
            return run({progress, stop, threads}, [&](const Work& work) { return solve(constraints, options, work); });
        },
        py::arg("constraints"), py::kw_only(), kThreads, kProgress, kStop, KeywordText(solving));
}

}  // namespace

void bind_fitting(py::module_& m) {
    bind_types(m);
    bind_steps(m);
}

}  // namespace kontur::python
