# SPDX-License-Identifier: Apache-2.0
"""Every second, fourth and eighth slice is kept along the image's third axis, and the others are filled again.

Of the structures of label maps, sorted by name, the first, third, ... are for reports, the second, fourth, ... for choosing
constants. Dice counts all slices of the structure; behind is what is more than .002 worse than the best of the peers.
"""
import multiprocessing
import time

import numpy as np

import organ_sources
import plain
import slices
import structures
from filling import methods

FIELDS = ["set", "structure", "step", "start", "method", "dice", "dice_left_out", "roughness_mm", "seconds"]
BEHIND = 0.002


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
        for method, make in methods.methods(options, name).items():
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


def add_arguments(parser):
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every N-th structure of the label maps")
    parser.add_argument("--only", choices=["real", "report", "tune"])
    parser.add_argument("--images", action="store_true", help="only structures whose image is there, without and with it")
    parser.add_argument("--all-starts", action="store_true", help="begin with each slice that can be the first kept one; means over them")
    parser.add_argument("--jobs", type=int, default=1)


def run(options):
    tasks = [(*found, options) for found in structures_of(options)
             if not options.images or methods.image_of(found[1], options.data) is not None]
    with multiprocessing.Pool(options.jobs) as pool:
        names = (f"{task[1]}, {number} of {len(tasks)}" for number, task in enumerate(tasks, 1))
        tables(methods.written(options.output / "fill.csv", FIELDS, zip(names, pool.imap(measure, tasks))))
