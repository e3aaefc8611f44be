# SPDX-License-Identifier: Apache-2.0
"""Structures with branches and with holes, of which every second, fourth and eighth slice is kept, along each axis of the grid
where voxels are cubes, else along the third.

Measured are structures (organ_sources.py; the lateral ventricles, too, and a left ventricle's muscle) whose sections fall into
parts, each a twentieth of the section at least, on a quarter of the slices (branches), or have a hole of a hundredth of it, on a
tenth of them (holes). Counted are parts and tunnels between the first and the last kept slice; what touches by a corner hangs
together. The table has the mean Dice of what lies between these slices and the sums over the structures by how many parts and
tunnels are off.
"""
import numpy as np
from scipy import ndimage

import organ_sources
import plain
import slices
import structures
from filling import methods

CORNERS = np.ones((3, 3, 3))
MOST_VOXELS = 6e5  # of the structure's box: finer maps are coarsened
FIELDS = ["kind", "structure", "axis", "step", "method", "dice", "parts", "true_parts", "tunnels", "true_tunnels"]


def cells(mask, axes):
    """How many cells of the mask's closed cubes extend along all axes but these."""
    for axis in axes:
        low, high = ([slice(None)] * 3 for _ in range(2))
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        mask = mask[tuple(low)] | mask[tuple(high)]
    return int(mask.sum())


def euler_number(mask):
    """Of the union of the voxels' closed cubes: corners - edges + faces - cubes."""
    padded = np.pad(mask, 1)
    faces = sum(cells(padded, [axis]) for axis in range(3))
    edges = sum(cells(padded, pair) for pair in ([0, 1], [0, 2], [1, 2]))
    return cells(padded, [0, 1, 2]) - edges + faces - cells(padded, [])


def parts_and_tunnels(mask):
    """Connected parts, and ways through them: parts + cavities - the Euler number."""
    parts = ndimage.label(mask, CORNERS)[1]
    cavities = ndimage.label(~np.pad(mask, 1))[1] - 1
    return parts, parts + cavities - euler_number(mask)


def has_parts(section):
    sizes = np.bincount(ndimage.label(section, CORNERS[0])[0].ravel())[1:]
    return (sizes >= section.sum() / 20).sum() > 1


def has_hole(section):
    sizes = np.bincount(ndimage.label(ndimage.binary_fill_holes(section) & ~section)[0].ravel())[1:]
    return len(sizes) > 0 and sizes.max() >= max(4, section.sum() / 100)


def kinds(truth):
    """What it is to be measured for, along its third axis."""
    sections = [truth[:, :, k] for k in slices.occupied(truth)]
    if np.mean([has_parts(section) for section in sections]) >= 1 / 4:
        yield "branches"
    if np.mean([has_hole(section) for section in sections]) >= 1 / 10:
        yield "holes"


def cropped(mask, affine):
    """The mask with some margin, coarsened where it is large, and the voxels' edges in mm."""
    found = np.argwhere(mask)
    low, high = found.min(axis=0), found.max(axis=0) + 1
    truth, spacing = mask[tuple(slice(a, b) for a, b in zip(low, high))], np.linalg.norm(affine[:3, :3], axis=0)
    while truth.size > MOST_VOXELS:
        factors = np.where(spacing < 1.5 * spacing.min(), 2, 1)
        truth, spacing = structures.coarsened(truth, factors), spacing * factors
    return np.pad(truth, 4), spacing


def muscle(found):
    """The wall of a left ventricle: within its outer contours and not within its inner ones."""
    inner, outer = (found.get(f"ventricle_ED_{kind}") for kind in ("endo", "epi"))
    return {} if inner is None or outer is None else {"muscle_ED": (outer[0] & ~inner[0], outer[1])}


def cases(data, kontur):
    """(kind, structure, axis, mask with that axis last, spacing)."""
    organ_sources.WITHOUT.clear()  # no constant is chosen here
    found = {name: entry[:2] for name, entry in organ_sources.label_maps(data, kontur).items()}
    real = {name: entry[:2] for name, entry in organ_sources.structure_sets(data, kontur).items()}
    for name, (mask, affine) in (found | real | muscle(real)).items():
        truth, spacing = cropped(mask, affine)
        for axis in range(3) if np.ptp(spacing) < 0.01 * spacing.max() else [2]:
            turned, steps = np.moveaxis(truth, axis, 2), np.append(np.delete(spacing, axis), spacing[axis])
            for kind in kinds(turned):
                yield kind, name, "ijk"[axis], np.ascontiguousarray(turned), steps


def measure(case, options):
    kind, name, axis, truth, spacing = case
    for step in slices.STEPS:
        kept = slices.kept(truth, step)
        if not len(kept):
            continue
        between = truth[:, :, kept[0]:kept[-1] + 1]
        true_parts, true_tunnels = parts_and_tunnels(between)
        for method, make in methods.methods(options, name).items():
            mask = make(truth, np.diag([*spacing, 1]), kept)[:, :, kept[0]:kept[-1] + 1]
            parts, tunnels = parts_and_tunnels(mask)
            yield [kind, name, axis, step, method, f"{plain.dice(mask, between):.5f}", parts, true_parts, tunnels, true_tunnels]


def table(rows):
    for kind in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == kind]
        count = len({tuple(row[1:3]) for row in own})
        print(f"\n| {kind}: {count} cases | " + " | ".join(f"1 in {step}: Dice, parts off, tunnels off" for step in slices.STEPS) + " |")
        print("|---" * (1 + len(slices.STEPS)) + "|")
        for method in dict.fromkeys(row[4] for row in own):
            texts = []
            for step in slices.STEPS:
                some = [row for row in own if row[3] == step and row[4] == method]
                dice = np.mean([float(row[5]) for row in some])
                off = [sum(abs(row[n] - row[n + 1]) for row in some) for n in (6, 8)]
                texts.append(f"{dice:.4f}, {off[0]}, {off[1]}")
            print(f"| {method} | " + " | ".join(texts) + " |")


def add_arguments(parser):
    parser.add_argument("--kind", choices=["branches", "holes"])
    parser.set_defaults(images=False)


def run(options):
    measurements = ((" ".join(case[:3]), list(measure(case, options))) for case in cases(options.data, options.kontur)
                    if options.kind in (None, case[0]))
    table(methods.written(options.output / "topology.csv", FIELDS, measurements))
