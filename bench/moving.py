#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Dice and volumes of moving bodies at frames in which nothing was drawn. Prints a CSV.

Usage: bench/moving.py [--masks ED ES] [--only BODY,...] [--suggest]

A cycle of 20 frames; nine slices across the body. Some drawings have whole frames, for which the linear interpolation between
3D fits and the nearest frame are the peers; the others are contours spread over the cycle. Bodies: a ball that shrinks and grows
with a heart's pace, one that breathes and is pushed, an ellipsoid that turns, a heart-like shell's inside, and, with --masks,
what is between two real shapes. With --suggest: mean Dice of all frames when four slices are added to whole frames, where and when
`kontur suggest` says, or in random frames. PYTHONPATH has to lead to kontur.
"""
import argparse
import csv
import sys

import numpy as np

import kontur

FRAMES = 20
POINTS = 48


def systole(t):
    """0 at the start of a beat, 1 at its least: 37 % of the cycle, then fast filling, then the atrium's kick."""
    t = t % 1
    if t < .37:
        return np.sin(np.pi / 2 * t / .37) ** 2
    fast, late = (np.sin(np.pi / 2 * np.clip((t - a) / b, 0, 1)) ** 2 for a, b in ((.37, .22), (.82, .18)))
    return 1 - .75 * fast - .25 * late


class Ball:
    slices = np.linspace(-25, 25, 9)

    def values(self, x, t):
        return 30 - 6 * systole(t) - np.linalg.norm(x, axis=-1)

    def middle(self, z, t):
        return np.array([0., 0.])


class Breathing(Ball):
    def values(self, x, t):
        return 30 - 3 * (1 - np.cos(2 * np.pi * t)) - np.linalg.norm(x - [0, 0, 4 * np.sin(2 * np.pi * t)], axis=-1)


class Turning(Ball):
    slices = np.linspace(-20, 20, 9)

    def values(self, x, t):
        angle = .5 * np.sin(2 * np.pi * t) + .2 * np.sin(4 * np.pi * t)
        u, v = np.cos(angle) * x[..., 0] + np.sin(angle) * x[..., 1], np.cos(angle) * x[..., 1] - np.sin(angle) * x[..., 0]
        return 24 * (1 - np.sqrt((u / 40) ** 2 + (v / 24) ** 2 + (x[..., 2] / 25) ** 2))


class Heart(Ball):
    slices = np.linspace(-36, 36, 9)

    def middle(self, z, t):
        return np.array([1.5 * np.sin(2 * np.pi * t) + .002 * z * z, 0])

    def values(self, x, t):
        a = systole(t)
        radius, height = 26 - 8 * a, 45 - 5 * a
        u = x[..., 0] - 1.5 * np.sin(2 * np.pi * t) - .002 * x[..., 2] ** 2
        return radius * (1 - np.sqrt((u / radius) ** 2 + (x[..., 1] / radius / 1.1) ** 2 + (x[..., 2] / height) ** 2))


class Between:
    """Between the functions of two real shapes, by the pace of a heart, with a drift of 1.5 mm. Axes are the grid's."""

    def __init__(self, masks):
        grid = masks[0].grid
        axes = np.array(grid.index_to_mm)[:3, :3]
        drawn = np.where(masks[0].values.any((1, 2)))[0]
        self.axes = axes / np.linalg.norm(axes, axis=0)
        self.origin = axes @ [grid.shape[2] / 2, grid.shape[1] / 2, drawn.mean()] + np.array(grid.index_to_mm)[:3, 3]
        self.slices = (drawn - drawn.mean()) * np.linalg.norm(axes[:, 2])
        self.functions = []
        for mask in masks:
            planes = [kontur.Plane(axes @ [0, 0, k] + np.array(grid.index_to_mm)[:3, 3], self.axes[:, 2])
                      for k in np.where(mask.values.any((1, 2)))[0]]
            self.functions.append(kontur.segment(kontur.trace(mask, planes), grid, use_image="off").function)
        plane = np.stack(np.meshgrid(np.arange(-45, 46, 3.), np.arange(-45, 46, 3.), indexing="ij"), -1).reshape(-1, 2)
        self.middles = []
        for z in self.slices:
            x = np.c_[plane, np.full(len(plane), z)]
            inside = (self.values(x, 0) > 0) & (self.values(x, .37) > 0)
            self.middles.append(plane[inside].mean(0) if inside.any() else np.zeros(2))

    def values(self, x, t):
        drift = 1.5 * np.array([np.sin(2 * np.pi * t), np.cos(2 * np.pi * t), 0])
        at, a = np.ascontiguousarray((x - drift) @ self.axes.T + self.origin), systole(t)
        return (1 - a) * self.functions[0](at) + a * self.functions[1](at)

    def middle(self, z, t):
        return self.middles[int(np.argmin(abs(self.slices - z)))]


