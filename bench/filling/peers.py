# SPDX-License-Identifier: Apache-2.0
"""What users of interpolation between slices complain of: memory, and slices that do not overlap.

`large` fills two balls of 0.4 N voxels across in N x N x 2/3 N voxels, painted on every twelfth slice, and prints CPU seconds, the
most memory of the process and Dice between the first and the last painted slice. `tubes` fills tubes of 12 mm across that run
aslant through slices 1 mm apart, of which every eighth was painted, and prints Dice between the first and the last of them and in
how many pieces the result falls, by how far the sections of one and the next painted slice lie apart.
"""
import pathlib
import subprocess
import sys
import tempfile

import nibabel
import numpy as np
from scipy import ndimage

import slices
from filling import methods

TUBE_RADIUS, TUBE_STEP = 6, 8  # mm


# Starts a program from a small process: a process's largest memory counts from what its parent had when it began.
LAUNCHER = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
"""


def measured(command):
    """CPU seconds and MB at most."""
    launched = subprocess.run([sys.executable, "-c", LAUNCHER, *map(str, command)], check=True, capture_output=True, text=True)
    return [float(word) for word in launched.stdout.split()]


def ball(shape, middle, radius):
    axes = np.ogrid[tuple(slice(n) for n in shape)]
    return sum((axis - m) ** 2 for axis, m in zip(axes, middle)) < radius**2


def large(options):
    n = options.size
    shape = (n, n, 2 * n // 3)
    truth = ball(shape, (0.28 * n, 0.5 * n, n / 3), 0.2 * n) | ball(shape, (0.72 * n, 0.45 * n, n / 3), 0.2 * n)
    kept = slices.occupied(truth)[::12]
    print(f"\n| {shape[0]} x {shape[1]} x {shape[2]} voxels | CPU s | MB | Dice |\n|---|--:|--:|--:|")
    with tempfile.TemporaryDirectory(dir=options.scratch) as folder:
        sparse, full = pathlib.Path(folder, "sparse.nii"), pathlib.Path(folder, "full.nii")
        nibabel.save(nibabel.Nifti1Image(methods.sparse_map(truth, kept), np.eye(4)), sparse)
        truth = truth[:, :, kept[0]:kept[-1] + 1]
        commands = {"kontur fill": [options.kontur, "fill", sparse, "--output", full, "--threads", "1", "--quiet"]}
        if options.itk:
            commands |= {"ITK": [options.itk, sparse, full], "ITK --dilations": [options.itk, sparse, full, "--dilations"]}
        for name, command in commands.items():
            seconds, megabytes = measured(command)
            made = np.asarray(nibabel.load(full).dataobj[:, :, kept[0]:kept[-1] + 1]) > 0
            print(f"| {name} | {seconds:.1f} | {megabytes:.0f} | {2 * (made & truth).sum() / (made.sum() + truth.sum()):.4f} |", flush=True)


def tube(shift):
    """Its section moves by `shift` mm from slice to slice."""
    x, y, k = np.ogrid[:140, :40, :57]
    return (x - 70 - shift * (k - 28)) ** 2 + (y - 20) ** 2 < TUBE_RADIUS**2


def tubes(options):
    made = {"shape-based": lambda truth, kept: slices.shape_based(truth, kept, (1, 1, 1))}
    for words in ("", "--dilations") if options.itk else ():
        made[f"ITK {words}".strip()] = lambda truth, kept, words=words: methods.filled_by_itk(
            options.itk, methods.sparse_map(truth, kept), np.eye(4), words.split())
    made["kontur fill"] = lambda truth, kept: methods.filled(options.kontur, methods.sparse_map(truth, kept), np.eye(4)) > 0
    print("\n| from section to section, in diameters | " + " | ".join(made) + " |\n|--:|" + "---|" * len(made))
    for apart in (0.25, 0.5, 0.75, 1.0, 1.25):
        truth = tube(apart * 2 * TUBE_RADIUS / TUBE_STEP)
        kept = np.arange(0, truth.shape[2], TUBE_STEP)
        masks = [make(truth, kept) for make in made.values()]
        cells = [f"{2 * (mask & truth).sum() / (mask.sum() + truth.sum()):.3f} in {ndimage.label(mask)[1]}" for mask in masks]
        print(f"| {apart:.2f} | " + " | ".join(cells) + " |", flush=True)


def add_arguments(parser):
    parser.add_argument("--only", choices=["large", "tubes"])
    parser.add_argument("--size", type=int, default=900, metavar="N")
    parser.add_argument("--scratch", type=pathlib.Path, help="where the large maps are written")


def run(options):
    for name, measure in (("tubes", tubes), ("large", large)):
        if options.only in (None, name):
            measure(options)
