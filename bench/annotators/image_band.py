#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether band and expected Dice are honest where the image told how the surface runs.

Usage: PYTHONPATH=build/release/python bench/annotators/image_band.py ROWS.jsonl --data SCANS --set tune|report

Structures that bench/image_sources.py lists are cut by 5 or 7 planes (oblique, orthogonal, axial, in turns) and segmented without
and with their image. A row for each way in which the image was used and its twin without: how much of the surface the band
covers, against the faces between voxels of the mask, the Dice, and what of it was expected. Appends, and goes on where it was stopped;
prints the means of all rows.
"""
import argparse
import hashlib
import json
import pathlib
import statistics
import sys

import kontur
import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import image_sources  # noqa: E402

DRAWINGS = [(kind, count) for kind in ("oblique", "ortho", "axial") for count in (5, 7)]
MOST_POINTS = 4000


def read_structure(data, words):
    frame, label = (int(words[3]) if len(words) > 3 else None), (int(words[2]) if words[2] else None)
    image = kontur.read_image(data / words[0], **({} if frame is None else {"frame": frame}))
    mask = kontur.read_mask(data / words[1], **({} if label is None else {"label": label}))
    inside = np.asarray(mask.values) > 0
    found = np.argwhere(inside)
    low, high = found.min(axis=0), found.max(axis=0)
    margin = (high - low) // 4 + 4
    low, high = np.maximum(low - margin, 0), np.minimum(high + margin + 1, inside.shape)
    affine = np.array(mask.grid.index_to_mm)
    affine[:3, 3] = (affine @ [*low[::-1], 1])[:3]
    return image, inside[tuple(slice(a, b) for a, b in zip(low, high))], affine


def stack(indices, affine, axis, count):
    """Each in the middle of its share of the object, at voxel centres."""
    normal = np.cross(affine[:3, (axis + 1) % 3], affine[:3, (axis + 2) % 3])
    low, high = indices.min(axis=0), indices.max(axis=0)
    for n in range(count):
        at = (low + high) / 2
        at[axis] = round(low[axis] - 0.5 + (high[axis] - low[axis] + 1) * (n + 0.5) / count)
        yield kontur.Plane(affine[:3, :3] @ at + affine[:3, 3], normal / np.linalg.norm(normal))


def oblique(points, count, seed):
    random = np.random.default_rng(int(hashlib.sha256(seed.encode()).hexdigest()[:8], 16))
    middle = points.mean(axis=0)
    for _ in range(count):
        normal = random.normal(size=3)
        normal /= np.linalg.norm(normal)
        height = random.uniform(*np.quantile(points @ normal, [0.15, 0.85]))
        yield kontur.Plane(middle + (height - middle @ normal) * normal, normal)


def planes(name, inside, affine, kind, count):
    indices = np.argwhere(inside)[:, ::-1].astype(float)
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    if kind == "oblique":
        return list(oblique(indices @ affine[:3, :3].T + affine[:3, 3], count, f"{name}{kind}{count}"))
    if kind == "axial":
        thick = next((axis for axis in (0, 1) if spacing[axis] > 1.2 * np.delete(spacing, axis).min()), 2)
        return list(stack(indices, affine, thick, count))
    return [plane for n in range(3) for plane in stack(indices, affine, 2 - n, count // 3 + (count % 3 > n))]


def faces(inside, affine):
    """The middles of the faces between voxels inside and outside, mm."""
    found = []
    for axis in range(3):
        change = np.argwhere(np.diff(inside.astype(np.int8), axis=axis)).astype(float)
        change[:, axis] += 0.5
        found.append(change)
    return np.vstack(found)[:, ::-1] @ affine[:3, :3].T + affine[:3, 3]


def row(made, contours, inside, border):
    points = np.asarray(made.mesh.points)[::max(1, len(made.mesh.points) // MOST_POINTS)]
    widths = np.asarray(kontur.half_widths_mm(made, contours, points, threads=1))
    found, dice = np.asarray(made.mask.values) > 0, made.report.uncertainty.dice
    return {"covers": float((border.query(points)[0] <= widths).mean()), "half_width_mm": float(np.median(widths)),
            "dice": float(2 * (found & inside).sum() / (found.sum() + inside.sum())), "expected": dice.value,
            "low": dice.low, "high": dice.high}


def measure(name, words, drawings, done, options):
    image, inside, affine = read_structure(options.data, words)
    grid = kontur.Grid(inside.shape[::-1], affine, frame="LPS")
    truth, border = kontur.Mask(inside, grid), cKDTree(faces(inside, affine))
    least_mm2 = 2 * abs(np.linalg.det(affine[:3, :3])) ** (2 / 3)
    for kind, count in drawings:
        if (name, kind, count) in done:
            continue
        try:
            contours = kontur.trace(truth, planes(name, inside, affine, kind, count), min_area_mm2=least_mm2, threads=1)
            made = {use: kontur.segment(contours, grid, image=image, use_image=use, mesh=True, threads=1) for use in ("off", "auto")}
        except kontur.Error as error:
            print(f"image_band.py: {name}, {kind} {count}: {error}", file=sys.stderr)
            continue
        if made["auto"].report.image.verdict != "used" or not made["off"].report.uncertainty.is_known:
            continue
        rows = {use: row(one, contours, inside, border) for use, one in made.items()}
        yield {"structure": name, "kind": kind, "planes": count, "without": rows["off"], "with": rows["auto"]}


def read(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def summary(rows, way):
    own = [r[way] for r in rows]
    held = statistics.fmean(r["low"] <= r["dice"] <= r["high"] for r in own)
    off = statistics.median(abs(r["dice"] - r["expected"]) for r in own)
    return (f"{way} the image: band covers {statistics.fmean(r['covers'] for r in own):.3f}, Dice "
            f"{statistics.fmean(r['dice'] for r in own):.3f}, expected {statistics.fmean(r['expected'] for r in own):.3f}, off by {off:.4f} "
            f"(median), in its interval {held:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", type=pathlib.Path)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("--set", default="tune", choices=("tune", "report"))
    options = parser.parse_args()
    done = {(r["structure"], r["kind"], r["planes"]) for r in read(options.rows)}
    sets = image_sources.sets()
    for number, (name, words) in enumerate(image_sources.scans().items()):
        if words[0] == "phantom" or sets[name] != options.set or not (options.data / words[1]).exists():
            continue
        for one in measure(name, words, DRAWINGS[number % 2::2], done, options):
            with open(options.rows, "a", encoding="utf-8") as file:
                file.write(json.dumps(one) + "\n")
    rows = read(options.rows)
    print(f"{len(rows)} drawings of {len({r['structure'] for r in rows})} structures")
    for way in ("without", "with"):
        print(summary(rows, way))


if __name__ == "__main__":
    main()
