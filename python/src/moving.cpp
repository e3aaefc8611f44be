// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>

#include "bindings.h"
#include "fields.h"
#include "kontur/base/checks.h"
#include "kontur/moving_sureness.h"
#include "kontur/segment_moving.h"
#include "kontur/suggest_moving.h"
#include "points.h"
#include "segment_keywords.h"

namespace kontur::python {
namespace {

py::array_t<double> values_at(const MovingFunction& function, const ArrayOf<double>& points, double time, int threads) {
    py::array_t<double> values(leading_shape(points));
    const std::span out(values.mutable_data(), static_cast<std::size_t>(values.size()));
    const ReleasedLock released;
    function.values(span_of(points), time, out, {.threads = threads});
    return values;
}

FramesToSegment frames_of(const Grid& grid, const std::vector<double>& times, std::optional<std::vector<Image>> images) {
    if (!images) return grid;
    check_same_count("images", images->size(), "times", times.size());
    std::map<double, std::shared_ptr<const Image>> at;
    for (std::size_t n = 0; n < times.size(); ++n)
        at.emplace(times[n], std::make_shared<const Image>(std::move((*images)[n])));
    return {grid, [at = std::move(at)](double time) {
                const auto found = at.find(time);
                return found == at.end() ? nullptr : found->second;
            }};
}

void bind_function(py::module_& m) {
    py::class_<MovingFunction> function(m, "MovingFunction", R"(f(x, t) of an object that moves. Immutable.

Functions at some moments, and between them how their values run. Calling it gives values.

Parameters
----------
times : sequence of float
    Moments, which rise: frames, from 1, or seconds.
functions : sequence of ImplicitFunction
    One for each of them.
cycle : float, optional
    The motion repeats after so long; None: nothing moves before the first moment and after the last.
)");
    constructor(
        function,
        [](std::vector<double> times, std::vector<ImplicitFunction> functions, std::optional<double> cycle) {
            return MovingFunction(TimeCourse(std::move(times), cycle), std::move(functions));
        },
        py::arg("times"), py::arg("functions"), py::arg("cycle") = py::none());
    function.def_property_readonly(
        "times", [](const MovingFunction& f) { return f.course().times(); }, "list of float: the moments.");
    function.def_property_readonly(
        "cycle", [](const MovingFunction& f) { return f.course().cycle(); }, "float or None");
    function.def_property_readonly(
        "functions", [](const MovingFunction& f) { return f.functions(); }, "list of ImplicitFunction: at the moments.");
    method(function, "values", R"(Values of f at points and one time.

Parameters
----------
points : array_like, shape (..., 3)
    mm (LPS).
time : float
    Frame, from 1, or seconds, as the contours had it.
threads : int
    0: the machine's. The values do not depend on it.

Returns
-------
ndarray, shape (...), float64
    About the distance to the surface in mm close to it, > 0 inside.
)",
           &values_at, py::arg("points"), py::arg("time"), kThreads);
    method(function, "__call__", "The same as `values`.", &values_at, py::arg("points"), py::arg("time"), kThreads);
    function.def("__repr__", [](const MovingFunction& f) {
        return py::str("<MovingFunction, {} moments>").format(f.functions().size());
    });
    function.def("__reduce__", [](const py::object& self) {
        return py::make_tuple(py::type::of(self),
                              py::make_tuple(self.attr("times"), self.attr("functions"), self.attr("cycle")));
    });
}

void bind_results(py::module_& m) {
    py::class_<VolumeInterval> interval(m, "VolumeInterval", "The true volume lies within in 90 %.");
    Fields(interval)
        .field("low_ml", &VolumeInterval::low_ml, "float")
        .field("high_ml", &VolumeInterval::high_ml, "float")
        .picklable();
    py::class_<VolumeCurve> curve(m, "VolumeCurve", "A volume over time.");
    Fields(curve)
        .field("volumes_ml", &VolumeCurve::volumes_ml, "list of float: of the masks.")
        .field("intervals", &VolumeCurve::intervals,
               "list of VolumeInterval: of each; none where a moment has too few planes to tell.")
        .field("largest", &VolumeCurve::largest, "int: which of them, from 0; the first one of a tie.")
        .field("smallest", &VolumeCurve::smallest, "int")
        .picklable();
    curve.def_property_readonly("stroke_ml", &VolumeCurve::stroke_ml, "float: the largest less the smallest.");
    curve.def_property_readonly("ejection_fraction", &VolumeCurve::ejection_fraction,
                                "float: of the largest volume, from 0 to 1.");
    curve.def_property_readonly(
        "ejection_interval",
        [](const VolumeCurve& c) -> std::optional<std::pair<double, double>> {
            const auto found = c.ejection_interval();
            return found ? std::optional(std::pair(found->low, found->high)) : std::nullopt;
        },
        "(float, float) or None: it lies within in 90 %.");
    py::class_<DrawnMoment> moment(m, "DrawnMoment", "A moment at which something was drawn.");
    moment.def_readonly("time", &DrawnMoment::time, "float: frame, from 1, or seconds.");
    moment.def_readonly("contours", &DrawnMoment::contours, "int: drawn at it.");
    moment.def_readonly("carried", &DrawnMoment::carried, "int: sections in planes that were drawn at other moments alone.");
    moment.def_readonly("segmentation", &DrawnMoment::segmentation, "Segmentation: of this moment.");
    py::class_<MovingSegmentation> type(m, "MovingSegmentation", "What `segment_moving` made.");
    type.def_readonly("times", &MovingSegmentation::times, "list of float");
    type.def_readonly("masks", &MovingSegmentation::masks, "list of Mask: at these times.");
    type.def_readonly("meshes", &MovingSegmentation::meshes,
                      "list of TriangleMesh: at these times, with `mesh`; else none.");
    type.def_readonly("function", &MovingSegmentation::function, "MovingFunction: f(x, t) > 0 inside.");
    type.def_readonly("moments", &MovingSegmentation::moments, "list of DrawnMoment");
    type.def_readonly("volumes", &MovingSegmentation::volumes, "VolumeCurve: at these times.");
    type.def_readonly("warnings", &MovingSegmentation::warnings, "list of str: choices made for the user and doubts.");
    type.def_property_readonly(
        "seconds",
        [](const MovingSegmentation& result) {
            py::dict seconds;
            for (const auto& [stage, duration] : result.seconds) seconds[py::str(stage)] = duration;
            return seconds;
        },
        "dict of str to float: wall time by stage.");
    type.def("__repr__", [](const MovingSegmentation& s) {
        return py::str("<MovingSegmentation: {} masks, {} moments>").format(s.masks.size(), s.moments.size());
    });
}

void bind_half_widths(py::module_& m) {
    define(
        m, "moving_half_widths_mm", R"(Half the width of the band in which 90 % of the true surface lies at a time.

Parameters
----------
moving : MovingSegmentation
points : array_like, shape (n, 3)
    mm, on the surface of that time.
time : float
    As `times` has it.
threads : int
    0: the machine's.

Returns
-------
ndarray, shape (n,), float64
    mm; empty where a moment has too few planes to tell.
)",
        [](const MovingSegmentation& moving, const ArrayOf<double>& points, double time, int threads) {
            const std::span<const Vec3> rows = points_of(points);
            std::vector<double> widths = unlocked([&] {
                return half_widths_mm(moving.function, moving.moments, {rows.begin(), rows.end()}, time,
                                      {.threads = threads});
            });
            const auto count = static_cast<py::ssize_t>(widths.size());
            return owning_array(std::move(widths), {count});
        },
        py::arg("moving"), py::arg("points"), py::arg("time"), kThreads);
}

