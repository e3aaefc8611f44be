#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A hunt for silent faults: random solids of many kinds in drawings of many kinds, against the exact truth.

Usage: PYTHONPATH=build/release/python bench/hunt.py COUNT [--seed N] [--only NUMBER ...] > FILE

One row for each drawing, as bench/shapes.py's; a summary and the silent faults go to stderr. A drawing is at fault where a drawn
section is wrong by more than a tenth of it or the volume by more than half. It is silent where neither the section check nor the
warnings say anything. Solids: the ten of solids.py and `SOLIDS`. Drawings: `WAYS`. With `--only` rows of some numbers are made again.
"""
import argparse
import csv
import dataclasses
import sys

import kontur
import numpy as np
from scipy import spatial

import shapes
import solids
from solids import ball, box, capsule, common, union

SMALL_MM, LARGE_MM = 0.05, 5e4
FAR_MM = 1e4
ODD = (0.8, 1.25)  # scales of the odd slice
VOLUME = 1.5  # times the truth
FIELDS = ["number", *shapes.FIELDS]


def pair(random):
    """Two ellipsoids beside each other."""
    first, second = random.uniform(0.12, 0.22, (2, 3))
    apart = (first[0] + second[0]) * random.uniform(1.05, 1.5) / 2
    return lambda p: union(*(ball((p - (side * apart, 0, 0)) / half, 0, 1) * half.min()
                             for side, half in ((-1, first), (1, second))))


def tower(random):
    """Two balls one above the other."""
    radii = random.uniform(0.12, 0.22, 2)
    gap = random.uniform(0.05, 0.3)
    low, high = -gap / 2 - radii[0], gap / 2 + radii[1]
    return lambda p: union(ball(p, (0, 0, low), radii[0]), ball(p, (0, 0, high), radii[1]))


def branches(random):
    thick, spread = random.uniform(0.06, 0.12), random.uniform(0.15, 0.4)
    return lambda p: union(capsule(p, (0, 0, -0.4), (0, 0, -0.05), thick), capsule(p, (0, 0, -0.05), (-spread, 0, 0.4), 0.8 * thick),
                           capsule(p, (0, 0, -0.05), (spread, 0.1, 0.4), 0.7 * thick))


def cylinder(random):
    radius, half = random.uniform(0.15, 0.5), random.uniform(0.05, 0.5)
    return lambda p: common(radius - np.hypot(p[:, 0], p[:, 1]), half - np.abs(p[:, 2]))


def cone(random):
    slope = random.uniform(0.2, 0.5)
    return lambda p: common((slope * (0.5 - p[:, 2]) - np.hypot(p[:, 0], p[:, 1])) / np.hypot(1, slope), p[:, 2] + 0.45)


def egg(random):
    half = random.uniform(0.15, 0.5, 3)
    return lambda p: ball(p / half, 0, 1) * half.min()


def dumbbell(random):
    radius, neck = random.uniform(0.12, 0.2), random.uniform(0.03, 0.08)
    return lambda p: union(ball(p, (0, 0, -0.3), radius), ball(p, (0, 0, 0.3), radius), capsule(p, (0, 0, -0.3), (0, 0, 0.3), neck))


def pipe(random):
    outer = random.uniform(0.2, 0.4)
    inner, half = outer * random.uniform(0.5, 0.9), random.uniform(0.15, 0.5)
    def values(p):
        away = np.hypot(p[:, 0], p[:, 1])
        return common(outer - away, away - inner, half - np.abs(p[:, 2]))
    return values


def cross(random):
    half = random.uniform(0.06, 0.14)
    return lambda p: union(box(p, (0.5, half, half)), box(p, (half, 0.5, half)), box(p, (half, half, 0.5)))


def bean(random):
    bend = random.uniform(0.5, 1.5)
    def values(p):
        bent = p.copy()
        bent[:, 1] = p[:, 1] - bend * (p[:, 0]**2 - 0.06)
        return ball(bent / (0.45, 0.2, 0.25), 0, 1) * 0.2 / np.sqrt(1 + bend)
    return values


def spiral(random):
    """A plate rolled up, a turn and a half of it."""
    thick, turns = random.uniform(0.03, 0.06), random.uniform(1.2, 1.6)
    angle = np.linspace(0, 2 * np.pi * turns, 400)
    line = (0.1 + 0.35 * angle / angle[-1])[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    tree, half = spatial.cKDTree(line), random.uniform(0.2, 0.4)
    return lambda p: common(thick - tree.query(p[:, :2])[0], half - np.abs(p[:, 2]))


def torn(random):
    """A sheet with a slit to its middle."""
    half, wide = random.uniform(0.05, 0.1), random.uniform(0.04, 0.1)
    return lambda p: common(box(p, (0.45, 0.4, half)), -common(wide - np.abs(p[:, 1]), p[:, 0]))


def linked(random):
    """Two rings, one through the other."""
    radius, thick = random.uniform(0.2, 0.26), random.uniform(0.05, 0.08)
    def ring(p, normal):
        across = np.delete(p, normal, axis=1)
        return thick - np.hypot(np.linalg.norm(across, axis=1) - radius, p[:, normal])
    return lambda p: union(ring(p + (radius / 2, 0, 0), 2), ring(p - (radius / 2, 0, 0), 1))


def ribbon(random):
    """Twisted along z."""
    twist, half = random.uniform(1, np.pi), (random.uniform(0.15, 0.3), random.uniform(0.04, 0.08), 0.45)
    def values(p):
        cosine, sine = np.cos(twist * p[:, 2]), np.sin(twist * p[:, 2])
        return box(np.column_stack([cosine * p[:, 0] + sine * p[:, 1], cosine * p[:, 1] - sine * p[:, 0], p[:, 2]]), half) / 1.5
    return values


def mushroom(random):
    stem, cap = random.uniform(0.05, 0.1), random.uniform(0.25, 0.4)
    return lambda p: union(capsule(p, (0, 0, -0.4), (0, 0, 0.2), stem), common(ball(p, (0, 0, 0.05), cap), p[:, 2] - 0.1))


def horseshoe(random):
    radius, thick, half = random.uniform(0.25, 0.35), random.uniform(0.06, 0.12), random.uniform(0.08, 0.3)
    def values(p):
        arc = common(thick - np.abs(np.hypot(p[:, 0], p[:, 1]) - radius), p[:, 1])
        legs = common(thick - np.abs(np.abs(p[:, 0]) - radius), -p[:, 1], p[:, 1] + 0.35)
        return common(union(arc, legs), half - np.abs(p[:, 2]))
    return values


def cup(random):
    outer = random.uniform(0.3, 0.45)
    inner, high = outer * random.uniform(0.6, 0.85), random.uniform(0, 0.2)
    return lambda p: common(ball(p, 0, outer), -ball(p, (0, 0, 0.05), inner), high - p[:, 2])


def beads(random):
    """Balls that touch, one after the other."""
    radii = random.uniform(0.08, 0.16, 4)
    heights = np.cumsum(np.concatenate([[0], radii[:-1] + radii[1:]])) * random.uniform(0.85, 0.98)
    heights -= heights.mean()
    return lambda p: union(*(ball(p, (0, 0, z), r) for z, r in zip(heights, radii)))


def lobed(random):
    """A star in every slice, with a hole inside, that turns and shrinks along z."""
    lobes, depth, turn, hole = int(random.integers(3, 7)), random.uniform(0.1, 0.3), random.uniform(-1, 1), random.uniform(0.08, 0.14)
    def values(p):
        away, angle = np.hypot(p[:, 0], p[:, 1]), np.arctan2(p[:, 1], p[:, 0]) + turn * p[:, 2]
        radius = 0.35 * (1 + depth * np.cos(lobes * angle)) * np.sqrt(np.maximum(0, 1 - (p[:, 2] / 0.45)**2))
        return common((radius - away) / 2, away - hole, 0.45 - np.abs(p[:, 2]))
    return values


def slanted(random):
    """Two cylinders that meet at an angle, as a vessel that leaves another."""
    thick = random.uniform(0.06, 0.14, 2)
    way = np.array([np.sin(a := random.uniform(0.4, 1.2)), 0, np.cos(a)])
    return lambda p: union(capsule(p, (0, 0, -0.4), (0, 0, 0.4), thick[0]), capsule(p, (0, 0, -0.1), 0.45 * way, 0.8 * thick[1]))


SOLIDS = {kind.__name__: kind
          for kind in (pair, tower, branches, cylinder, cone, egg, dumbbell, pipe, cross, bean, spiral, torn, linked, ribbon, mushroom,
                       horseshoe, cup, beads, lobed, slanted)}


def moved(solid, off):
    return dataclasses.replace(solid, bounds=solid.bounds + off, values=lambda p: solid.values(np.asarray(p) - off))


def stack(solid, count, random):
    """Planes across the longest main axis at even distances; the first and the last as close to the ends as chance has it."""
    axis = int(np.argmax(np.ptp(solid.bounds, axis=0)))
    low, high = solid.bounds[:, axis]
    gap = (high - low) / (count + random.uniform(-0.6, 0.6))
    heights = low + random.uniform(0.2, 0.8) * gap + gap * np.arange(count)
    middle = solid.bounds.mean(axis=0)
    return [kontur.Plane(np.where(np.arange(3) == axis, h, middle), np.eye(3)[axis]) for h in heights if h < high]


def slab(solid, count, random):
    """A few neighbouring slices through the middle."""
    planes = stack(solid, 4 * count, random)
    return planes[len(planes) // 2 - 1:][:int(random.integers(2, 6))]


def empty_planes(solid, planes, size_mm, random):
    """The next one beyond both ends of a stack, and planes in other directions close beside the solid."""
    found = []
    axis_planes = sorted(planes, key=lambda plane: plane.origin @ planes[0].normal)
    if len(planes) > 1 and abs(planes[0].normal @ planes[-1].normal) > 0.999:
        step = (axis_planes[1].origin - axis_planes[0].origin) @ planes[0].normal * planes[0].normal
        found = [kontur.Plane(axis_planes[0].origin - step, planes[0].normal), kontur.Plane(axis_planes[-1].origin + step, planes[0].normal)]
    for _ in range(2):
        normal = random.normal(size=3)
        normal /= np.linalg.norm(normal)
        places = random.uniform(*solid.bounds, (20000, 3))
        places = places[solid.values(places) > 0]
        top = places[np.argmax(places @ normal)]
        found.append(kontur.Plane(top + random.uniform(0.02, 0.2) * size_mm * normal, normal))
    return [plane for plane in found if is_empty(solid, plane, size_mm)]


def is_empty(solid, plane, size_mm):
    steps = np.linspace(-1.2, 1.2, 161) * size_mm
    uv = np.column_stack([axis.ravel() for axis in np.meshgrid(steps, steps)]) + plane.to_uv(solid.bounds.mean(axis=0)[None])[0]
    return solid.values(plane.from_uv(uv)).max() < -0.003 * size_mm


def changed(contours, change):
    return kontur.ContourSet([change(n, contour) for n, contour in enumerate(contours.contours)], name=contours.name)


def reversed_order(contours, random):
    turned = random.random(len(contours.contours)) < 0.5
    return changed(contours, lambda n, c: kontur.Contour(c.points[::-1], plane=c.plane, hole=c.hole) if turned[n] else c)


def same_plane(a, b, size_mm):
    return abs(a.normal @ b.normal) > 1 - 1e-9 and abs((a.origin - b.origin) @ b.normal) < 1e-6 * size_mm


def cut_off(solid, planes):
    """What is nearer to the first and the last of some parallel planes than half a gap, or between them."""
    normal, first = planes[0].normal, planes[0].origin
    heights = [(plane.origin - first) @ normal for plane in planes]
    middle, half = np.mean(heights), len(heights) / (len(heights) - 1) * np.ptp(heights) / 2
    return dataclasses.replace(solid, values=lambda p: common(solid.values(p), half - np.abs((p - first) @ normal - middle)))


def duplicated(contours, random):
    """One plane's contours twice."""
    chosen = contours.contours[random.integers(len(contours.contours))].plane
    again = [c for c in contours.contours if same_plane(c.plane, chosen, contours.diameter_mm)]
    return kontur.ContourSet([*contours.contours, *again], name=contours.name)


