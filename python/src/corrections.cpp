// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include "bindings.h"
#include "fields.h"
#include "kontur/correct/put_label.h"
#include "kontur/correct/suggest_to_look_at.h"
#include "kontur/correct_mask.h"
#include "run.h"
#include "segment_words.h"

namespace kontur::python {

template <>
struct Words<CorrectionKind> {
    static constexpr std::array values{CorrectionKind::outline, CorrectionKind::piece, CorrectionKind::empty,
                                       CorrectionKind::confirmed};
};

namespace {

Keywords<CorrectOptions> correct_keywords() {
    return Keywords<CorrectOptions>()
        .field("reach", &CorrectOptions::reach,
               "How far a correction is carried on, of the length that follows from the mask; from 0.25 to 4.")
        .field("drop_loose", &CorrectOptions::drop_loose, "Take away the pieces that a correction cuts off.");
}

void bind_report(py::module_& m) {
    py::class_<CorrectedPlane> plane(m, "CorrectedPlane", "A plane that was corrected, or looked at and found right.");
    Fields(plane)
        .field("kind", &CorrectedPlane::kind, "str: 'outline', 'piece', 'empty' or 'confirmed'.")
        .field("plane", &CorrectedPlane::plane, "Plane")
        .field("contours", &CorrectedPlane::contours, "list of int: indices of those drawn in it.")
        .field("largest_move_mm", &CorrectedPlane::largest_move_mm, "float: of the mask's surface, along the drawn line.")
        .picklable();
    py::class_<LoosePiece> piece(m, "LoosePiece", "Voxels that a correction cut off from a larger part.");
    Fields(piece)
        .field("voxels", &LoosePiece::voxels, "int")
        .field("volume_ml", &LoosePiece::volume_ml, "float")
        .field("position", &LoosePiece::position, "ndarray, shape (3,): mm, the centre of one of them.")
        .picklable();
    py::class_<ImageReach> image(m, "ImageReach", "How much the image had to do with how far corrections are carried.");
    Fields(image)
        .field("weight", &ImageReach::weight, "float: up to 0.8. Not followed up to 0.5.")
        .field("planes", &ImageReach::planes, "int: left out, one after another; 0 where fewer than three were looked at.")
        .field("wrong_without", &ImageReach::wrong_without, "int: voxels in them.")
        .field("wrong_with", &ImageReach::wrong_with, "int")
        .picklable();
    image.def("__str__", [](const ImageReach& r) { return sentence(r); });
    py::class_<CorrectReport> report(m, "CorrectReport", "What `correct` did.");
    Fields(report)
        .field("length_mm", &CorrectReport::length_mm, "float: over which errors of the mask are taken as alike.")
        .field("reach_mm", &CorrectReport::reach_mm, "float: beyond, nothing changes.")
        .field("planes", &CorrectReport::planes, "list of CorrectedPlane")
        .field("added_drawn", &CorrectReport::added_drawn, "int: voxels, in drawn planes.")
        .field("removed_drawn", &CorrectReport::removed_drawn, "int")
        .field("added_carried", &CorrectReport::added_carried, "int: voxels, beside them.")
        .field("removed_carried", &CorrectReport::removed_carried, "int")
        .field("added_image", &CorrectReport::added_image, "int: voxels that the image decided.")
        .field("removed_image", &CorrectReport::removed_image, "int")
        .field("image", &CorrectReport::image, "ImageReach or None: None without an image.")
        .field("volume_before_ml", &CorrectReport::volume_before_ml, "float")
        .field("volume_ml", &CorrectReport::volume_ml, "float")
        .field("dice", &CorrectReport::dice, "float: of the mask before and after.")
        .field("loose_pieces", &CorrectReport::loose_pieces, "list of LoosePiece: largest first.")
        .field("dropped_loose", &CorrectReport::dropped_loose, "bool: they were taken away.")
        .field("warnings", &CorrectReport::warnings, "list of str: one sentence each.")
        .picklable();
    report.def("__str__", [](const CorrectReport& r) { return sentence(r); });
}

void bind_suggest_to_look_at(py::module_& m) {
    py::class_<PlaneToLookAt> type(m, "PlaneToLookAt", "A plane in which a mask's border is unlike the image.");
    type.def_readonly("plane", &PlaneToLookAt::plane, "Plane: its origin lies amid what is doubtful there.");
    type.def_property_readonly(
        "slice",
        [](const PlaneToLookAt& self) -> py::object {
            if (!self.slice) return py::none();
            return py::make_tuple(self.slice->axis, self.slice->index);
        },
        "(int, int), or None: axis (0, 1, 2 for i, j, k) and index of the mask's slice, if it is one.");
    type.def_readonly("doubtful_mm2", &PlaneToLookAt::doubtful_mm2,
                      "float: expected area on the wrong side, by the image alone.");
    type.def("__repr__", [](const PlaneToLookAt& s) {
        return py::str("<PlaneToLookAt through {}, across {}>").format(py::cast(s.plane.origin), py::cast(s.plane.normal));
    });
    define(
        m, "suggest_to_look_at", R"(Which planes of a mask to look at next.

Those in which most voxels near the mask's border look like its other side. A hint: where a whole part is wrong, its border
looks like any other, so a leak or a missing pole is missed.

Parameters
----------
mask : Mask
    Not empty.
image : Image
    That was segmented.
count : int
    Best first, each as if those before it had been looked at.
among : {'any', 'image-slices'}
    Planes of any direction, or slices of the mask only.
seen : sequence of Plane
    Looked at already: what lies near them counts less.
threads : int
    0: the machine's.

Returns
-------
list of PlaneToLookAt
    Fewer than `count` where nothing is doubtful any more.

Examples
--------
>>> z, y, x = np.mgrid[:41, :40, :40]
>>> ball = (z - 20) ** 2 + (y - 20) ** 2 + (x - 20) ** 2 < 12**2
>>> bitten = ball & ~((x > 27) & (abs(z - 9) < 6))
>>> grid = kontur.Grid((40, 40, 41), np.eye(4), frame="LPS")
>>> image = kontur.Image(np.float32(100 * ball), grid)
>>> [plane] = kontur.suggest_to_look_at(kontur.Mask(bitten, grid), image, among="image-slices")
>>> plane.doubtful_mm2 > 0
True
)",
        [](const Mask& mask, const Image& image, std::int64_t count, PlaneChoice among, const std::vector<Plane>& seen,
           int threads) {
            if (count < 1)
                throw Error(ErrorKind::invalid_input, std::to_string(count) + " planes are asked for; at least 1 is needed");
            return unlocked([&] {
                const Work work{.threads = threads};
                return suggest_to_look_at(ExistingSurface(mask, work), image, static_cast<std::size_t>(count), {among, seen},
                                          work);
            });
        },
        py::arg("mask"), py::arg("image"), py::arg("count") = 1, py::arg("among") = PlaneChoice::any,
        py::arg("seen") = py::tuple(), kThreads);
}

void bind_put_label(py::module_& m) {
    define(
        m, "put_label", R"(Puts a corrected label into its label map.

Its new voxels get it, whosever they were, and those that it left become 0. All others keep their values.

Parameters
----------
labels : Image
    Of integers.
label : int
mask : Mask
    The label's voxels before, as `correct` got them.
corrected : Mask
    And after, on the same grid.
shared_borders : bool
    A label that touched this one follows where it retreats.
threads : int
    0: the machine's.

Returns
-------
Image

Raises
------
InvalidInputError
    For masks of another grid than the map's, and a label that its values have no room for.

Examples
--------
>>> values = np.zeros((6, 20, 20), np.uint8)
>>> values[:, :, :9], values[:, :, 9:15] = 1, 2
>>> labels = kontur.Image(values, kontur.Grid((20, 20, 6), np.eye(4), frame="LPS"))
>>> mask = kontur.Mask(values == 1, labels.grid)
>>> smaller = kontur.Mask((values == 1) & (np.arange(20) < 7), labels.grid)
>>> [int((kontur.put_label(labels, 1, mask, smaller, shared).samples == 2).sum()) for shared in (False, True)]
[720, 960]
)",
        [](const Image& labels, std::int64_t label, const Mask& mask, const Mask& corrected, bool shared_borders,
           int threads) {
            return unlocked([&] {
                return put_label(labels, {label, mask, corrected}, shared_borders, {.threads = threads}).labels;
            });
        },
        py::arg("labels"), py::arg("label"), py::arg("mask"), py::arg("corrected"), py::arg("shared_borders") = false,
        kThreads);
}

}  // namespace

