#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Label maps of which some slices are left, filled by `kontur fill` and by its peers: docs/fill.md.

Usage: bench/fill.py DATA OUTPUT --kontur build/release/bin/kontur [--every N] [--jobs N] [--only real|report|tune] [--images]

Of every structure that organ_sources.py finds every second, fourth and eighth slice is kept along the image's third axis, and
the others are filled again. Of the structures of label maps, sorted by name, the first, third, ... are for reports, the second,
fourth, ... for choosing constants. With --images only structures whose image is there are filled, once without and once with it.
Writes OUTPUT/fill.csv and prints tables. Dice counts all slices of the structure.
"""
import argparse
import csv
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import nibabel
import numpy as np

import organ_sources
import plain
import slices
import structures

# The image that a structure was drawn on, by how its name begins.
IMAGES = {
    "sarcoma_STS_002": "03_sarcoma_STS_002/CT/image",
    "sarcoma_STS_040": "04_sarcoma_STS_040/CT/image",
    "sarcoma_STS_008": "05_sarcoma_STS_008/CT/image",
    "abdomen": "01_ct_abdomen_totalseg_3mm/example_ct_sm.nii.gz",
    "vertebrae": "01_ct_abdomen_totalseg_3mm/example_ct.nii.gz",
    "brain": "06_mr_brain_MRIcrop/MRIcrop-orig.nii.gz",
    "tumour_0": "07_mr_brain_tumour_brain1/brain1_image.nrrd",
    "cord": "13_mr_spinal_cord_t2/t2.nii.gz",
}
FIELDS = ["set", "structure", "step", "method", "dice", "dice_left_out", "roughness_mm2", "seconds"]


def filled(kontur, mask, affine, words):
    with tempfile.TemporaryDirectory() as folder:
        sparse, full = pathlib.Path(folder, "sparse.nii"), pathlib.Path(folder, "full.nii")
        image = nibabel.Nifti1Image(mask.astype(np.uint8), structures.LPS @ affine)
        image.set_sform(structures.LPS @ affine, 1)
        image.set_qform(None, 0)
        nibabel.save(image, sparse)
        subprocess.run([kontur, "fill", sparse, "--output", full, "--threads", "1", "--quiet", *words], check=True)
        return np.asarray(nibabel.load(full).dataobj) > 0


def sparse_map(truth, kept):
    sparse = np.zeros_like(truth)
    sparse[:, :, kept] = truth[:, :, kept]
    return sparse


def image_of(name, data):
    """The image of a structure; None without one."""
    found = [data / file for start, file in IMAGES.items() if name.startswith(start) and (data / file).exists()]
    return found[0] if found else None


def methods(options, name):
    found = {"shape-based": lambda truth, affine, kept: slices.shape_based(truth, kept, np.linalg.norm(affine[:3, :3], axis=0))}
    for words in options.words or [""]:
        found[f"kontur fill {words}".strip()] = lambda truth, affine, kept, words=words: filled(
            options.kontur, sparse_map(truth, kept), affine, words.split())
    if options.images:
        asked = ["--image", image_of(name, options.data), "--use-image", "auto"]
        found["kontur fill --use-image auto"] = lambda truth, affine, kept: filled(
            options.kontur, sparse_map(truth, kept), affine, asked)
    return found


def steps_across(mask):
    """How much the border moves from slice to slice beyond what it moves on average over two: the roughness seen in the other
    planes. Mean over the border's voxels of the second difference of the occupancy across slices."""
    occupancy = mask.astype(float).sum(axis=(0, 1))
    return float(np.abs(np.diff(occupancy, 2)).sum() / max(occupancy.sum(), 1))


def measure(task):
    which, name, truth, affine, options = task
    rows = []
    for step in slices.STEPS:
        kept = slices.kept(truth, step)
        if not len(kept):
            continue
        left_out = [k for k in range(kept[0], kept[-1]) if k not in kept]
        for method, make in methods(options, name).items():
            start = time.perf_counter()
            mask = make(truth, affine, kept)
            seconds = time.perf_counter() - start
            rows.append([which, name, step, method, f"{plain.dice(mask, truth):.5f}",
                         f"{plain.dice(mask[:, :, left_out], truth[:, :, left_out]):.5f}", f"{steps_across(mask):.4f}", f"{seconds:.2f}"])
    return rows


def structures_of(options):
    """(set, structure, mask, affine), cropped and padded."""
    if options.only in (None, "real"):
        for name, (mask, affine, _, _) in organ_sources.structure_sets(options.data, options.kontur).items():
            truth, grid, _ = structures.truth_of(mask, affine)
            yield "real", name, truth, grid
    if options.only == "real":
        return
    found = organ_sources.label_maps(options.data, options.kontur)
    for number, (name, (mask, affine, _)) in enumerate(found.items()):
        which = "tune" if number % 2 else "report"
        if options.only in (None, which) and number // 2 % options.every == 0:
            truth, grid, _ = structures.truth_of(mask, affine)
            yield which, name, truth, grid


def tables(rows):
    for which in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == which]
        names = list(dict.fromkeys(row[3] for row in own))
        print(f"\n| {which}: {len({row[1] for row in own})} structures | " + " | ".join(f"1 in {step}" for step in slices.STEPS) + " |")
        print("|---" * (1 + len(slices.STEPS)) + "|")
        for method in names:
            cells = []
            for step in slices.STEPS:
                dice = {row[1]: float(row[4]) for row in own if row[2] == step and row[3] == method}
                peer = {row[1]: float(row[4]) for row in own if row[2] == step and row[3] == "shape-based"}
                worst = min((dice[name] - peer[name] for name in dice), default=0)
                behind = sum(dice[name] < peer[name] - 0.002 for name in dice)
                cells.append(f"{np.mean(list(dice.values())):.4f} ({behind} behind, worst {worst:+.4f})" if dice else "")
            print(f"| {method} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every N-th structure of the label maps")
    parser.add_argument("--only", choices=["real", "report", "tune"])
    parser.add_argument("--words", action="append", metavar="OPTIONS", help="options of `kontur fill` to try; again for more")
    parser.add_argument("--images", action="store_true", help="fill without and with the image, where there is one")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    tasks = [(*found, options) for found in structures_of(options)
             if not options.images or image_of(found[1], options.data) is not None]
    rows = []
    with multiprocessing.Pool(options.jobs) as pool, open(options.output / "fill.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(FIELDS)
        for number, more in enumerate(pool.imap(measure, tasks), 1):
            rows += more
            table.writerows(more)
            print(f"measured {number} of {len(tasks)}", file=sys.stderr)
    tables(rows)


if __name__ == "__main__":
    main()
