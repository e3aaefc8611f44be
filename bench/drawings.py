#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/accuracy/drawings.md from what kontur_accuracy measured.

Usage: bench/drawings.py csv RESULTS.json > bench/results/drawings.csv
       bench/drawings.py tables bench/results/drawings.csv [DOCUMENT.md]

Tables are printed or, with a document, replace what stands between its markers <!-- begin NAME --> and <!-- end NAME --> there.
"""
import argparse
import csv
import json
import pathlib
import sys

from tables import filled, table

FITS = ("kontur", "paper", "true_tilts")
MEASURES = {"dice": ("dice", 4), "hd95_mm": ("hausdorff95_mm", 1), "mean_mm": ("mean_surface_distance_mm", 2)}
PHANTOM = "phantom"


def flat(row):
    """A line of the CSV; a cell is empty where nothing was measured."""
    cells = {name: row[name] for name in ("object", "drawing", "contours")}
    for fit in FITS:
        for name, (measure, digits) in MEASURES.items():
            value = row.get(fit, {}).get(measure)
            cells[f"{fit}_{name}"] = "" if value is None else f"{value:.{digits}f}"
    degrees = row.get("normal_error_degrees")
    return cells | {"normal_error_degrees": "" if degrees is None else f"{degrees:.2f}"}


def digits(text, count):
    return f"{float(text):.{count}f}".removeprefix("0") if text else "-"


def real_table(rows):
    """Dice of kontur, in brackets the paper's, of the drawings that all objects have."""
    objects = {}
    for row in (row for row in rows if row["object"] != PHANTOM):
        objects.setdefault(row["object"], {})[row["drawing"]] = f"{digits(row['kontur_dice'], 3)} ({digits(row['paper_dice'], 3)})"
    drawings = list(next(iter(objects.values())))
    return table(["object", *drawings], [[name, *(own.get(drawing, "-") for drawing in drawings)] for name, own in objects.items()])


def phantom_table(rows):
    lines = [[row["drawing"], digits(row["kontur_dice"], 4), digits(row["true_tilts_dice"], 4), digits(row["paper_dice"], 3),
              row["normal_error_degrees"]] for row in rows if row["object"] == PHANTOM]
    return table([PHANTOM, "kontur", "true tilts", "paper", "error of the normals, degrees"], lines)


TABLES = {"real_drawings": real_table, "phantom_drawings": phantom_table}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=["csv", "tables"])
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("document", type=pathlib.Path, nargs="?")
    options = parser.parse_args()
    with open(options.results, newline="", encoding="utf-8") as file:
        if options.command == "csv":
            rows = [flat(row) for row in json.load(file)]
            output = csv.DictWriter(sys.stdout, rows[0], lineterminator="\n")
            output.writeheader()
            output.writerows(rows)
            return
        rows = list(csv.DictReader(file))
    if options.document:
        options.document.write_text(filled(options.document.read_text(encoding="utf-8"), rows, TABLES), encoding="utf-8")
    else:
        print("\n\n".join(make(rows) for make in TABLES.values()))


if __name__ == "__main__":
    main()
