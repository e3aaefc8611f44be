#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether every second slice of real structure sets was itself made by interpolation: docs/fill.md.

Usage: bench/interpolated_slices.py DATA --kontur build/release/bin/kontur

Prints for each structure how far shape-based interpolation misses slices 2, 4, ... between 1, 3, ..., and the other way round:
the mean over the slices of the area that is wrong by the length of the outline, in voxels of the slice, with its standard
error. Slices that somebody drew are missed alike; those that a program filled in are hardly missed at all.
"""
import argparse
import pathlib

import numpy as np

import organ_sources
import slices
import structures


def outline_length(section):
    return sum(np.abs(np.diff(section.astype(int), axis=axis)).sum() for axis in range(2))


def misses(truth, kept, spacing):
    filled = slices.shape_based(truth, kept, spacing)
    between = [k for k in range(kept[0], kept[-1]) if k not in kept]
    return np.array([(filled[:, :, k] ^ truth[:, :, k]).sum() / outline_length(truth[:, :, k]) for k in between])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    options = parser.parse_args()
    print("| structure | slices 2, 4, ... | slices 3, 5, ... |\n|---|--:|--:|")
    for name, (mask, affine, _, _) in organ_sources.structure_sets(options.data, options.kontur).items():
        truth, grid, _ = structures.truth_of(mask, affine)
        spacing = np.linalg.norm(grid[:3, :3], axis=0)
        cells = [misses(truth, slices.kept(truth, 2, start), spacing) for start in (0, 1)]
        print(f"| {name} | " + " | ".join(f"{each.mean():.2f} ± {each.std() / len(each) ** 0.5:.2f}" for each in cells) + " |", flush=True)


if __name__ == "__main__":
    main()
