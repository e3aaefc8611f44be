#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How often the band and the interval of the expected Dice hold the truth on real structures.

Usage: bench/annotators/organ_band.py measure STATES.jsonl --data SCANS --program build/release/bin/kontur_organs
                                              [--with-image] [--set tune|report] [--share 7] [--jobs 1]
       bench/annotators/organ_band.py csv WITHOUT.jsonl WITH.jsonl > bench/results/organ_band.csv
       bench/annotators/organ_band.py fit STATES.jsonl...

Structures, drawings and halves are those of bench/images.py: of 30 drawings --share 7 takes every seventh, others for the next
structure. Drawings that STATES.jsonl has are not measured again, so a run that was stopped goes on.

`csv` writes how much the 90 % band holds of the true border, by its area. That is the middles of the faces between voxels inside and
outside, which the 0.5 level of the mask's trilinear interpolation runs through as well. The other way round, of the found surface's
places, it holds those whose distance from that level, or from the faces of the voxels, is less. `fit` prints what the constants
of the band that are of real structures would be, by the half `tune`: 90 % quantile regression of the border's distance.
"""
import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys

import numpy as np
from scipy import optimize

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import image_sources  # noqa: E402
import images  # noqa: E402

PLANES = {"3 to 4 planes": (3, 4), "5 to 7 planes": (5, 7), "10 planes": (10, 10)}
KINDS = {"axial": "axial", "ortho": "orthogonal", "oblique": "oblique"}
HANDS = {"exact": "exact", "hand": "by hand"}
COLUMNS = ["image", "set", "drawings", "count", "border_held", "without_parallel", "and_half_a_voxel", "surface_near_level",
           "surface_near_voxels", "median_half_width_mm", "dice", "expected_dice", "dice_held"]
LEAST_DISTANCE, LEAST_SLOPE, MOST_SLOPE, NINETY = 0.003, 0.3, 2.0, 1.645
BAND = np.array([-1.62, 0.58, -0.51, 0.52, 0.81, -0.70])  # src/kontur/sureness/uncertainty_model.h
OF_ORGANS = [0, 1, 5]  # factor, distance, planes


def read(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def measure(options):
    states = options.states[0]
    states.touch()
    done = {(r["structure"], f"{r['kind']},{r['planes']},{r['hand']}") for r in read(states)}
    sets, wanted = image_sources.sets(), images.all_drawings()
    environment = os.environ | ({"KONTUR_ORGANS_IMAGE": "1"} if options.with_image else {})
    tasks = []
    for number, (name, words) in enumerate(image_sources.scans().items()):
        missing = [d for d in wanted[number % options.share::options.share] if (name, d) not in done]
        call = images.command(options.program, options.data, name, words)
        if call and missing and options.set in (None, sets[name]):
            tasks.append((call, ";".join(missing)))

    def run(task):
        call, drawings = task
        result = subprocess.run(call, env=environment | {"KONTUR_IMAGES": drawings}, stdout=subprocess.PIPE, text=True)
        with open(states, "a", encoding="utf-8") as file:
            file.write(result.stdout)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(run, tasks))


class State:
    """One drawing. Lengths in sizes of the surface."""

    def __init__(self, line):
        self.line = line
        distance, slope, to_level, share, left, to_voxels = np.array(line["samples"]).T
        share = share / share.sum()
        away, h, area, self.border_left, widths = np.array(line["border"]).T
        self.away, self.area = away, area / area.sum()
        crossing = max(line["residual_mm"], line["disagreement_mm"] / np.sqrt(2))
        self.drawing, without = (np.hypot(line["voxel_mm"] / 2, NINETY * mm) / line["size_mm"] for mm in (max(crossing, line["hand_mm"]), crossing))
        h, distance = (np.log(np.maximum(values, LEAST_DISTANCE)) for values in (h, distance))
        slope = np.log(np.clip(slope, LEAST_SLOPE, MOST_SLOPE))
        same = [np.log(share @ np.exp(distance)), np.log(line["area_mm2"] ** 1.5 / line["volume_mm3"]), np.log(line["whole_planes"])]
        self.design = np.column_stack([np.ones_like(h), h, np.full_like(h, share @ slope), *(np.full_like(h, s) for s in same)])
        of_surface = np.column_stack([np.ones_like(distance), distance, slope, *(np.full_like(distance, s) for s in same)])
        own = np.hypot(left * np.exp(of_surface @ BAND), self.drawing)
        half = line["voxel_mm"] / line["size_mm"] / 2
        without = np.sqrt(widths**2 - self.drawing**2 + without**2)
        self.row = {"border_held": self.area @ (away <= widths), "without_parallel": self.area @ (away <= without),
                    "and_half_a_voxel": self.area @ (away <= widths + half),
                    "surface_near_level": share @ (to_level <= own), "surface_near_voxels": share @ (to_voxels <= own),
                    "median_half_width_mm": line["size_mm"] * np.median(widths), "dice": line["dice"], "expected_dice": line["expected"],
                    "dice_held": line["low"] <= line["dice"] <= line["high"]}


def groups(states):
    """Of all; by planes, also of slices by either hand; by kind; by hand."""
    found = {name: [s for s in states if least <= s.line["planes"] <= most] for name, (least, most) in PLANES.items()}
    for hand, by in HANDS.items():
        slices = [s for s in states if (s.line["kind"], s.line["hand"]) == ("axial", hand)]
        found |= {f"axial {by}, {name}": [s for s in own if s in slices] for name, own in list(found.items())[:len(PLANES)]}
    found |= {by: [s for s in states if s.line["kind"] == kind] for kind, by in KINDS.items()}
    found |= {by: [s for s in states if s.line["hand"] == hand] for hand, by in HANDS.items()}
    return {name: own for name, own in (found | {"all": states}).items() if own}


def write_csv(options):
    table = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    table.writeheader()
    sets = image_sources.sets()
    for image, path in zip(("without", "with"), options.states):
        states = [State(line) for line in read(path)]
        for which in ("tune", "report"):
            for name, own in groups([s for s in states if sets[s.line["structure"]] == which]).items():
                means = {column: f"{statistics.fmean(s.row[column] for s in own):.3f}" for column in COLUMNS[4:]}
                table.writerow({"image": image, "set": which, "drawings": name, "count": len(own)} | means)


def fit(options):
    """Prints the constants, and what the band holds of the border with each of them halved and doubled."""
    sets = image_sources.sets()
    states = [State(line) for path in options.states for line in read(path)]
    tune = [s for s in states if sets[s.line["structure"]] == "tune"]
    design, area, left = (np.concatenate([getattr(s, name) for s in tune]) for name in ("design", "area", "border_left"))
    error = np.log(np.maximum(np.concatenate([s.away for s in tune]), 1e-4))
    drawing = np.concatenate([np.full_like(s.away, s.drawing) for s in tune])

    def loss(some):
        band = BAND.copy()
        band[OF_ORGANS] = some
        missed = left * np.exp(design @ band)
        width = np.hypot(missed, drawing)
        off = error - np.log(width)
        gradient = (area * np.where(off > 0, -0.9, 0.1) * (missed / width) ** 2) @ design[:, OF_ORGANS]
        return (area * np.where(off > 0, 0.9 * off, -0.1 * off)).sum(), gradient

    found = optimize.minimize(loss, BAND[OF_ORGANS], jac=True, method="BFGS", options={"gtol": 1e-6, "maxiter": 200}).x
    print("factor, distance, planes:", *(f"{value:.2f}" for value in found))

    def held(band, own):
        return statistics.fmean(s.area @ (s.away <= np.hypot(s.border_left * np.exp(s.design @ band), s.drawing)) for s in own)

    for constant, name in ((1, "distance"), (5, "planes")):
        for times in (0.5, 1, 2):
            band = BAND.copy()
            band[constant] *= times
            middle = statistics.fmean(s.design[:, constant].mean() for s in tune)
            band[0] += (BAND[constant] - band[constant]) * middle  # the mean width stays
            print(f"{name} {band[constant]:.2f}:", *(f"{group} {held(band, own):.3f}" for group, own in groups(tune).items() if group in PLANES))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", choices=("measure", "csv", "fit"))
    parser.add_argument("states", type=pathlib.Path, nargs="+")
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--program", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--with-image", action="store_true")
    parser.add_argument("--set", choices=("tune", "report"))
    parser.add_argument("--share", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    {"measure": measure, "csv": write_csv, "fit": fit}[options.command](options)


if __name__ == "__main__":
    main()
