#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How often the section check speaks of right results, and how many faults it names.

Usage: bench/drawing_check.py DRAWING.json ... [--faults N] [--seed N]     (PYTHONPATH: the package)

Each drawing is segmented and checked. Then N faults are put into its result, one at a time: a hole in a drawn plane, or a ball
beside a section, each of about a tenth of the section. Prints JSON: for each drawing the sentences about its result, and of the
faults those that a plane names.
"""
import argparse
import json

import numpy as np

import kontur


def own_grid(contours, voxels=48):
    low, high = np.asarray(contours.bounding_box)
    margin = 0.3 * (high - low).max()
    step = (high - low).max() / voxels
    size = np.ceil((high - low + 2 * margin) / step).astype(int) + 1
    return kontur.Grid.from_spacing([int(n) for n in size], [float(step)] * 3, [float(x) for x in low - margin])


def fault(contours, check, random):
    """(middle, radius, sign): a ball that is cut out (-1) or added (+1) in one of the drawn planes."""
    drawn = [plane for plane in check.planes if plane.contour is not None]
    plane = drawn[random.integers(len(drawn))]
    radius = np.sqrt(0.1 * plane.area_mm2 / np.pi)
    contour = contours.contours[plane.contour]
    middle = contour.points.mean(axis=0)
    at = contour.points[random.integers(len(contour.points))]
    way = (at - middle) / max(np.linalg.norm(at - middle), 1e-9)
    sign = random.choice([-1, 1])
    return at + sign * radius * way, radius, sign


def with_fault(function, middle, radius, sign):
    def values(points):
        ball = radius - np.linalg.norm(points - middle, axis=1)
        f = np.asarray(function.values(points, threads=1))
        return np.maximum(f, ball) if sign > 0 else np.minimum(f, -ball)

    return values


def named(before, after):
    """Whether a plane that is named is wrong by 2 % of its section more than without the fault."""
    return any(b.is_wrong and b.wrong_share > a.wrong_share + 0.02 for a, b in zip(before.planes, after.planes))


def measure(path, faults, random):
    contours = kontur.read_contours(path)
    made = kontur.segment(contours, own_grid(contours), threads=1)
    check = made.report.section_check
    seconds = made.report.seconds
    found = []
    whole = kontur.check_sections(contours, made.function)
    for _ in range(faults):
        put = fault(contours, whole, random)
        found.append(named(whole, kontur.check_sections(contours, with_fault(made.function, *put))))
    return {"drawing": str(path), "sentences": check.sentences, "faults": len(found), "named": int(sum(found)),
            "check_s": seconds["check"], "total_s": sum(seconds.values())}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", nargs="+")
    parser.add_argument("--faults", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    rows = []
    for path in options.drawings:
        rows.append(measure(path, options.faults, random))
        print(json.dumps(rows[-1]), flush=True)
    total = {"drawings": len(rows), "with_sentences": sum(bool(row["sentences"]) for row in rows),
             "faults": sum(row["faults"] for row in rows), "named": sum(row["named"] for row in rows),
             "check_share": sum(row["check_s"] for row in rows) / sum(row["total_s"] for row in rows)}
    print(json.dumps(total))


if __name__ == "__main__":
    main()
