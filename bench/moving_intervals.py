#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How often the intervals of volumes and ejection fractions hold the truth. Prints a CSV, one row for each drawing and sort of frame.

Usage: bench/moving_intervals.py [--band] [BODIES [SEED]]

Four bodies of bench/moving.py, and made-up ellipsoids, which shrink by a heart's pace or another one, drift, turn and bend. The
drawings are those of bench/moving.py. Frames are whole, carried (some of their sections are), between such, or a cycle: its
ejection fraction. With --band: how much of the surface lies within its 90 % band, and half of its width in mm. PYTHONPATH has to
lead to kontur.
"""
import collections
import csv
import sys

import numpy as np

import kontur
import moving


class Ellipsoid(moving.Ball):
    def __init__(self, random):
        self.axes = random.uniform(22, 40, 3)
        self.least = random.uniform(.04, .25)
        self.drift = random.uniform(-4, 4, 3) * random.integers(0, 2)
        self.turn = random.uniform(0, .4) * random.integers(0, 2)
        self.phases = random.uniform(0, 2 * np.pi, 3)
        self.heights = random.uniform(-1, 1, 3) / [1, 2.5, 5]
        self.is_heart = random.integers(0, 2) == 0
        self.bend = random.uniform(-.004, .004)
        reach = self.axes[2] * (1 - self.least) * .88
        self.slices = np.linspace(-reach, reach, 9)
        paces = [self.pace(n / 200) for n in range(200)]
        self.low, self.high = min(paces), max(paces)

    def pace(self, t):
        if self.is_heart:
            return moving.systole(t)
        return sum(self.heights[k] * np.sin(2 * np.pi * (k + 1) * t + self.phases[k]) for k in range(3))

    def centre(self, t):
        return self.drift * [np.sin(2 * np.pi * t), np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)]

    def middle(self, z, t):
        return self.centre(t)[:2] + [self.bend * z * z, 0]

    def values(self, x, t):
        part = (self.pace(t % 1) - self.low) / (self.high - self.low)
        away, angle = x - self.centre(t), self.turn * np.sin(2 * np.pi * t)
        bent = away[..., 0] - self.bend * x[..., 2] ** 2
        u, v = np.cos(angle) * bent + np.sin(angle) * away[..., 1], np.cos(angle) * away[..., 1] - np.sin(angle) * bent
        a, b, c = self.axes * [1 - self.least * part, 1 - self.least * part, 1 - .5 * self.least * part]
        return self.axes[0] * (1 - np.sqrt((u / a) ** 2 + (v / b) ** 2 + (away[..., 2] / c) ** 2))


def sorts(made):
    """Of each frame, from the moments around it."""
    at = {round(moment.time): moment.carried > 0 for moment in made.moments}
    for frame in range(1, moving.FRAMES + 1):
        if frame in at:
            yield "carried" if at[frame] else "whole"
        else:
            around = [max((t for t in at if t < frame), default=max(at)), min((t for t in at if t > frame), default=min(at))]
            yield "between, carried" if any(at[t] for t in around) else "between whole"


def away_mm(body, points, t, step=.25):
    """How far points are from the true surface, by its function and its slope."""
    slopes = [(body.values(points + step * axis, t) - body.values(points - step * axis, t)) / (2 * step) for axis in np.eye(3)]
    return abs(body.values(points, t)) / np.linalg.norm(slopes, axis=0)


def bands(body, case, drawn):
    """Of each frame its sort, how much of the surface lies within the band, and half of its mean width."""
    made = kontur.segment_moving(case.contours(drawn), case.grid, range(1, moving.FRAMES + 1), use_image="off", mesh=True)
    for frame, sort in enumerate(sorts(made)):
        points = made.meshes[frame].points[::20]
        widths = kontur.moving_half_widths_mm(made, points, frame + 1)
        if len(widths):
            yield sort, np.mean(away_mm(body, points, frame / moving.FRAMES) <= widths), np.mean(widths)


def main():
    words = [word for word in sys.argv[1:] if word != "--band"]
    count, seed = (int(word) for word in [*words, *["24", "1"][len(words):]])
    random = np.random.default_rng(seed)
    bodies = [moving.Ball(), moving.Breathing(), moving.Turning(), moving.Heart()][:count]
    bodies += [Ellipsoid(random) for _ in range(count - len(bodies))]
    found = collections.defaultdict(list)
    for body in bodies:
        case = moving.Case(body)
        truth = [mask.sum() * case.grid.voxel_volume_mm3 / 1000 for mask in case.truth]
        for drawing, drawn in moving.drawings(len(body.slices)).items():
            if "--band" in sys.argv:
                for sort, held, width in bands(body, case, drawn):
                    found[drawing, sort].append((held, width))
                continue
            made = kontur.segment_moving(case.contours(drawn), case.grid, range(1, moving.FRAMES + 1), use_image="off")
            curve = made.volumes
            if not curve.intervals:
                continue
            for sort, ml, one, volume in zip(sorts(made), truth, curve.intervals, curve.volumes_ml):
                found[drawing, sort].append((one.low_ml <= ml <= one.high_ml, (one.high_ml - one.low_ml) / volume))
            low, high = curve.ejection_interval
            found[drawing, "ejection fraction"].append((low <= 1 - min(truth) / max(truth) <= high, high - low))
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["drawing", "frames", "count", "held", "mean_width"])
    for (drawing, sort), rows in found.items():
        held, width = np.mean(rows, axis=0)
        table.writerow([drawing, sort, len(rows), f"{held:.3f}", f"{width:.3f}"])


if __name__ == "__main__":
    main()
