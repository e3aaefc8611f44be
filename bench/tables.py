#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Markdown tables from kontur_bench's JSON, beside the figures of Heckel, Konrad & Peitgen 2010.

Usage: bench/tables.py RESULTS.json [DOCUMENT.md]. Without a document the tables are printed; with one, each replaces what
stands between its markers <!-- begin NAME --> and <!-- end NAME --> there.
"""
import json
import re
import sys

# Solve times in s of dsysv (MKL) by threads: the paper's Table 1, on an 8-core machine with two Xeon X5550.
PAPER_SOLVE = {"metastasis": (6246, {1: 10.01, 2: 5.74, 8: 2.89}), "liver": (13796, {1: 103.97, 2: 55.98, 8: 23.42})}
# Surface voxels, and voxelization times in s by threads: Table 2.
PAPER_VOXELIZE = {"metastasis": (23541, {1: 4.15, 2: 2.49, 4: 1.92}), "liver": (169300, {1: 62.45, 2: 33.64, 4: 28.95})}
# n, solve, voxelize and total time in s (8 and 4 threads), Jaccard index in percent, by q: Table 3.
PAPER_REDUCTION = {
    "metastasis": {
        1.0: (6246, 2.89, 1.92, 5.13, 100),
        0.5: (3608, 0.75, 1.18, 2.08, 99.94),
        0.2: (1410, 0.08, 0.55, 0.67, 99.32),
        0.1: (710, 0.02, 0.36, 0.41, 97.05),
    },
    "liver": {
        1.0: (13796, 23.42, 28.95, 53.28, 100),
        0.5: (7916, 4.94, 16.79, 21.94, 99.50),
        0.2: (3170, 0.5, 7.3, 7.82, 98.74),
        0.1: (1594, 0.1, 8.3, 8.41, 97.68),
    },
}
SOLVERS = {
    "dense": "dsysv (Eq. 6 as printed)",
    "cholesky": "projected Cholesky",
    "iterative": "iterative (default)",
}
NORMALS = {"in-plane": "paper (in-plane)", "surface": "default (surface)"}


def organ(case):
    return case.split("_")[0]


def case_name(case):
    return organ(case) + (", by hand" if case.endswith("_hand") else "")


def seconds(value):
    return f"{value:.3f}" if value < 0.1 else f"{value:.2f}" if value < 10 else f"{value:.1f}"


def count(value):
    return f"{value:,}"


def percent(share):
    return f"{100 * share:.2f}"


def precise_percent(share):
    """Empty for results from before it was measured."""
    return "" if share is None else f"{100 * share:.4f}"


def table(header, rows):
    """A Markdown table; columns are right-aligned where the last row's cell starts with a digit."""
    align = ["--:" if re.match(r"\d", str(cell)) else "---" for cell in rows[-1]]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [header, align, *rows])


def machine(results):
    m = results["machine"]
    return table(
        ["", ""],
        [
            ["processor", f"{m['cpu']}, {m['cores']} cores"],
            ["load average before", f"{m['load_before']:.1f}"],
            ["compiler", f"g++ {m['compiler']}, {m['build_type']}"],
            ["BLAS", f"OpenBLAS {m['blas'].split()[1]}, {m['blas_kernels']} kernels"],
        ],
    )


def solving(results):
    rows = []
    for case in unique(results["solving"], "case"):
        n, paper = PAPER_SOLVE[organ(case)]
        mine = [row for row in results["solving"] if row["case"] == case]
        dense = next(row["cpu_s"] for row in mine if row["solver"] == "dense")
        for threads, time in paper.items():
            rows.append([case_name(case), count(n), "paper: dsysv (MKL)", threads, seconds(time), "", "", "", ""])
        for row in mine:
            rows.append([
                case_name(case), count(row["n"]), SOLVERS[row["solver"]], row["threads"], seconds(row["seconds"]),
                seconds(row["cpu_s"]), f"{dense / row['cpu_s']:.1f}", row["iterations"] or "", f"{row['residual_mm']:.1g}",
            ])
    header = [
        "case", "n", "solver", "threads", "seconds", "CPU s", "times less CPU than dsysv", "iterations",
        "largest residual, mm",
    ]
    return table(header, rows)


