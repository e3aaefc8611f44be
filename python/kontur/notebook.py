# SPDX-License-Identifier: Apache-2.0
"""What Jupyter shows of results: their key figures and a picture. Gives the classes their `_repr_html_`; has no other use."""
import base64
import html

import numpy

from . import _core

_WIDTH_PX, _HEIGHT_PX = 800, 500
_SLICE_PX = 220


def _figures(rows):
    cell = "<td style='text-align:left; vertical-align:top'>{}</td>"
    return "".join(f"<tr>{cell.format(html.escape(name))}{cell.format(html.escape(str(value)))}</tr>" for name, value in rows)


def _page(value, rows, pixels=None, name=""):
    """A heading, a table, and below it the picture."""
    picture = ""
    if pixels is not None:
        data = base64.b64encode(_core.encode_png(pixels)).decode()
        picture = f"<img alt='' style='max-width:100%' src='data:image/png;base64,{data}'>"
    heading = html.escape(f"{type(value).__name__} {name}".strip())
    return f"<div><strong>{heading}</strong><table>{_figures(rows)}</table>{picture}</div>"


def _numbers(values, unit=""):
    return " x ".join(f"{value:.4g}" for value in values) + unit


def _box_mm(box):
    """Sides of a box; nothing for one without corners, as of no points."""
    sides = box[1] - box[0]
    return _numbers(sides, " mm") if numpy.isfinite(sides).all() and (sides >= 0).all() else "empty"


def _grid_rows(grid):
    return [("size", f"{_numbers(grid.size)} voxels"), ("spacing", _numbers(grid.spacing_mm, " mm")),
            ("extent (LPS)", _box_mm(grid.bounds_mm))]


def _surface(segmentation):
    """Its mesh, or one for the eye: about sixty cells along the object, whatever the grid."""
    if segmentation.mesh is not None:
        return segmentation.mesh
    function = segmentation.function
    points = function.centers * function.frame_scale_mm + function.frame_center_mm
    spacing_mm = max(float((points.max(axis=0) - points.min(axis=0)).max()) / 60, 1e-6)
    return _core._stages.preview_surface(function, points, spacing_mm=spacing_mm)


def _picture(mesh, contours, image=None):
    return _core.make_picture(mesh, contours, image, width_px=_WIDTH_PX, height_px=_HEIGHT_PX)


def _report_rows(report):
    rows = [
        ("volume", f"{report.mask_volume_ml:.4g} ml in {report.mask_voxels} voxels, {report.mask_components} component(s)"),
        ("drawn", f"{report.contours} contours, {report.points} points"),
        ("residual", f"{report.residual.max_mm:.3g} mm (max), {report.residual.rms_mm:.3g} mm (rms)"),
    ]
    if report.crossings:
        agreement = _core._stages.disagreement(report.crossings)
        rows.append(("disagreement", f"{agreement.max_mm:.3g} mm (max), {agreement.rms_mm:.3g} mm (rms) at {agreement.matched} crossings"))
    rows.append(("time", f"{sum(report.seconds.values()):.2f} s"))
    return rows + [("warning", warning) for warning in report.warnings]


def _report_html(report):
    return _page(report, _report_rows(report))


def _segmentation_html(segmentation):
    mesh = _surface(segmentation)
    return _page(segmentation, _report_rows(segmentation.report), _picture(mesh, _core.ContourSet([], "segmentation")))


def _contours_html(contours):
    rows = [("contours", len(contours)), ("points", contours.point_count), ("extent (LPS)", _box_mm(contours.bounding_box))]
    return _page(contours, rows, _picture(None, contours), contours.name)


def _mesh_html(mesh):
    shape = _core.topology(mesh)
    rows = [("triangles", len(mesh.triangles)), ("points", len(mesh.points))]
    if shape.closed and shape.oriented:
        rows.append(("volume", f"{_core.signed_volume_mm3(mesh) / 1000:.4g} ml"))
    else:
        rows.append(("surface", "not closed"))
    return _page(mesh, rows, _picture(mesh, _core.ContourSet([], "mesh")))


def _grid_html(grid):
    return _page(grid, _grid_rows(grid))


def _screen_planes(centre):
    """Axial, coronal and sagittal as radiologists see them: the patient's right on the left, the head above."""
    for right, down in (((1, 0, 0), (0, 1, 0)), ((1, 0, 0), (0, 0, -1)), ((0, 1, 0), (0, 0, -1))):
        yield _core.Plane(centre, numpy.cross(right, down), u=right, v=down)


def _slices(image, centre, window):
    """Three slices through a point beside each other, with the whole grid in each of them."""
    corners = image.grid.bounds_mm
    reach_mm = 2 * numpy.abs(corners - centre).max()
    low, span = window[0] - window[1] / 2, max(window[1], 1e-30)
    gray = []
    for plane in _screen_planes(centre):
        values = _core.reslice(image, plane, _SLICE_PX, _SLICE_PX, reach_mm / _SLICE_PX, outside=numpy.nan)
        gray.append(numpy.nan_to_num(numpy.clip((values - low) / span, 0, 1), nan=0))
    return numpy.repeat((255 * numpy.hstack(gray)[:, :, None]).round().astype("uint8"), 3, axis=2)


def _image_html(image):
    samples = image.samples
    finite = samples[numpy.isfinite(samples)]
    values = f"{finite.min():g} to {finite.max():g}" if finite.size else "none"
    rows = _grid_rows(image.grid) + [("values", f"{samples.dtype}, {values}")]
    window = _core.suggest_window(image) if finite.size else (0, 1)
    return _page(image, rows, _slices(image, image.grid.bounds_mm.mean(axis=0), window))


def _middle_mm(mask):
    """Of the box about the voxels inside, or of the grid when there are none."""
    inside = [numpy.flatnonzero(mask.values.any(axis=axes)) for axes in ((0, 1), (0, 2), (1, 2))]
    if not inside[0].size:
        return mask.grid.bounds_mm.mean(axis=0)
    index = [(numbers[0] + numbers[-1]) / 2 for numbers in inside]
    return (mask.grid.index_to_mm @ [*index, 1])[:3]


def _mask_html(mask):
    rows = _grid_rows(mask.grid) + [("volume", f"{mask.volume_ml:.4g} ml")]
    return _page(mask, rows, _slices(_core.Image(mask.values, mask.grid), _middle_mm(mask), (0.5, 1)))


def _install():
    for kind, show in {
        _core.Grid: _grid_html,
        _core.Image: _image_html,
        _core.Mask: _mask_html,
        _core.Segmentation: _segmentation_html,
        _core.SegmentReport: _report_html,
        _core.ContourSet: _contours_html,
        _core.TriangleMesh: _mesh_html,
    }.items():
        kind._repr_html_ = show


_install()
