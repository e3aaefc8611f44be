#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the image between the contours is worth: structures cut by few planes, segmented without and with their image.

Usage: bench/images.py --program build/release/bin/kontur_images --csv FILE [--data SCANS] [--fresh FRESH] [--new NEW]
                       [--set tune|report|fresh|new] [--only NAME]... [--drawings "axial,5,exact;..."] [--share 3] [--jobs 1]
                       [--shift-mm 10 | --image noise | --image FILE] [--move-voxels 0.02]
       bench/images.py --csv FILE --tables

SCANS, FRESH and NEW are laid out as image_sources.py says; what is not there is left out, which is said. Of 30 drawings (axial,
orthogonal and oblique planes; 3, 4, 5, 7, 10 of them; exact and by hand) --share 3 takes every third, another third for the next
structure.

Images that know nothing of what is drawn should not be used. --shift-mm moves each by so much (along x and y, half of it along z);
--image noise, or the file of another patient, takes its place. (One of a single value is taken for an empty mask and never asked.)
--move-voxels measures steadiness instead: the share of the object that the result changes by when one contour moves so far.
Rows already in FILE are not measured again, so a run that was stopped goes on. --tables prints the tables of
docs/accuracy/image.md.
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

import image_sources

FIELDS = ["structure", "kind", "planes", "hand", "dice_without", "hd95_without_mm", "mean_without_mm", "dice", "hd95_mm",
          "mean_mm", "use", "error_without_mm", "error_with_mm", "largest_move_mm", "on_contours_voxels", "fit_cpu_s", "image_cpu_s"]

STEADINESS_FIELDS = ["structure", "kind", "planes", "hand", "change_without", "change"]


def command(program, data, name, words):
    if words[0] == "phantom":
        return [program, name, *words]
    if data is None:
        return None
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
    return [f"{kind},{count},{hand}" for kind in ("axial", "ortho", "oblique") for count in (3, 4, 5, 7, 10) for hand in ("exact", "hand")]


def begin(options):
    """The file's first line; a file of other columns is left as it is."""
    header = ",".join(STEADINESS_FIELDS if options.move_voxels else FIELDS) + "\n"
    if not options.csv.exists():
        options.csv.write_text(header, encoding="utf-8")
    elif not options.csv.read_text(encoding="utf-8").startswith(header):
        sys.exit(f"images.py: error: {options.csv} has other columns than these rows; name another file with --csv")


def measure(options):
    begin(options)
    done = {(row["structure"], f"{row['kind']},{row['planes']},{row['hand']}") for row in measured(options.csv)}
    sets = image_sources.sets()
    wanted = options.drawings.split(";") if options.drawings else all_drawings()
    tasks = []
    sources = [(options.data, item) for item in image_sources.scans().items()]
    sources += [(options.fresh, item) for item in image_sources.fresh().items()]
    sources += [(options.new, item) for item in image_sources.new().items()]
    for number, (data, (name, words)) in enumerate(sources):
        if (options.set and sets[name] != options.set) or (options.only and name not in options.only):
            continue
        missing = [drawing for drawing in wanted[number % options.share::options.share] if (name, drawing) not in done]
        call = command(options.program, data, name, words) if missing else None
        if call:
            tasks.append((call, ";".join(missing)))
    settings = {"KONTUR_IMAGES_SHIFT_MM": options.shift_mm, "KONTUR_IMAGES_OTHER": options.image,
                "KONTUR_IMAGES_MOVE_VOXELS": options.move_voxels}
    environment = os.environ | {name: str(value) for name, value in settings.items() if value}

    def run(task):
        call, drawings = task
        with open(options.csv, "a", encoding="utf-8") as file:
            result = subprocess.run(call, env=environment | {"KONTUR_IMAGES": drawings},
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
            f"{mean('mean_without_mm'):.2f} -> {mean('mean_mm'):.2f} | {sum(row['use'] in ('used', 'walked') for row in rows)} | "
            f"{sum(row['use'] == 'walked' for row in rows)} | "
            f"{mean('image_cpu_s'):.2f} |")


def steadiness(rows):
    print("| drawings | without: mean | largest | with: mean | median | largest |\n|---|---|---|---|---|---|")
    without, with_image = ([float(row[field]) for row in rows] for field in STEADINESS_FIELDS[-2:])
    print(f"| {len(rows)} | {statistics.fmean(without):.5f} | {max(without):.5f} | {statistics.fmean(with_image):.5f} | "
          f"{statistics.median(with_image):.5f} | {max(with_image):.5f} |")


def tables(options):
    rows, sets = measured(options.csv), image_sources.sets()
    if rows and "change" in rows[0]:
        return steadiness(rows)
    groups = collections.OrderedDict()
    for row in rows:
        which = sets[row["structure"]]
        for group in ("all", f"{row['planes']} planes, {row['hand']}", f"{row['kind']}, {row['hand']}"):
            groups.setdefault((which, group), []).append(row)
        if "sarcoma" in row["structure"]:
            groups.setdefault((which, "sarcomas"), []).append(row)
    print("| set, drawings | n | Dice without | with | mean gain | median | worst | worse by > .005 | by > .01 | mean distance mm | used | walked | CPU s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    for key in sorted(groups):
        print(line(", ".join(key), groups[key]))
    worst = sorted(rows, key=lambda row: float(row["dice"]) - float(row["dice_without"]))
    print("\n| worst and best | drawing | without | with | held-out error mm |\n|---|---|---|---|---|")
    for row in worst[:12] + worst[-8:]:
        print(f"| {row['structure']} ({sets[row['structure']]}) | {row['kind']} {row['planes']} {row['hand']} | {row['dice_without']} | "
              f"{row['dice']} | {row['error_without_mm']} -> {row['error_with_mm']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--fresh", type=pathlib.Path)
    parser.add_argument("--new", type=pathlib.Path)
    parser.add_argument("--share", type=int, default=1)
    parser.add_argument("--csv", type=pathlib.Path, required=True)
    parser.add_argument("--set", choices=["tune", "report", "fresh", "new"])
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--drawings", default="")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shift-mm", type=float, default=0)
    parser.add_argument("--image", default="")
    parser.add_argument("--move-voxels", type=float, default=0)
    parser.add_argument("--tables", action="store_true")
    options = parser.parse_args()
    if not options.tables:
        measure(options)
    tables(options)


if __name__ == "__main__":
    main()
