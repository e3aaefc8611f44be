# SPDX-License-Identifier: Apache-2.0
"""Closed contours as hands draw them: each hand is a function of a contour's points, its plane, the size of a voxel and a
random generator, so the same generator gives the same drawing.

wave: the contour moves along its normal by long waves, 1 to 5 around it, as where a hand follows a blurred edge.
jitter: every point moves by itself, both along and across the contour, smoothed over a few millimetres, as a hand trembles.
coarse: few vertices, unevenly spaced, at half voxels, as by clicking a polygon on an enlarged pixel grid.
"""
import numpy as np

WAVE_MM, WAVE_HARMONICS = 0.55, 5
JITTER_MM, JITTER_STEP_MM, JITTER_LENGTH_MM = 0.4, 0.5, 2.0
COARSE_STEP_MM, COARSE_STEP_VOXELS, COARSE_LEAST, COARSE_DROPPED = 6.0, 4.0, 6, 0.25


def axes_of(plane):
    return np.array([plane["u"], plane["v"]])


def side_lengths(points):
    return np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)


def bounded_mm(rms, perimeter):
    """A tiny contour displaced by as much as a large one would cross itself."""
    return min(rms, perimeter / 40)


def resampled(points, count):
    """Evenly along the closed contour, from its first point."""
    closed = np.vstack([points, points[:1]])
    along = np.r_[0, np.cumsum(side_lengths(points))]
    at = np.arange(count) * along[-1] / count
    return np.column_stack([np.interp(at, along, closed[:, axis]) for axis in range(points.shape[1])])


def wave(points, plane, voxel, random):
    tangents = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    outward = np.cross(tangents, plane["normal"])
    outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-12)
    lengths = side_lengths(points)
    around = 2 * np.pi * np.r_[0, np.cumsum(lengths)[:-1]] / lengths.sum()
    waves = np.arange(1, WAVE_HARMONICS + 1)
    rms = bounded_mm(WAVE_MM, lengths.sum()) / np.sqrt((1 / waves).sum())
    heights = random.normal(size=(2, len(waves))) * rms / np.sqrt(waves)
    phases = np.outer(around, waves)
    return points + (np.cos(phases) @ heights[0] + np.sin(phases) @ heights[1])[:, None] * outward


def smoothed(noise, width):
    """Around the contour, by a Gaussian of `width` samples. The expected variance is 1 again, not that of this contour: some
    hands tremble more than others."""
    count = len(noise)
    distance = np.minimum(np.arange(count), count - np.arange(count))
    weights = np.exp(-0.5 * (distance / width) ** 2)
    low = np.fft.ifft(np.fft.fft(noise, axis=0) * np.fft.fft(weights)[:, None], axis=0).real
    return low / np.sqrt((weights**2).sum())


def jitter(points, plane, voxel, random):
    perimeter = side_lengths(points).sum()
    even = resampled(points, max(8, round(perimeter / JITTER_STEP_MM)))
    noise = smoothed(random.normal(size=(len(even), 2)), JITTER_LENGTH_MM / JITTER_STEP_MM)
    return even + bounded_mm(JITTER_MM, perimeter) * noise @ axes_of(plane)


def coarse(points, plane, voxel, random):
    perimeter = side_lengths(points).sum()
    step = max(COARSE_STEP_MM, COARSE_STEP_VOXELS * voxel)
    count = max(COARSE_LEAST, round(perimeter / step))
    start = random.integers(len(points))
    even = resampled(np.roll(points, -start, axis=0), count)
    kept = random.random(count) >= COARSE_DROPPED
    kept[np.argsort(random.random(count))[:COARSE_LEAST]] = True
    origin, axes = np.array(plane["origin"]), axes_of(plane)
    snapped = np.rint((even[kept] - origin) @ axes.T / (voxel / 2)) * (voxel / 2) @ axes + origin
    moved = (np.abs(snapped - np.roll(snapped, 1, axis=0)) > 1e-9).any(axis=1)
    return snapped[moved] if moved.sum() >= 3 else points


HANDS = {"wave": wave, "jitter": jitter, "coarse": coarse}


def by_hand(drawing, hand, voxel, random):
    """The same drawing by a hand. What `kontur trace` said of its origin is no longer the whole of it."""
    drawing = {key: value for key, value in drawing.items() if key != "provenance"}
    planes = []
    for plane in drawing["planes"]:
        contours = [contour | {"points": HANDS[hand](np.array(contour["points"]), plane, voxel, random).tolist()}
                    for contour in plane["contours"]]
        planes.append(plane | {"contours": contours})
    return drawing | {"planes": planes}
