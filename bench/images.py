#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the image between the contours is worth: structures cut by few planes, segmented without and with their image.

Usage: bench/images.py --program build/release/bin/kontur_images --data FOLDER --csv FILE [--set tune|report] [--only NAME]...
                       [--drawings "axial,5,exact;..."] [--methods gated,ungated] [--jobs 1]
       bench/images.py --csv FILE --tables

FOLDER is laid out as the scans of bench/organ_sources.py; what is not there is left out, which is said. Objects are sorted by
name; the first, third, ... are to report on, the second, fourth, ... to choose constants on; images of one object go together.
Rows already in FILE are not measured again. With --tables the tables of docs/accuracy.md are printed.
"""
import argparse
import collections
import concurrent.futures
import csv
import os
import pathlib
import statistics
import subprocess
import sys

ABDOMEN = "01_ct_abdomen_totalseg_3mm/"
BRAIN = "06_mr_brain_MRIcrop/"
CINE = "10_cine_mr_SC-HF-I-1/"
# Every label of at least 300 voxels; vertebrae are whole in the map of their own.
ABDOMEN_LABELS = [1, 2, 3, 4, 5, 6, 7, 11, 14, 18, 19, 20, 52, 63, 64, 79, 86, 87, 88, 89, 117]
FIELDS = ["structure", "kind", "planes", "hand", "method", "dice_without", "hd95_without_mm", "mean_without_mm", "dice", "hd95_mm",
          "mean_mm", "use", "error_without_mm", "error_with_mm", "largest_move_mm", "on_contours_voxels", "fit_cpu_s", "refine_cpu_s"]


def structures():
    """{structure: (object, words for kontur_images)}; files relative to the data."""
    found = {f"abdomen_{label:03d}": (ABDOMEN + "example_ct_sm.nii.gz", ABDOMEN + "example_seg.nii.gz", str(label))
             for label in ABDOMEN_LABELS}
    found |= {f"vertebra_{label:03d}": (ABDOMEN + "example_ct.nii.gz", ABDOMEN + "vertebrae_on_example_ct.nii.gz", str(label))
              for label in range(26, 33)}
    found |= {f"brain_{label:03d}": (BRAIN + "MRIcrop-orig.nii.gz", BRAIN + "MRIcrop-seg.nii.gz", str(label))
              for label in range(1, 9)}
    for number, patient in ("03", "002"), ("04", "040"), ("05", "008"):
        for modality in "CT", "MR_T1":
            folder = f"{number}_sarcoma_STS_{patient}/{modality}/"
            found[f"sarcoma{patient}/{modality}"] = (folder + "image", folder + f"{modality}_mask.nii.gz", "")
    found["tumour"] = ("07_mr_brain_tumour_brain1/brain1_image.nrrd", "07_mr_brain_tumour_brain1/brain1_label.nrrd", "")
    found["cord"] = ("13_mr_spinal_cord_t2/t2.nii.gz", "13_mr_spinal_cord_t2/t2_seg-manual.nii.gz", "")
    for wall in "endo", "epi":
        found[f"ventricle_{wall}"] = (CINE + "cine4d_crop.nii.gz", CINE + f"mask_ED_{wall}.nii.gz", "", "0")
    found |= {f"phantom_{organ}": ("phantom", organ, spacing)
              for organ, spacing in (("liver", "3"), ("kidney", "1.5"), ("metastasis", "1"), ("vertebra", "1.5"))}
    return dict(sorted((name, (name.split("/")[0], words)) for name, words in found.items()))


def sets():
    """{structure: "report" or "tune"}."""
    objects = sorted({own for own, _ in structures().values()})
    return {name: ("tune" if objects.index(own) % 2 else "report") for name, (own, _) in structures().items()}


def command(program, data, name, words):
    if words[0] == "phantom":
        return [program, name, *words]
    files = [data / word for word in words[:2]]
    missing = [file for file in files if not file.exists()]
    if missing:
        print(f"images.py: {missing[0]} is not there and left out", file=sys.stderr)
        return None
    return [program, name, *files, *words[2:]]


def measured(file):
    if not file.exists():
        return []
    with open(file, newline="", encoding="utf-8") as rows:
        return list(csv.DictReader(rows))


def all_drawings():
    return [f"{kind},{count},{hand}" for kind in ("axial", "ortho", "oblique") for count in (3, 5, 7, 10) for hand in ("exact", "hand")]


def measure(options):
    done = {(row["structure"], f"{row['kind']},{row['planes']},{row['hand']}") for row in measured(options.csv)}
    wanted = options.drawings.split(";") if options.drawings else all_drawings()
    tasks = []
    for name, (_, words) in structures().items():
        if (options.set and sets()[name] != options.set) or (options.only and name not in options.only):
            continue
        missing = [drawing for drawing in wanted if (name, drawing) not in done]
        call = command(options.program, options.data, name, words) if missing else None
        if call:
            tasks.append((call, ";".join(missing)))
    if not options.csv.exists():
        options.csv.write_text(",".join(FIELDS) + "\n", encoding="utf-8")

    def run(task):
        call, drawings = task
        with open(options.csv, "a", encoding="utf-8") as file:
            result = subprocess.run(call, env=os.environ | {"KONTUR_IMAGES": drawings, "KONTUR_IMAGES_METHODS": options.methods},
                                    stdout=subprocess.PIPE, text=True)
            file.write(result.stdout)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(run, tasks))


def line(name, rows):
    gains = [float(row["dice"]) - float(row["dice_without"]) for row in rows]

    def mean(field):
        return statistics.fmean(float(row[field]) for row in rows if row[field])
    return (f"| {name} | {len(rows)} | {mean('dice_without'):.4f} | {mean('dice'):.4f} | {statistics.fmean(gains):+.4f} | "
            f"{statistics.median(gains):+.4f} | {min(gains):+.4f} | {sum(g < -0.005 for g in gains)} | {sum(g < -0.01 for g in gains)} | "
            f"{mean('mean_without_mm'):.2f} -> {mean('mean_mm'):.2f} | {sum(row['use'] == 'used' for row in rows)} | "
            f"{mean('refine_cpu_s'):.2f} |")


def tables(options):
    rows = measured(options.csv)
    groups = collections.OrderedDict()
    for row in rows:
        if row["method"] not in options.methods.split(","):
            continue
        which = sets()[row["structure"]]
        for group in ("all", f"{row['planes']} planes, {row['hand']}", f"{row['kind']}, {row['hand']}"):
            groups.setdefault((row["method"], which, group), []).append(row)
        if row["structure"].startswith("sarcoma"):
            groups.setdefault((row["method"], which, "sarcomas"), []).append(row)
    print("| set, drawings | n | Dice without | with | mean gain | median | worst | worse by > .005 | by > .01 | mean distance mm | used | CPU s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for key in sorted(groups):
        print(line(", ".join(key), groups[key]))
    worst = sorted((row for row in rows if row["method"] == "gated"), key=lambda row: float(row["dice"]) - float(row["dice_without"]))
    print("\n| worst and best | drawing | without | with | held-out error mm |\n|---|---|---|---|---|")
    for row in worst[:12] + worst[-8:]:
        print(f"| {row['structure']} ({sets()[row['structure']]}) | {row['kind']} {row['planes']} {row['hand']} | {row['dice_without']} | "
              f"{row['dice']} | {row['error_without_mm']} -> {row['error_with_mm']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--csv", type=pathlib.Path, required=True)
    parser.add_argument("--set", choices=["tune", "report"])
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--drawings", default="")
    parser.add_argument("--methods", default="gated")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--tables", action="store_true")
    options = parser.parse_args()
    if not options.tables:
        measure(options)
    tables(options)


if __name__ == "__main__":
    main()
