#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lets kontur_annotators draw every structure in every way, by one protocol, and goes on where it was stopped.

Usage: bench/annotators/draw.py --program build/release/bin/kontur_annotators --states STATES.jsonl TRUTHS/*/*
                                [--ways suggestion axial ...] [--hand exact|unsteady] [--with-image] [--sample-step 5] [--most-planes 13]

Folders are what truths.py wrote. One way of one structure after another, all structures in the first way first, so that whatever
was done when it is stopped can be compared. States are appended when a way of a structure is whole; what STATES.jsonl has is not
drawn again. A structure that cannot be drawn is named and left out.
"""
import argparse
import json
import pathlib
import subprocess
import sys

WAYS = ("suggestion", "axial", "random oblique", "orthogonal", "axial, re-spaced", "MITK's rule", "suggested slices", "rule, then random")


def drawn(states):
    if not states.exists():
        return set()
    rows = map(json.loads, states.read_text(encoding="utf-8").splitlines())
    return {(row["structure"], row["way"], row["hand"]) for row in rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--states", required=True, type=pathlib.Path)
    parser.add_argument("--ways", nargs="+", default=list(WAYS), choices=WAYS)
    parser.add_argument("--hand", default="exact", choices=("exact", "unsteady"))
    parser.add_argument("--with-image", action="store_true")
    parser.add_argument("--sample-step", default=5, type=int)
    parser.add_argument("--most-planes", default=13, type=int)
    options = parser.parse_args()
    done = drawn(options.states)
    protocol = ["--sample-step", str(options.sample_step), "--most-planes", str(options.most_planes)]
    for way in options.ways:
        for folder in options.folders:
            if (folder.name, way + ", image" * options.with_image, options.hand) in done:
                continue
            if options.with_image and not (folder / "image.nii.gz").exists():
                continue
            call = [options.program, folder, "--way", way, *protocol, *(["--by-hand"] if options.hand == "unsteady" else []),
                    *(["--with-image"] if options.with_image else [])]
            result = subprocess.run(call, stdout=subprocess.PIPE, text=True)
            if result.returncode:
                print(f"draw.py: {folder.name}, {way}: left out", file=sys.stderr)
                continue
            with open(options.states, "a", encoding="utf-8") as file:
                file.write(result.stdout)


if __name__ == "__main__":
    main()
