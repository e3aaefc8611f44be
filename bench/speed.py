#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two builds of kontur in turns on the same work: processor time, and whether the masks are the same.

Usage: bench/speed.py BEFORE AFTER (--repeat N, --more DRAWING=IMAGE ..., --fill LABELS:EVERY ..., --only WORD)

BEFORE and AFTER are two programs `kontur`. The drawings are the phantom's. --more adds others; --fill takes a label map of
which every EVERY-th slice is kept. Ratios are of user and system time, so that other programs hardly matter: the median of
those of neighbouring runs, and between which two the middle half of them lies.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import nibabel
import numpy

PHANTOM = [("liver_orthogonal14", "liver_ct"), ("liver_orthogonal14_hand", "liver_ct"), ("liver_oblique10_hand", "liver_ct"),
           ("metastasis_parallel17_hand", "metastasis_ct"), ("metastasis_parallel7_hand", "metastasis_ct"),
           ("vertebra_parallel11_hand", "abdomen_ct"), ("kidney_radial6_hand", "abdomen_ct")]
WITH_IMAGE = ["liver_orthogonal14_hand", "metastasis_parallel7_hand"]


def used(words):
    """Processor and wall seconds, and the peak of memory in MB."""
    before = os.times().elapsed
    process = subprocess.Popen([str(word) for word in words])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{' '.join(map(str, words))} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime, os.times().elapsed - before, usage.ru_maxrss / 1024


def jaccard(a, b):
    """Of labels: of voxels that have one in either map, those that have the same in both."""
    either = (a != 0) | (b != 0)
    return numpy.count_nonzero((a == b) & either) / max(numpy.count_nonzero(either), 1)


def quartiles(ratios):
    ordered = sorted(ratios)
    return ordered[len(ordered) // 4], ordered[-1 - len(ordered) // 4]


def kept(path, every, folder):
    """The map with every so many-th slice of those that have labels."""
    image = nibabel.load(path)
    labels = numpy.asarray(image.dataobj).copy()
    for k in range(labels.shape[2]):
        if k % every:
            labels[:, :, k] = 0
    out = folder / f"{path.name.split('.')[0]}_{every}.nii"
    nibabel.save(nibabel.Nifti1Image(labels.astype(numpy.uint8), image.affine), out)
    return out


def rows_of(options, folder):
    """(name, words of the command without the output)."""
    phantom = folder / "phantom"
    subprocess.run([options.after, "phantom", phantom, "--quiet"], check=True)
    drawings = [(phantom / f"{name}.json", phantom / f"{image}.nii.gz") for name, image in PHANTOM]
    drawings += [tuple(pathlib.Path(part) for part in pair.split("=")) for pair in options.more]
    plain = [(drawing.stem, ["segment", drawing, "--image", image, "--use-image", "off"]) for drawing, image in drawings]
    asked = [(f"{drawing.stem}, image", ["segment", drawing, "--image", image]) for drawing, image in drawings if drawing.stem in WITH_IMAGE]
    fills = []
    for pair in options.fill:
        path, every = pair.rsplit(":", 1)
        fills.append((f"fill {pathlib.Path(path).name.split('.')[0]}, 1 in {every}", ["fill", kept(pathlib.Path(path), int(every), folder)]))
    return [row for row in plain + asked + fills if options.only in row[0]]


def measure(options, words, folder):
    outputs = [folder / "before.nii.gz", folder / "after.nii.gz"]
    common = [*words, "--quiet", "--threads", options.threads]
    runs = [[used([program, *common, "--output", out]) for program, out in zip((options.before, options.after), outputs)]
            for _ in range(options.repeat)]
    masks = [numpy.asarray(nibabel.load(out).dataobj) for out in outputs]
    ratios = [after[0] / before[0] for before, after in runs]
    low, high = quartiles(ratios)
    return {"before_s": statistics.median(run[0][0] for run in runs), "after_s": statistics.median(run[1][0] for run in runs),
            "ratio": statistics.median(ratios), "low": low, "high": high,
            "wall_ratio": statistics.median(after[1] / before[1] for before, after in runs),
            "memory_ratio": statistics.median(after[2] / before[2] for before, after in runs), "jaccard": jaccard(*masks)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("before", "after"):
        parser.add_argument(name, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--more", nargs="+", default=[], metavar="DRAWING=IMAGE")
    parser.add_argument("--fill", nargs="+", default=[], metavar="LABELS:EVERY")
    parser.add_argument("--only", default="", metavar="WORD", help="rows whose names have it")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    options = parser.parse_args()
    table = {}
    print("| command | before, CPU s | after | ratio (middle half) | wall | memory | Jaccard |\n| --- | --: | --: | --: | --: | --: | --: |")
    with tempfile.TemporaryDirectory() as name:
        for row, words in rows_of(options, pathlib.Path(name)):
            m = table[row] = measure(options, words, pathlib.Path(name))
            print(f"| {row} | {m['before_s']:.2f} | {m['after_s']:.2f} | {m['ratio']:.2f} ({m['low']:.2f} to {m['high']:.2f}) | "
                  f"{m['wall_ratio']:.2f} | {m['memory_ratio']:.2f} | {m['jaccard']:.6f} |", flush=True)
    ratios = [m["ratio"] for m in table.values()]
    print(f"| geometric mean | | | {statistics.geometric_mean(ratios):.2f} | | | |")
    if options.json:
        options.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