def voxelizing(results):
    rows = []
    for case in unique(results["voxelizing"], "case"):
        cells, paper = PAPER_VOXELIZE[organ(case)]
        for threads, time in paper.items() if not case.endswith("_hand") else ():
            rows.append([case_name(case), "paper", "tracked", threads, seconds(time), "", "", count(cells), "", ""])
        for row in (row for row in results["voxelizing"] if row["case"] == case):
            rows.append([
                case_name(case), NORMALS[row["normals"]], row["voxelizer"], row["threads"], seconds(row["seconds"]),
                seconds(row["cpu_s"]), count(row["evaluations"]), count(row["surface_cells"]),
                precise_percent(row.get("jaccard_exhaustive")),
                # The adaptive search takes most of its values from near centres alone.
                f"{row['evaluations'] * row['centres'] / row['cpu_s'] / 1e9:.2f}" if row["voxelizer"] != "adaptive" else "",
            ])
    header = [
        "case", "normals", "search", "threads", "seconds", "CPU s", "evaluations of f", "surface cells",
        "Jaccard to exhaustive, %", "10^9 kernel values / CPU s",
    ]
    return table(header, rows)


def reduction(results):
    rows = []
    for row in results["reduction"]:
        n, solve, voxelize, total, overlap = PAPER_REDUCTION[organ(row["case"])][row["quality"]]
        rows.append([
            case_name(row["case"]), row["configuration"], row["quality"], count(row["centres"]),
            " / ".join(seconds(row[key]) for key in ("fit_s", "voxelize_s", "total_s")),
            percent(row["jaccard"]), percent(row["dice_truth"]),
            count(n), f"{solve} / {voxelize} / {total}", f"{overlap:.2f}",
        ])
    header = [
        "case", "configuration", "q", "centres", "fit / voxelize / total, s", "Jaccard to q = 1, %", "Dice to truth, %",
        "paper: n", "paper: solve / voxelize / total, s", "paper: Jaccard, %",
    ]
    return table(header, rows)


def end_to_end(results):
    rows = []
    for case in unique(results["end_to_end"], "case"):
        mine = [row for row in results["end_to_end"] if row["case"] == case]
        for row in mine:
            rows.append([
                case_name(case), row["pipeline"], count(row["centres"]), row["solves"], seconds(row["total_s"]),
                f"{row['total_s'] / mine[0]['total_s']:.1f}", seconds(row["cpu_s"]), f"{row['cpu_s'] / mine[0]['cpu_s']:.1f}",
                f"{row['peak_mb']:.0f}" if row["peak_mb"] else "", percent(row["dice_truth"]),
                precise_percent(row.get("jaccard_exact")),
            ])
    header = [
        "case", "pipeline", "centres", "solves", "seconds", "times default", "CPU s", "times default", "peak memory, MB",
        "Dice to truth, %", "Jaccard to exact, %",
    ]
    return table(header, rows)


def editing(results):
    rows = [
        [
            case_name(row["case"]), row["edits"], seconds(row["median_s"]), seconds(row["rank_90_s"]), seconds(row["cpu_s"]),
            percent(row["within_half_mm"]), f"{row['largest_mm']:.2f}",
        ]
        for row in results["editing"]
    ]
    header = [
        "case", "edits", "median, s", "nine of ten within, s", "CPU s", "within 0.5 mm of the finished surface, %",
        "largest distance, mm",
    ]
    return table(header, rows)


def stages(results):
    rows = []
    for row in (row for row in results["end_to_end"] if row["pipeline"] == "default"):
        shares = [f"{seconds(time)} ({100 * time / row['total_s']:.0f} %)" for time in row["stages_s"].values()]
        rows.append([case_name(row["case"]), *shares, seconds(row["total_s"])])
    names = list(results["end_to_end"][0]["stages_s"])
    return table(["case", *(f"{name}, s" for name in names), "total, s"], rows)


def unique(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


TABLES = {f.__name__: f for f in (machine, solving, voxelizing, reduction, end_to_end, stages, editing)}


def filled(document, results):
    for name, make in TABLES.items():
        begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
        if begin not in document:
            raise SystemExit(f"tables.py: the document has no marker {begin}")
        head, rest = document.split(begin, 1)
        document = f"{head}{begin}\n{make(results)}\n{end}{rest.split(end, 1)[1]}"
    return document


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)
    if len(sys.argv) < 3:
        print("\n\n".join(make(results) for make in TABLES.values()))
        return
    with open(sys.argv[2], encoding="utf-8") as file:
        document = filled(file.read(), results)
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(document)


if __name__ == "__main__":
    main()