void bind_corrections(py::module_& m) {
    bind_report(m);
    bind_put_label(m);
    bind_suggest_to_look_at(m);
    py::class_<CorrectedMask> corrected(m, "CorrectedMask",
                                        "A corrected mask, and how its voxels came to be what they are.");
    Fields(corrected).field("mask", &CorrectedMask::mask, "Mask").field("report", &CorrectedMask::report, "CorrectReport");
    corrected.def_property_readonly(
        "origin",
        [](const py::object& self) {
            const auto& c = self.cast<const CorrectedMask&>();
            return array_view(c.origin.data(), array_shape(c.mask.grid), self);
        },
        "ndarray of uint8, shape (z, y, x): 0 outside and 1 inside as before, 2 added and 3 removed in drawn planes, 4 "
        "added "
        "and 5 removed beside them, 6 added and 7 removed by the image.");
    const auto keywords = correct_keywords();
    define(
        m, "correct", R"(Corrects a mask by what was drawn in some planes of any orientation.

The change is carried on to both sides of each plane, over about half the radius of the largest ball in the mask. All
voxels farther away stay as they are, and all of them where the corrections repeat the mask.

Parameters
----------
mask : Mask
    Not empty.
corrections : ContourSet
    Closed contours are the whole outline in their plane. An open contour replaces the piece of the outline between its ends,
    the shorter way round. Interior and exterior points lie inside and outside. In empty planes there is nothing.
confirmed : sequence of Plane
    Planes that were looked at, and in which the mask is right.
image : Image, optional
    Decides how far corrections are carried, up to 2.5 times as far as without it. It is asked from three planes on, and
    believed as far as it helps in planes left out.
@threads
@progress
@options

Returns
-------
CorrectedMask

Raises
------
InvalidInputError
    For an empty mask and corrections that cannot be understood.
CancelledError

Examples
--------
>>> z, y, x = np.mgrid[:41, :40, :40]
>>> ball = (z - 20) ** 2 + (y - 20) ** 2 + (x - 20) ** 2 < 15**2
>>> bitten = ball & ~((x > 27) & (abs(z - 20) < 6))
>>> grid = kontur.Grid((40, 40, 41), np.eye(4), frame="LPS")
>>> right = kontur.trace(kontur.Mask(ball, grid), [kontur.Plane([0, 0, 20], [0, 0, 1])])
>>> corrected = kontur.correct(kontur.Mask(bitten, grid), right)
>>> before, after = (2 * (a & ball).sum() / (a.sum() + ball.sum()) for a in (bitten, corrected.mask.values != 0))
>>> bool(after - before > 0.015)
True
)",
        [keywords](const Mask& mask, const ContourSet& corrections, const std::vector<Plane>& confirmed, const Image* image,
                   int threads, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const CorrectOptions options = keywords.parse("correct", given);
            return run({progress, stop, threads}, [&](const Work& work) {
                return correct({mask, ExistingSurface(mask, work), image}, {corrections, confirmed}, options, work);
            });
        },
        py::arg("mask"), py::arg("corrections"), py::kw_only(), py::arg("confirmed") = std::vector<Plane>{},
        py::arg("image") = py::none(), kThreads, kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
