# SPDX-License-Identifier: Apache-2.0
"""The phantom's organs, and contours where planes cut them."""
import contourpy
import kontur
import numpy as np

STEP_MM = 0.5  # of the lattice on which a section is looked for
SMALLEST_MM2 = 10
CASES = ("liver_orthogonal14", "kidney_radial6", "metastasis_parallel17", "vertebra_parallel11")
SLOPE_STEP_MM = 1e-4


class Organ:
    """A body of the phantom, its mask and the box of the mask's voxels, shape (2, 3), mm."""

    def __init__(self, case):
        drawn = kontur.phantom_case(case)
        self.name, self.body = drawn.body.name, drawn.body
        self.truth = kontur.make_truth_mask(self.body, coarsened(drawn.grid) if self.name == "liver" else drawn.grid)
        inside = np.argwhere(self.truth.values)[:, ::-1]
        affine = self.truth.grid.index_to_mm
        corners = np.array([inside.min(axis=0), inside.max(axis=0)]) @ affine[:3, :3].T + affine[:3, 3]
        self.box = np.sort(corners, axis=0)


def organs():
    """Half the liver's resolution tells the same at an eighth of the time."""
    return [Organ(case) for case in CASES]


def coarsened(grid):
    """The same field of view with voxels of twice the size."""
    affine = grid.index_to_mm.copy()
    affine[:3, 3] += 0.5 * affine[:3, :3].sum(axis=1)
    affine[:3, :3] *= 2
    return kontur.Grid([(n + 1) // 2 for n in grid.size], affine, "LPS")


def signed_area(line):
    x, y = line.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def resampled(line, count):
    """`count` points at equal distances along a closed line, the first half a distance from its first point."""
    closed = np.vstack([line, line[:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    at = (np.arange(count) + 0.5) * along[-1] / count
    return np.column_stack([np.interp(at, along, closed[:, axis]) for axis in range(2)])


def slopes(value, uv):
    """Gradient in the plane, by central differences."""
    steps = SLOPE_STEP_MM * np.eye(2)
    return np.column_stack([(value(uv + step) - value(uv - step)) / (2 * SLOPE_STEP_MM) for step in steps])


def on_surface(value, uv, step_mm=STEP_MM):
    """The places of the surface near points of a plane, by Newton steps in the plane."""
    most = 0.6 * step_mm
    for _ in range(12):
        slope = slopes(value, uv)
        length = np.linalg.norm(slope, axis=1, keepdims=True)
        uv = uv - np.clip(value(uv)[:, None] / np.maximum(length, 1e-9), -most, most) * slope / np.maximum(length, 1e-9)
    return uv


def closed_lines(body, plane, step_mm=STEP_MM, smallest_mm2=SMALLEST_MM2):
    """(line in the plane's coordinates, whether it surrounds a hole) of a body's section; small ones are left out."""
    corners = np.array([[body.bounds[i, 0], body.bounds[j, 1], body.bounds[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    low, high = plane.to_uv(corners).min(axis=0), plane.to_uv(corners).max(axis=0)
    u, v = (np.arange(a, b + step_mm, step_mm) for a, b in zip(low, high))
    uv = np.column_stack([axis.ravel() for axis in np.meshgrid(u, v)])
    values = body.values(plane.from_uv(uv)).reshape(len(v), len(u))
    for line in contourpy.contour_generator(u, v, values).lines(0):
        area = signed_area(line[:-1])
        if abs(area) >= smallest_mm2:
            along = np.diff(line, axis=0)
            aside = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
            left = (line[:-1] + line[1:]) / 2 + 0.1 * step_mm * aside
            inside_is_left = np.mean(body.values(plane.from_uv(left)) > 0) > 0.5
            yield line[:-1], bool((area > 0) != inside_is_left)


def shares(weights, total):
    """Whole numbers proportional to the weights (largest remainders), exact in sum."""
    exact = total * np.array(weights) / sum(weights)
    counts = exact.astype(int)
    counts[np.argsort(counts - exact, kind="stable")[:total - counts.sum()]] += 1
    return counts


def sections(body, planes, point_count, step_mm=STEP_MM, smallest_mm2=SMALLEST_MM2):
    """The ContourSet where planes cut a body: `point_count` points altogether, equally spaced, on the surface."""
    found = [(plane, line, hole) for plane in planes for line, hole in closed_lines(body, plane, step_mm, smallest_mm2)]
    lengths = [np.linalg.norm(np.diff(line, axis=0, append=line[:1]), axis=1).sum() for _, line, _ in found]
    contours = []
    for (plane, line, hole), count in zip(found, shares(lengths, point_count)):
        uv = on_surface(lambda uv, plane=plane: body.values(plane.from_uv(uv)), resampled(line, count), step_mm)
        contours.append(kontur.Contour(plane.from_uv(uv), plane=plane, hole=hole))
    return kontur.ContourSet(contours, name=body.name)
