#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drawings of every structure in label maps, for kontur_accuracy: organs that no rule of the method was chosen on.

Usage: bench/structures.py --kontur build/release/bin/kontur --output FOLDER [--slices | --cut-off] [--without STRUCTURE]...
    NAME=LABELMAP...

Every label with at least 300 voxels becomes a structure, NAME_LABEL; with NAME/parts=LABELMAP every connected part of a label
does, NAME_LABEL_PART, counted from the lowest in the file. Of each: the mask, coarsened until its grid has at most 2.6 million
voxels, with a margin of 35 % of its diameter on every side (empty voxels beyond the image), and five drawings of it, cut by
`kontur trace`. Sorted by name, the first, third, ... go to FOLDER/report, the second, fourth, ... to FOLDER/tune: constants may
be chosen on the latter. FOLDER/structures.csv lists them. The same arguments give the same files.

With --slices the drawings are layers of the truth's voxels along its third axis: one in two, four and eight, as for interpolation
between slices, and two, three and four in the middle, as somebody begins to draw. Structures that the image cuts off are left
out: their ends are not the object's. With --cut-off it is these alone, in planes and layers, and their grids end where the image does.
"""
import argparse
import csv
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

import nibabel
import numpy as np
from scipy import ndimage

import hands

LEAST_VOXELS, MOST_VOXELS = 300, 2.6e6
MARGIN, LEAST_MARGIN = 0.35, 10  # of the diameter; voxels
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
TILTED = (0.3, -0.25, 0.92)  # normal of the tilted planes, LPS
FIELDS = ["number", "set", "structure", "source", "voxels", "volume_ml", "parts", "at_border", "coarsened"]


def read_labels(path, kontur):
    """Labels as integers and the affine from indices to LPS mm."""
    if path.name.endswith((".nii", ".nii.gz")):
        image = nibabel.load(path)
        return np.rint(np.asarray(image.dataobj)).astype(int), LPS @ image.affine
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder, "labels.nii.gz")
        subprocess.run([kontur, "convert", path, copy, "--quiet"], check=True)
        return read_labels(copy, kontur)


def structures_of(name, labels):
    """(structure's name, mask) of every label or part that is large enough."""
    apart = name.endswith("/parts")
    for label in np.unique(labels[labels > 0]):
        mask = labels == label
        parts, count = ndimage.label(mask, np.ones((3, 3, 3))) if apart else (mask.astype(int), 1)
        lowest = sorted(range(1, count + 1), key=lambda part: np.argwhere(parts == part)[:, 2].min())
        for number, part in enumerate(lowest, 1):
            if (parts == part).sum() >= LEAST_VOXELS:
                suffix = f"_{number}" if apart else ""
                yield f"{name.removesuffix('/parts')}_{label:03d}{suffix}", parts == part


def margin_voxels(extent_mm, spacing):
    """Along each axis; `extent_mm` is that of the object's box."""
    return np.maximum(np.ceil(MARGIN * np.linalg.norm(extent_mm) / spacing), LEAST_MARGIN).astype(int)


def coarsening(extent, spacing):
    """How many voxels along each axis become one, so that the padded grid is small enough: the finest axes first."""
    factors = np.ones(3, int)
    while True:
        coarse = spacing * factors
        size = np.ceil(extent / factors) + 2 * margin_voxels(extent * spacing, coarse)
        if size.prod() <= MOST_VOXELS:
            return factors
        factors[coarse < 1.01 * coarse.min()] += 1


def coarsened(mask, factors):
    """A voxel is inside where at least half of those that it is made of are."""
    size = -(-np.array(mask.shape) // factors)
    padded = np.pad(mask, [(0, n * f - have) for n, f, have in zip(size, factors, mask.shape)])
    blocks = padded.reshape([part for pair in zip(size, factors) for part in pair])
    return blocks.mean(axis=(1, 3, 5)) >= 0.5


def truth_of(mask, index_to_mm, ends_with_image=False):
    """The mask within its own grid, coarsened and padded; that grid's affine; and how many voxels became one. No margin where the
    grid `ends_with_image`, which cuts the object off."""
    found = np.argwhere(mask)
    low, high = found.min(axis=0), found.max(axis=0) + 1
    spacing = np.linalg.norm(index_to_mm[:3, :3], axis=0)
    factors = coarsening(high - low, spacing)
    truth = coarsened(mask[tuple(slice(a, b) for a, b in zip(low, high))], factors)
    margin = np.repeat(margin_voxels((high - low) * spacing, spacing * factors)[:, None], 2, axis=1)
    if ends_with_image:
        margin[low == 0, 0] = margin[high == mask.shape, 1] = 0
    affine = index_to_mm.copy()
    affine[:3, :3] *= factors
    first_centre = low + (factors - 1) / 2 - margin[:, 0] * factors
    affine[:3, 3] = index_to_mm[:3, :3] @ first_centre + index_to_mm[:3, 3]
    return np.pad(truth, margin), affine, factors


def plane(origin, normal):
    normal = np.array(normal, float) / np.linalg.norm(normal)
    u = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    u /= np.linalg.norm(u)
    return {"origin": list(origin), "normal": list(normal), "u": list(u), "v": list(np.cross(normal, u)), "contours": []}


def oblique(points, random):
    """Ten planes in random directions through random places in the object."""
    places = points[random.integers(len(points), size=10)]
    return [plane(place, normal) for place, normal in zip(places, random.normal(size=(10, 3)))]


def orthogonal(points, random):
    """Three planes across each patient axis: through the centroid and a quarter of the extent to both sides."""
    quarter = np.ptp(points, axis=0) / 4
    return [plane(points.mean(axis=0) + step * quarter[axis] * np.eye(3)[axis], np.eye(3)[axis])
            for axis in range(3) for step in (-1, 0, 1)]


def radial(points, random, start=0.0):
    """Six planes through the centroid around the long axis."""
    across = np.linalg.eigh(np.cov(points.T))[1][:, :2]
    angles = start + np.arange(6) * np.pi / 6
    return [plane(points.mean(axis=0), across @ (np.cos(a), np.sin(a))) for a in angles]


def tilted_parallel(points, random):
    """Seven parallel planes across the object, tilted against the patient's axes."""
    normal = np.array(TILTED) / np.linalg.norm(TILTED)
    heights = (points - points.mean(axis=0)) @ normal
    at = heights.min() + np.linspace(0.06, 0.94, 7) * np.ptp(heights)
    return [plane(points.mean(axis=0) + height * normal, normal) for height in at]


def first(points, random):
    """The three planes with which a user begins: one across each patient axis, through the centroid."""
    return [plane(points.mean(axis=0), axis) for axis in np.eye(3)]


DRAWINGS = {"oblique10": oblique, "ortho3x3": orthogonal, "radial6": radial, "tilted_parallel7": tilted_parallel}
PLANE_SETS = DRAWINGS | {"ortho1x3": first}


def layers(truth, affine):
    """{drawing: planes} of layers of voxels; none where fewer than two are left."""
    occupied = np.flatnonzero(truth.any(axis=(0, 1)))
    chosen = {f"slices_1_in_{step}": occupied[step // 2::step] for step in (2, 4, 8)}
    chosen |= {f"middle_{count}": occupied[(len(occupied) - count) // 2:][:count] for count in (2, 3, 4)}
    normal = np.cross(affine[:3, 0], affine[:3, 1])
    return {drawing: [plane(affine[:3, :3] @ (0, 0, k) + affine[:3, 3], normal) for k in map(int, some)]
            for drawing, some in chosen.items() if len(some) > 1}


def turned(drawing, points, random):
    """Planes in directions that are neither the image's nor the patient's: those of the turned object, turned back with it.
    Around the object's own axis they begin somewhere else."""
    if drawing == "radial6":
        return radial(points, random, random.uniform(0, np.pi / 6))
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    planes = PLANE_SETS[drawing](points @ turn.T, random)
    return [plane(np.array(made["origin"]) @ turn, np.array(made["normal"]) @ turn) for made in planes]


def random_for(*names):
    digest = hashlib.sha256("/".join(names).encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "little"))


def cut(kontur, folder, drawing, planes, least_area):
    """Contours with fewer than a voxel's face are left out, as nobody would draw them."""
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch, "planes.json")
        file.write_text(json.dumps({"frame": "LPS mm", "planes": planes}))
        subprocess.run([kontur, "trace", folder / "truth.nii.gz", "--planes", file, "--output", folder / f"{drawing}.json",
                        "--min-area-mm2", str(least_area), "--quiet"], check=True)


def write_truth(folder, truth, affine):
    folder.mkdir(parents=True, exist_ok=True)
    image = nibabel.Nifti1Image(truth.astype(np.uint8), LPS @ affine)
    image.set_sform(LPS @ affine, 1)
    image.set_qform(None, 0)  # it could not hold a shear
    nibabel.save(image, folder / "truth.nii.gz")


def voxel_points(truth, affine):
    return np.argwhere(truth) @ affine[:3, :3].T + affine[:3, 3]


def write_layers(folder, truth, affine, kontur):
    write_truth(folder, truth, affine)
    least_area = np.linalg.norm(affine[:3, :3], axis=0).min() ** 2
    for drawing, planes in layers(truth, affine).items():
        cut(kontur, folder, drawing, planes, least_area)


def write_structure(folder, name, truth, affine, kontur):
    write_truth(folder, truth, affine)
    points = voxel_points(truth, affine)
    least_area = np.linalg.norm(affine[:3, :3], axis=0).min() ** 2
    for drawing, planes in DRAWINGS.items():
        cut(kontur, folder, drawing, planes(points, random_for(name, drawing)), least_area)
    exact = json.loads((folder / "ortho3x3.json").read_text())
    (folder / "ortho3x3_hand.json").write_text(json.dumps(hands.by_hand(exact, "wave", 0, random_for(name, "hand"))))


def touches_border(mask):
    return any(mask.take(end, axis).any() for axis in range(3) for end in (0, -1))


def collect(maps, without, kontur):
    """{structure: (mask, affine, file)}, sorted by name."""
    found = {}
    for argument in maps:
        name, _, file = argument.partition("=")
        labels, affine = read_labels(pathlib.Path(file), kontur)
        for structure, mask in structures_of(name, labels):
            found[structure] = (mask, affine, file)
    for structure in without:
        if found.pop(structure, None) is None:
            sys.exit(f"structures.py: error: there is no {structure} to leave out, but {' '.join(sorted(found))}")
    return dict(sorted(found.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", nargs="+", metavar="NAME=LABELMAP")
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--output", required=True, type=pathlib.Path)
    parser.add_argument("--slices", action="store_true")
    parser.add_argument("--cut-off", action="store_true")
    parser.add_argument("--without", action="append", default=[], metavar="STRUCTURE")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    with open(options.output / "structures.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(FIELDS)
        for number, (name, (mask, affine, source)) in enumerate(
                collect(options.maps, options.without, options.kontur).items(), 1):
            split = "report" if number % 2 else "tune"
            if (options.slices or options.cut_off) and touches_border(mask) != options.cut_off:
                continue
            truth, grid, factors = truth_of(mask, affine, options.cut_off)
            folder = options.output / split / name
            if options.slices or options.cut_off:
                write_layers(folder, truth, grid, options.kontur)
            if not options.slices:
                write_structure(folder, name, truth, grid, options.kontur)
            volume = truth.sum() * abs(np.linalg.det(grid[:3, :3])) / 1000
            parts = ndimage.label(truth, np.ones((3, 3, 3)))[1]
            table.writerow([number, split, name, pathlib.Path(source).name, truth.sum(), f"{volume:.2f}", parts,
                            int(touches_border(mask)), "x".join(map(str, factors))])
            file.flush()
            print(f"{split}/{name}", file=sys.stderr)


if __name__ == "__main__":
    main()