def odd(contours, random):
    """(with one contour larger or smaller about its middle, its plane): what is right there is not known."""
    chosen, scale = random.integers(len(contours.contours)), random.choice(ODD)
    def change(n, c):
        middle = np.mean(c.points, axis=0)
        return kontur.Contour(middle + scale * (c.points - middle), plane=c.plane, hole=c.hole) if n == chosen else c
    return changed(contours, change), contours.contours[chosen].plane


def nearly_parallel(solid, count, random):
    """A stack of which each slice is tilted a little its own way, as by hand or by a patient who moved."""
    planes = []
    for plane in stack(solid, count, random):
        normal = plane.normal + random.normal(0, 0.05, 3)
        planes.append(kontur.Plane(plane.origin, normal / np.linalg.norm(normal)))
    return planes


def crossing_inside(solid, count, random):
    """Planes about one axis through the middle, at small angles: they cross within the solid."""
    first = random.uniform(0, np.pi)
    angles = first + np.sort(random.uniform(0, 0.6 * np.pi, count))
    return [kontur.Plane(solid.bounds.mean(axis=0), [np.cos(a), np.sin(a), 0]) for a in angles]


WAYS = ("plain", "plain", "stack", "slab", "empty", "empty", "reversed", "duplicated", "odd", "small", "large", "far",
        "nearly parallel", "crossing inside")