void bind_suggest_moving(py::module_& m) {
    py::class_<MovingSuggestion> type(m, "MovingSuggestion", "When and where to draw next.");
    type.def_readonly("frame", &MovingSuggestion::frame, "int: index into the times.");
    type.def_readonly("plane", &MovingSuggestion::plane, "Plane: its origin lies amid the expected outline.");
    define(
        m, "suggest_moving", R"(In which frame to draw next, and in which plane.

The frames whose volumes are least sure, each once. Where little was drawn in one, the plane is one of other moments: that in
which the surface moves most.

Parameters
----------
moving : MovingSegmentation
    Of `segment_moving`.
count : int
    Best first, each for what the ones before it leave.
threads : int
    0: the machine's.

Returns
-------
list of MovingSuggestion
    Fewer than `count` when nothing is left.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> drawn = [kontur.Contour(c.points, c.plane, frame=frame) for frame in (1, 5) for c in case.contours]
>>> moving = kontur.segment_moving(kontur.ContourSet(drawn, cycle_frames=8), case.grid, range(1, 9))
>>> [one] = kontur.suggest_moving(moving)
>>> one.frame
2
)",
        [](const MovingSegmentation& moving, std::int64_t count, int threads) {
            if (count < 1)
                throw Error(ErrorKind::invalid_input, std::to_string(count) + " planes are asked for; at least 1 is needed");
            return unlocked([&] {
                return suggest_moving({moving.times, moving.volumes, moving.function, moving.moments},
                                      static_cast<std::size_t>(count), {}, {.threads = threads});
            });
        },
        py::arg("moving"), py::arg("count") = 1, kThreads);
}

}  // namespace

