#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How often the section check speaks of right results, and how many faults it names.

Usage: bench/drawing_check.py DRAWING.json ... [--faults N] [--seed N]     (PYTHONPATH: the package)

Each drawing is segmented and checked. Then N faults are put into its result, one at a time, each of about a tenth of a section: a
hole at a line, a ball beside it, and of every third an island in the plane, off its lines and in the ball of all that was drawn.
Prints JSON: for each drawing the sentences about its result, and of the faults and of the islands those that a plane names.
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


def island(plane, function, ball, radius, random):
    """A place of the plane that is a radius and more from what the result has there; none found: None."""
    middle, reach = ball
    off = (middle - plane.origin) @ plane.normal
    foot, across = middle - off * plane.normal, np.sqrt(max(reach**2 - off**2, 0))
    places = foot + across * (random.uniform(-1, 1, (200, 2)) @ np.array([plane.u, plane.v]))
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    around = [radius * part * (np.cos(a) * plane.u + np.sin(a) * plane.v) for a in angles for part in (0, 0.5, 1, 1.3)]
    for place in places[np.linalg.norm(places - foot, axis=1) < across]:
        if np.max(function.values(place + np.array(around), threads=1)) < 0:
            return place
    return None


def fault(contours, check, function, random, apart):
    """(middle, radius, sign): a ball that is cut out (-1) or added (+1) in one of the drawn planes, or added apart from all that is
    there."""
    drawn = [plane for plane in check.planes if plane.contour is not None]
    plane = drawn[random.integers(len(drawn))]
    radius = np.sqrt(0.1 * plane.area_mm2 / np.pi)
    if apart:
        points = np.vstack([contour.points for contour in contours.contours])
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        place = island(plane.plane, function, (middle, np.linalg.norm(points - middle, axis=1).max()), radius, random)
        return None if place is None else (place, radius, 1)
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
    found = {False: [], True: []}
    whole = kontur.check_sections(contours, made.function)
    for number in range(faults):
        put = fault(contours, whole, made.function, random, number % 3 == 2)
        if put:
            found[number % 3 == 2].append(named(whole, kontur.check_sections(contours, with_fault(made.function, *put))))
    return {"drawing": str(path), "sentences": check.sentences, "faults": len(found[False]), "named": int(sum(found[False])),
            "islands": len(found[True]), "named_islands": int(sum(found[True])), "check_s": seconds["check"], "total_s": sum(seconds.values())}


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
             **{key: sum(row[key] for row in rows) for key in ("faults", "named", "islands", "named_islands")},
             "check_share": sum(row["check_s"] for row in rows) / sum(row["total_s"] for row in rows)}
    print(json.dumps(total))


if __name__ == "__main__":
    main()