def made_drawing(number, seed):
    """(solid, kind, size in mm, way, planes, contours)."""
    random = shapes.random_for("hunt", seed, number)
    kinds = solids.KINDS | SOLIDS
    kind, way = str(random.choice(sorted(kinds))), str(random.choice(WAYS))
    size_mm = {"small": SMALL_MM, "large": LARGE_MM}.get(way) or float(np.round(np.exp(random.uniform(np.log(20), np.log(200))), 1))
    solid = solid_of(kinds[kind], kind, size_mm, random)
    if way == "far":
        solid = moved(solid, random.uniform(-FAR_MM, FAR_MM, 3))
    count = int(random.integers(4, 14))
    planner = {"stack": stack, "slab": slab, "nearly parallel": nearly_parallel, "crossing inside": crossing_inside}.get(way) or (stack, shapes.parallel, shapes.orthogonal, shapes.oblique)[random.integers(4)]
    planes = planner(solid, 3 * max(count // 3, 1) if planner is shapes.orthogonal else count, random)
    contours = shapes.exact_sections(solid, size_mm, planes)
    change = {"reversed": reversed_order, "duplicated": duplicated}.get(way)
    if change:
        contours = change(contours, random)
    if way == "odd" and contours.contours:
        contours, left_out = odd(contours, random)
        planes = [plane for plane in planes if not same_plane(plane, left_out, size_mm)]
    if way == "slab" and len(planes) > 1:
        solid = cut_off(solid, planes)
    if way == "empty":
        contours = kontur.ContourSet(contours.contours, name=contours.name, empty_planes=empty_planes(solid, planes, size_mm, random))
    return solid, kind, size_mm, f"{way} {planner.__name__}", planes, contours


def solid_of(unit_of, kind, size_mm, random):
    unit = unit_of(random)
    axis = np.linspace(-0.8, 0.8, 65)
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    near = lattice[unit(lattice) > -0.025]
    return solids.Solid(kind, size_mm * np.array([near.min(axis=0) - 0.03, near.max(axis=0) + 0.03]),
                        lambda p: size_mm * unit(np.asarray(p) / size_mm))


def measured(number, seed):
    solid, kind, size_mm, way, planes, contours = made_drawing(number, seed)
    if not contours.contours:
        return None
    return {"number": number} | shapes.measured(kind, size_mm, way, solid, planes, contours)


def volume_ratio(row):
    return max(float(row["volume_ml"]), 1e-300) / float(row["truth_ml"])


def is_fault(row):
    return float(row["wrong"]) > shapes.WRONG or not 1 / VOLUME < volume_ratio(row) < VOLUME


def is_silent(row):
    return is_fault(row) and not int(row["sentences"]) and not int(row["warnings"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", type=int, nargs="+")
    options = parser.parse_args()
    writer = csv.DictWriter(sys.stdout, FIELDS)
    writer.writeheader()
    kept = []
    for number in options.only or range(options.count):
        if row := measured(number, options.seed):
            writer.writerow(row)
            sys.stdout.flush()
            kept.append(row)
    print(shapes.summary(kept), file=sys.stderr)
    print(f"{sum(map(is_fault, kept))} faults, {sum(map(is_silent, kept))} of them silent:", file=sys.stderr)
    for row in filter(is_silent, kept):
        print(f"  {row['number']} {row['kind']} {row['planes']}: Dice {row['dice']}, section {row['wrong']}, volume {volume_ratio(row):.2f}",
              file=sys.stderr)


if __name__ == "__main__":
    main()