void bind_moving(py::module_& m) {
    bind_function(m);
    bind_results(m);
    bind_half_widths(m);
    bind_suggest_moving(m);
    define(
        m, "is_moving", "Whether contours were drawn at different moments, as `segment_moving` takes them.",
        [](const ContourSet& contours) { return is_moving(contours); }, py::arg("contours"));
    const auto keywords = segment_keywords();
    define(
        m, "segment_moving", R"(Contours drawn at some moments to masks at all times.

Each moment at which something was drawn is segmented by itself, as `segment` does. Where little was drawn, sections in planes
that were drawn at other moments follow from those. Where most was drawn, the image of that time is followed, as far as that
helps. The same bytes for any number of threads, and the same as the command line's. Other Python threads run meanwhile.

Parameters
----------
contours : ContourSet
    Each contour with a `frame`, or each with a `time_s`; `cycle_frames` or `cycle_s` where the motion repeats.
grid : Grid
times : sequence of float
    At which masks are made, in the contours' unit, such as range(1, 21).
images : sequence of Image, optional
    One for each of the times, on the grid; without them the contours do alone.
@threads
@progress
@options

Returns
-------
MovingSegmentation

Raises
------
InvalidInputError
    As `segment` does, and for contours of which some have no moment, or one that is not within the times or the cycle.
SingularSystemError, TooLargeError, CancelledError

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> drawn = [kontur.Contour(c.points, c.plane, frame=frame) for frame in (1, 5) for c in case.contours]
>>> moving = kontur.segment_moving(kontur.ContourSet(drawn, cycle_frames=8), case.grid, range(1, 9))
>>> len(moving.masks), moving.volumes.stroke_ml
(8, 0.0)
>>> bool(moving.function(case.grid.bounds_mm.mean(0), 2.5) == moving.function(case.grid.bounds_mm.mean(0), 1))
True
)",
        [keywords](const ContourSet& contours, const Grid& grid, const std::vector<double>& times,
                   std::optional<std::vector<Image>> images, int threads, const py::object& progress, const py::object& stop,
                   const py::kwargs& given) {
            const SegmentOptions options = keywords.parse("segment_moving", given);
            const FramesToSegment frames = frames_of(grid, times, std::move(images));
            return run({progress, stop, threads},
                       [&](const Work& work) { return segment_moving(contours, frames, times, options, work); });
        },
        py::arg("contours"), py::arg("grid"), py::arg("times"), py::kw_only(), py::arg("images") = py::none(), kThreads,
        kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