def outline(body, z, t):
    """The section of a plane as points on rays from its middle; None where there is none."""
    angles = np.linspace(0, 2 * np.pi, POINTS, endpoint=False)
    middle = np.array([*body.middle(z, t), z])
    rays = np.c_[np.cos(angles), np.sin(angles), 0 * angles]
    if body.values(middle[None], t)[0] <= 0:
        return None
    low, high = np.zeros(POINTS), np.full(POINTS, 90.)
    for _ in range(30):
        half = (low + high) / 2
        inside = body.values(middle + half[:, None] * rays, t) > 0
        low, high = np.where(inside, half, low), np.where(inside, high, half)
    return middle + low[:, None] * rays


def drawings(count):
    """(frame from 0, slice) of each contour; half a slice lies between two."""
    every = range(count)
    five = (0, 4, 7, 10, 15)
    whole = {f"{len(frames)} whole frames": [(f, k) for f in frames for k in every]
             for frames in ((0, 7), (0, 7, 13), five)}
    return whole | {
        "6 slices in each of 2 frames": [(f, k) for f in (0, 7) for k in np.linspace(0, count - 1, 6)],
        "2 whole frames, the middle slice in 4": [(f, k) for f in (0, 7) for k in every] + [(f, count // 2) for f in (3, 10, 13, 16)],
        "3 slices in each of 5 frames": [(f, k) for f in five for k in (0, count // 2, count - 1)],
        "3 other slices in each of 5 frames": [(f, k) for i, f in enumerate(five) for k in sorted({(2 * i + j) % count for j in (0, 3, 6)})],
        "20 single slices": [(f, [0, 8, 4, 2, 6, 1, 7, 3, 5][f % 9] % count) for f in range(FRAMES)],
    }


def other_pairs(count):
    """Two whole frames elsewhere in the cycle: what they do not show is chance."""
    return {f"2 whole frames from frame {first + 1}": [(f, k) for f in (first, (first + 7) % FRAMES) for k in range(count)]
            for first in (4, 8, 12, 16)}


class Case:
    def __init__(self, body):
        self.body = body
        reach = np.abs(body.slices).max() + 15
        self.grid = kontur.grid_around([[-55, -55, -reach], [55, 55, reach]], [2.5, 2.5, 2.5], 0)
        k, j, i = np.indices(self.grid.shape)
        affine = np.array(self.grid.index_to_mm)
        self.centres = np.stack([i, j, k], -1) @ affine[:3, :3].T + affine[:3, 3]
        flat = self.centres.reshape(-1, 3)
        self.truth = [(body.values(flat, f / FRAMES) > 0).reshape(self.grid.shape) for f in range(FRAMES)]

    def contours(self, drawn):
        found = []
        for f, k in drawn:
            z = np.interp(k, range(len(self.body.slices)), self.body.slices)
            points = outline(self.body, z, f / FRAMES)
            if points is not None:
                found.append(kontur.Contour(points, kontur.Plane([0, 0, z], [0, 0, 1]), frame=f + 1))
        return kontur.ContourSet(found, cycle_frames=FRAMES)

    def scores(self, masks, frames):
        """Dice, its least, the volume's mean error and the error of the ejection fraction, in percent."""
        dice, volume = [], []
        for f in frames:
            mask, truth = masks[f], self.truth[f]
            dice.append(2 * (mask & truth).sum() / (mask.sum() + truth.sum()))
            volume.append(100 * abs(mask.sum() / truth.sum() - 1))
        fraction = [1 - min(v) / max(v) for v in ([m.sum() for m in masks], [t.sum() for t in self.truth])]
        return np.mean(dice), min(dice), np.mean(volume), 100 * abs(fraction[0] - fraction[1])


def linear(whole, values, f):
    """Between the two whole frames around f."""
    after = next((g for g in whole if g > f), whole[0])
    before = whole[whole.index(after) - 1]
    share = ((f - before) % FRAMES) / ((after - before) % FRAMES or FRAMES)
    return (1 - share) * values[before] + share * values[after]


def nearest(whole, f):
    return min(whole, key=lambda g: min((f - g) % FRAMES, (g - f) % FRAMES))


def rows_of(name, case):
    count = len(case.body.slices)
    for drawing, drawn in (drawings(count) | other_pairs(count)).items():
        made = kontur.segment_moving(case.contours(drawn), case.grid, range(1, FRAMES + 1), use_image="off")
        at = sorted({f for f, _ in drawn})
        left_out = [f for f in range(FRAMES) if f not in at] or list(range(FRAMES))
        masks = {"kontur": [mask.values.astype(bool) for mask in made.masks]}
        if "whole" in drawing:
            whole = [f for f in at if sum(g == f for g, _ in drawn) == len(case.body.slices)]
            values = {round(m.time) - 1: m.segmentation.function(case.centres) for m in made.moments if round(m.time) - 1 in whole}
            masks["linear"] = [linear(whole, values, f) > 0 for f in range(FRAMES)]
            masks["nearest"] = [values[nearest(whole, f)] > 0 for f in range(FRAMES)]
        for method, its in masks.items():
            scores = case.scores(its, left_out)
            yield [name, drawing, len(drawn), method, *(f"{s:.4f}" for s in scores[:2]), *(f"{s:.2f}" for s in scores[2:])]


def all_frames(case, drawn):
    made = kontur.segment_moving(case.contours(drawn), case.grid, range(1, FRAMES + 1), use_image="off")
    return made, case.scores([mask.values.astype(bool) for mask in made.masks], range(FRAMES))[0]


def suggested(case, drawn, count=4):
    """What was drawn, and slices where and when `suggest_moving` says, one after the other."""
    drawn = list(drawn)
    for _ in range(count):
        for one in kontur.suggest_moving(all_frames(case, drawn)[0], FRAMES):
            k = int(np.argmin(abs(case.body.slices - one.plane.origin[2])))
            if (one.frame, k) not in drawn:
                drawn.append((one.frame, k))
                break
    return drawn


def rows_of_suggestions(name, case, seed=3):
    random, count = np.random.default_rng(seed), len(case.body.slices)
    for drawing, drawn in list(drawings(count).items())[:2]:
        at = {f for f, _ in drawn}
        ways = {"before": [drawn], "suggested": [suggested(case, drawn)], "any slices": [], "middle slices": []}
        for _ in range(3):
            frames = [int(f) for f in random.choice([f for f in range(FRAMES) if f not in at], 4, replace=False)]
            ways["any slices"].append(drawn + [(f, int(random.integers(count))) for f in frames])
            ways["middle slices"].append(drawn + [(f, count // 2) for f in frames])
        for way, its in ways.items():
            yield [name, drawing, way, f"{np.mean([all_frames(case, one)[1] for one in its]):.4f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--masks", nargs=2, metavar=("ED", "ES"))
    parser.add_argument("--only", default="")
    parser.add_argument("--suggest", action="store_true")
    words = parser.parse_args()
    bodies = {"ball": Ball, "breathing": Breathing, "turning": Turning, "heart": Heart}
    if words.masks:
        bodies["ventricle"] = lambda: Between([kontur.read_mask(path) for path in words.masks])
    table = csv.writer(sys.stdout, lineterminator="\n")
    score_names = ["contours", "method", "dice", "least_dice", "volume_error_percent", "ef_error_points"]
    table.writerow(["body", "drawing", *(["four_more", "dice"] if words.suggest else score_names)])
    for name, body in bodies.items():
        if not words.only or name in words.only.split(","):
            for row in (rows_of_suggestions if words.suggest else rows_of)(name, Case(body())):
                table.writerow(row)
                sys.stdout.flush()


if __name__ == "__main__":
    main()
