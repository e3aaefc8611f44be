# SPDX-License-Identifier: Apache-2.0
"""How sure the surface is, and where to draw next, as Python sees it."""
import pickle

import kontur
import numpy
import pytest


def test_report_says_what_the_command_line_says(kidney):
    u = kidney.report.uncertainty
    told = kidney.report.to_dict()["uncertainty"]
    assert u.is_known and told["known"]
    assert u.planes == told["planes"] == 6
    assert u.dice.value == told["expected_dice"]["value"]
    assert u.volume_low_ml < kidney.report.mask_volume_ml < u.volume_high_ml
    assert "expected Dice" in str(u) and str(u) in repr(u)


def test_band_is_narrow_on_the_lines_and_wide_between_them(case, kidney):
    on_lines = kontur.half_widths_mm(kidney, case.contours, case.contours[0].points)
    everywhere = kontur.half_widths_mm(kidney, case.contours, kidney.mesh.points)
    assert on_lines.max() < numpy.median(everywhere) < everywhere.max()
    two = kontur.ContourSet(list(case.contours)[:2])
    assert len(kontur.half_widths_mm(kontur.segment(two, case.grid), two, kidney.mesh.points)) == 0


def test_map_holds_the_band_at_the_masks_border(case, kidney):
    band = kontur.uncertainty_map(kidney, case.contours)
    assert band.samples.dtype == numpy.float32 and band.samples.shape == kidney.mask.values.shape
    inside = kidney.mask.values > 0
    beside = numpy.zeros_like(inside)
    for axis in range(3):
        steps = numpy.diff(inside, axis=axis)
        for end in (slice(None, -1), slice(1, None)):
            beside[tuple(end if a == axis else slice(None) for a in range(3))] |= steps
    assert ((band.samples > 0) == beside).all()


def test_suggestions_come_in_order_and_skip_what_is_to_be_avoided(case, kidney):
    first, second = kontur.suggest_planes(kidney, case.contours, count=2)
    assert first.after.value == second.before.value
    [other] = kontur.suggest_planes(kidney, case.contours, avoid=[first.plane])
    assert not numpy.allclose(other.plane.normal, first.plane.normal) or not numpy.allclose(other.plane.origin, first.plane.origin)
    [sliced] = kontur.suggest_planes(kidney, case.contours, among="image-slices", grid=case.grid)
    axis, index = sliced.slice
    assert first.slice is None and 0 <= index < case.grid.shape[2 - axis]


def test_what_the_image_knows_counts_less():
    case = kontur.phantom_case("liver_oblique10")
    five = case.contours[:5]
    image = kontur.make_phantom_image(case.grid)
    plain, asked = (kontur.segment(five, case.grid, image=image, use_image=use, mesh=True) for use in ("off", "auto"))
    assert asked.report.image.verdict == "used"
    [without], [with_it] = (kontur.suggest_planes(made, five) for made in (plain, asked))
    assert with_it.before.value > without.before.value + 0.01
    narrow = [numpy.median(kontur.half_widths_mm(made, five, made.mesh.points)) for made in (plain, asked)]
    assert narrow[1] < 0.7 * narrow[0]


def test_a_pickled_segmentation_suggests_the_same(case, kidney):
    copy = pickle.loads(pickle.dumps(kidney))
    ours, theirs = (kontur.suggest_planes(s, case.contours, count=2) for s in (kidney, copy))
    for a, b in zip(ours, theirs):
        assert numpy.array_equal(a.plane.origin, b.plane.origin) and a.gain == b.gain
    assert copy.report.uncertainty.dice.value == kidney.report.uncertainty.dice.value


def test_says_what_is_wrong(case, kidney):
    with pytest.raises(kontur.InvalidInputError, match="0 planes are asked for"):
        kontur.suggest_planes(kidney, case.contours, count=0)
    with pytest.raises(kontur.InvalidInputError, match="there is no image"):
        kontur.suggest_planes(kidney, case.contours, among="image-slices")
    with pytest.raises(kontur.InvalidInputError, match="there is no contour"):
        kontur.suggest_planes(kidney, kontur.ContourSet([]))
