// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "fields.h"
#include "kontur/suggest.h"
#include "segment_words.h"

namespace kontur::python {

namespace {

void bind_dice(py::module_& m) {
    py::class_<ExpectedDice> type(m, "ExpectedDice", "Overlap with the truth that a mask may be expected to have.");
    Fields(type)
        .field("value", &ExpectedDice::value, "float: 0 where nothing is known.")
        .field("low", &ExpectedDice::low, "float: the true one lies between `low` ...")
        .field("high", &ExpectedDice::high, "float: ... and `high` in 90 % of all cases.")
        .picklable();
    type.def("__repr__", [](const ExpectedDice& d) {
        return py::str("<ExpectedDice {:.3f}, {:.3f} to {:.3f}>").format(d.value, d.low, d.high);
    });
}

void bind_uncertainty_type(py::module_& m) {
    using U = SurfaceUncertainty;
    py::class_<U> type(m, "SurfaceUncertainty", R"(How sure a surface is, from its contours alone.

Below three different planes nothing is known: `is_known` is False and all figures are 0. What no contour touches is not in the
surface, and in none of the figures.
)");
    Fields(type)
        .field("is_known", &U::is_known, "bool")
        .field("planes", &U::planes, "int: different ones that were drawn in.")
        .field("half_width_median_mm", &U::half_width_median_mm, "float: of the 90 % band, over the surface's area.")
        .field("half_width_p90_mm", &U::half_width_p90_mm, "float: on 90 % of the area the band is narrower.")
        .field("farthest_mm", &U::farthest_mm, "float: of the surface from anything drawn.")
        .field("farthest_position", &U::farthest_position, "ndarray, shape (3,): mm, where that is.")
        .field("volume_ml", &U::volume_ml, "float: of the mask.")
        .field("volume_low_ml", &U::volume_low_ml, "float: the true volume lies between this ...")
        .field("volume_high_ml", &U::volume_high_ml, "float: ... and this in 90 % of all cases.")
        .field("dice", &U::dice, "ExpectedDice")
        .field("planes_to_95", &U::planes_to_95, "int: planes still to draw until a Dice of 0.95 is expected.")
        .field("planes_to_98", &U::planes_to_98, "int: until 0.98.")
        .picklable();
    type.def("__str__", [](const U& self) { return sentence(self); });
    type.def("__repr__", [](const U& self) { return "<SurfaceUncertainty: " + sentence(self) + ">"; });
}

void bind_suggestion_type(py::module_& m) {
    py::class_<SuggestedPlane> type(m, "SuggestedPlane", "A plane in which to draw next.");
    type.def_readonly("plane", &SuggestedPlane::plane, "Plane: its origin lies amid the predicted outline.");
    type.def_property_readonly(
        "slice",
        [](const SuggestedPlane& self) -> py::object {
            if (!self.slice) return py::none();
            return py::make_tuple(self.slice->axis, self.slice->index);
        },
        "(int, int), or None: axis (0, 1, 2 for i, j, k) and index of the image's slice, if it is one.");
    type.def_readonly("gain", &SuggestedPlane::gain,
                      "float: share of the surface's distance from what is drawn that a contour here takes away.");
    type.def_readonly("before", &SuggestedPlane::before, "ExpectedDice: without the contour; 0 below three planes.");
    type.def_readonly("after", &SuggestedPlane::after, "ExpectedDice: with it.");
    type.def("__repr__", [](const SuggestedPlane& s) {
        return py::str("<SuggestedPlane through {}, across {}>").format(py::cast(s.plane.origin), py::cast(s.plane.normal));
    });
}

void bind_suggest_planes(py::module_& m) {
    define(
        m, "suggest_planes", R"(Where to draw next.

While all planes drawn are parallel, one at right angles to them; after that the plane that brings the surface nearest to what is
drawn. Never one that misses the surface, and never one that runs along a drawn plane or one of `contours.empty_planes`.

Parameters
----------
segmentation : Segmentation
    Where its image was used, places that the image knows count less.
contours : ContourSet
    What it was made from.
count : int
    Best first, each for what the ones before it leave.
among : {'any', 'image-slices'}
    Planes of any direction, or slices of the image only.
grid : Grid, optional
    Of the image that was drawn on; needed for its slices.
avoid : sequence of Plane
    Not these, nor planes along them.
threads : int
    0: the machine's.

Returns
-------
list of SuggestedPlane
    Fewer than `count` when no other plane is left.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> kidney = kontur.segment(case.contours, case.grid)
>>> [plane] = kontur.suggest_planes(kidney, case.contours)
>>> plane.after.value > plane.before.value
True
)",
        [](const Segmentation& segmentation, const ContourSet& contours, std::int64_t count, PlaneChoice among,
           const std::optional<Grid>& grid, const std::vector<Plane>& avoid, int threads) {
            if (count < 1)
                throw Error(ErrorKind::invalid_input, std::to_string(count) + " planes are asked for; at least 1 is needed");
            return unlocked([&] {
                return suggest_planes(segmentation, contours, static_cast<std::size_t>(count), {among, grid, avoid},
                                      {.threads = threads})
                    .planes;
            });
        },
        py::arg("segmentation"), py::arg("contours"), py::arg("count") = 1, py::arg("among") = PlaneChoice::any,
        py::arg("grid") = py::none(), py::arg("avoid") = py::tuple(), kThreads);
}

void bind_half_widths(py::module_& m) {
    define(
        m, "half_widths_mm", R"(Half the width of the band in which the true surface is expected with 90 %.

Parameters
----------
segmentation : Segmentation
contours : ContourSet
    What it was segmentation from.
points : array_like, shape (n, 3)
    mm, on the surface: a mesh's, for example.
threads : int
    0: the machine's.

Returns
-------
ndarray, shape (n,), float64
    mm; empty below three different planes, of which nothing can be said.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> kidney = kontur.segment(case.contours, case.grid, mesh=True)
>>> widths = kontur.half_widths_mm(kidney, case.contours, kidney.mesh.points)
>>> widths.shape == (len(kidney.mesh.points),)
True
)",
        [](const Segmentation& segmentation, const ContourSet& contours, const ArrayOf<double>& points, int threads) {
            const std::span<const Vec3> rows = points_of(points);
            std::vector<double> widths = unlocked([&] {
                return half_widths_mm(segmentation, contours, {rows.begin(), rows.end()}, {.threads = threads});
            });
            const auto count = static_cast<py::ssize_t>(widths.size());
            return owning_array(std::move(widths), {count});
        },
        py::arg("segmentation"), py::arg("contours"), py::arg("points"), kThreads);
}

void bind_map(py::module_& m) {
    define(
        m, "uncertainty_map", R"(The half width of the 90 % band at the mask's border.

Parameters
----------
segmentation : Segmentation
contours : ContourSet
    What it was made from.
threads : int
    0: the machine's.

Returns
-------
Image
    float32, mm, at the voxels on both sides of the border; 0 elsewhere, and below three different planes everywhere.
)",
        [](const Segmentation& segmentation, const ContourSet& contours, int threads) {
            return unlocked([&] { return uncertainty_map(segmentation, contours, {.threads = threads}); });
        },
        py::arg("segmentation"), py::arg("contours"), kThreads);
}

}  // namespace

void bind_uncertainty_types(py::module_& m) {
    bind_dice(m);
    bind_uncertainty_type(m);
    bind_suggestion_type(m);
}

void bind_uncertainty(py::module_& m) {
    bind_suggest_planes(m);
    bind_half_widths(m);
    bind_map(m);
}

}  // namespace kontur::python
