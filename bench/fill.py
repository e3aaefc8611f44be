#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Label maps of which some slices are left, filled by `kontur fill` and by its peers: docs/fill.md.

Usage: bench/fill.py DATA OUTPUT --kontur build/release/bin/kontur [--itk build/release/bin/itk_fill] [--every N] [--jobs N]
                    [--only real|report|tune] [--images] [--all-starts]

Of every structure that organ_sources.py finds every second, fourth and eighth slice is kept along the image's third axis, and
the others are filled again. Of the structures of label maps, sorted by name, the first, third, ... are for reports, the second,
fourth, ... for choosing constants. With --images only structures whose image is there are filled, once without and once with it.
With --all-starts it is kept every second slice from the first and from the second on, every fourth from each of the first four,
and so on; tables then have the mean over them. Writes OUTPUT/fill.csv and prints tables. Dice counts all slices of the structure; behind is what is more than .002 worse than the
best of the peers: the shape-based interpolation and, with --itk, ITK's filter, as it comes and with dilations. itk_fill is built
where CMake is told where the filter's sources are: -DKONTUR_ITK_MODULE=FOLDER.
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
FIELDS = ["set", "structure", "step", "start", "method", "dice", "dice_left_out", "roughness_mm", "seconds"]
BEHIND = 0.002


def run(mask, ras, command):
    """What a program writes: `command(sparse, full)` with the paths of the files."""
    with tempfile.TemporaryDirectory() as folder:
        sparse, full = pathlib.Path(folder, "sparse.nii"), pathlib.Path(folder, "full.nii")
        image = nibabel.Nifti1Image(mask.astype(np.uint8), ras)
        image.set_sform(ras, 1)
        image.set_qform(None, 0)
        nibabel.save(image, sparse)
        subprocess.run(command(sparse, full), check=True)
        return np.asarray(nibabel.load(full).dataobj) > 0


def filled(kontur, mask, affine, words):
    return run(mask, structures.LPS @ affine,
               lambda sparse, full: [kontur, "fill", sparse, "--output", full, "--threads", "1", "--quiet", *words])


def filled_by_itk(program, mask, affine, words):
    """On a grid of the same spacing with the patient's axes: ITK takes no other grid from a file, and its filter asks no more."""
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    return run(mask, np.diag([*spacing, 1]), lambda sparse, full: [program, sparse, full, *words])


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
    for words in ("", "--dilations") if options.itk else ():
        found[f"ITK {words}".strip()] = lambda truth, affine, kept, words=words: filled_by_itk(
            options.itk, sparse_map(truth, kept), affine, words.split())
    for words in options.words or [""]:
        found[f"kontur fill {words}".strip()] = lambda truth, affine, kept, words=words: filled(
            options.kontur, sparse_map(truth, kept), affine, words.split())
    if options.images:
        asked = ["--image", image_of(name, options.data), "--use-image", "auto"]
        found["kontur fill --use-image auto"] = lambda truth, affine, kept: filled(
            options.kontur, sparse_map(truth, kept), affine, asked)
    return found


def roughness_mm(mask, spacing):
    """How far the outlines jump from slice to slice, which the planes of the other axes show: the mean, over the voxels beside
    the outline of a slice, of the second difference across the slices of the signed distances in them."""
    jumps = []
    occupied = slices.occupied(mask)
    for k in occupied[1:-1]:
        if mask[:, :, k - 1].any() and mask[:, :, k + 1].any():
            low, here, high = (slices.signed_distance(mask[:, :, n], spacing[:2]) for n in (k - 1, k, k + 1))
            jumps.append(np.abs(low - 2 * here + high)[np.abs(here) < min(spacing[:2])])
    return float(np.concatenate(jumps).mean()) if jumps else 0.0


def measure(task):
    which, name, truth, affine, options = task
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    rows = []
    for step, start in [(step, start) for step in slices.STEPS for start in range(step if options.all_starts else 1)]:
        kept = slices.kept(truth, step, start)
        if not len(kept):
            continue
        left_out = [k for k in range(kept[0], kept[-1]) if k not in kept]
        for method, make in methods(options, name).items():
            begun = time.perf_counter()
            mask = make(truth, affine, kept)
            seconds = time.perf_counter() - begun
            rows.append([which, name, step, start, method, f"{plain.dice(mask, truth):.5f}",
                         f"{plain.dice(mask[:, :, left_out], truth[:, :, left_out]):.5f}", f"{roughness_mm(mask, spacing):.4f}", f"{seconds:.2f}"])
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


def mean_by_structure(own, step, method, field):
    found = {}
    for row in own:
        if row[2] == step and row[4] == method:
            found.setdefault(row[1], []).append(float(row[FIELDS.index(field)]))
    return {name: np.mean(values) for name, values in found.items()}


def cell(own, step, method):
    dice = mean_by_structure(own, step, method, "dice")
    if not dice:
        return ""
    peers = [mean_by_structure(own, step, peer, "dice") for peer in dict.fromkeys(row[4] for row in own) if not peer.startswith("kontur")]
    ahead = {name: dice[name] - max(peer[name] for peer in peers) for name in dice}
    worst = min(ahead, key=ahead.get)
    behind = sum(difference < -BEHIND for difference in ahead.values())
    rough = np.mean(list(mean_by_structure(own, step, method, "roughness_mm").values()))
    return f"{np.mean(list(dice.values())):.4f}, {behind} behind, worst {ahead[worst]:+.4f} {worst}, {rough:.2f} mm"


def tables(rows):
    for which in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == which]
        names = list(dict.fromkeys(row[4] for row in own))
        print(f"\n| {which}: {len({row[1] for row in own})} structures | " + " | ".join(f"1 in {step}" for step in slices.STEPS) + " |")
        print("|---" * (1 + len(slices.STEPS)) + "|")
        for method in names:
            print(f"| {method} | " + " | ".join(cell(own, step, method) for step in slices.STEPS) + " |")


def parser_of(description):
    """What every measurement of methods() asks for."""
    program = lambda path: pathlib.Path(path).resolve()
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=program)
    parser.add_argument("--itk", type=program, metavar="ITK_FILL", help="measure ITK's filter, too")
    parser.add_argument("--words", action="append", metavar="OPTIONS", help="options of `kontur fill` to try; again for more")
    parser.set_defaults(images=False)
    return parser


def written(path, fields, measurements):
    """All rows, each written as it comes. A measurement: what it was of, and its rows."""
    rows = []
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(fields)
        for name, more in measurements:
            rows += more
            table.writerows(more)
            file.flush()
            print(f"measured {name}", file=sys.stderr)
    return rows


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every N-th structure of the label maps")
    parser.add_argument("--only", choices=["real", "report", "tune"])
    parser.add_argument("--images", action="store_true", help="fill without and with the image, where there is one")
    parser.add_argument("--all-starts", action="store_true", help="begin with each of the slices that can be the first kept one")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    tasks = [(*found, options) for found in structures_of(options)
             if not options.images or image_of(found[1], options.data) is not None]
    with multiprocessing.Pool(options.jobs) as pool:
        names = (f"{task[1]}, {number} of {len(tasks)}" for number, task in enumerate(tasks, 1))
        tables(written(options.output / "fill.csv", FIELDS, zip(names, pool.imap(measure, tasks))))


if __name__ == "__main__":
    main()
