#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Markdown tables from kontur_bench's JSON, beside the figures of Heckel, Konrad & Peitgen 2010.

Usage: bench/tables.py RESULTS.json [DOCUMENT.md]. Without a document the tables are printed; with one, each that has markers
<!-- begin NAME --> and <!-- end NAME --> there replaces what stands between them.
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


def by_hand(case):
    return case.endswith("_hand")


def by_threads(rows, keys, choose):
    """Of rows that differ in the number of threads alone the one that `choose` (min or max) takes."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return [choose(group, key=lambda row: row["threads"]) for group in groups.values()]


def solving(results):
    """With the most threads; of the paper with the fewest, too. A case's name has the number of unknowns."""
    rows = []
    for case in unique(results["solving"], "case"):
        n, paper = PAPER_SOLVE[organ(case)]
        for threads in (min(paper), max(paper)):
            rows.append([f"{case_name(case)}, {count(n)}", "paper: dsysv (MKL)", threads, seconds(paper[threads]), "", "", ""])
        mine = [row for row in results["solving"] if row["case"] == case]
        for row in by_threads(mine, ["solver"], max):
            rows.append([
                f"{case_name(case)}, {count(row['n'])}", SOLVERS[row["solver"]], row["threads"], seconds(row["seconds"]),
                seconds(row["cpu_s"]), row["iterations"] or "", f"{row['residual_mm']:.1g}",
            ])
    return table(["case, n", "solver", "threads", "seconds", "CPU s", "iterations", "largest residual, mm"], rows)


def voxelizing(results):
    """Exact drawings with the fewest threads. The paper's normals are shown with its search, kontur's with every search."""
    rows = []
    for case in (case for case in unique(results["voxelizing"], "case") if not by_hand(case)):
        cells, paper = PAPER_VOXELIZE[organ(case)]
        rows.append([case_name(case), "paper", "tracked", min(paper), seconds(paper[min(paper)]), "", count(cells)])
        mine = [row for row in results["voxelizing"] if row["case"] == case]
        for row in by_threads(mine, ["normals", "voxelizer"], min):
            if row["normals"] == "surface" or row["voxelizer"] == "tracked":
                rows.append([
                    case_name(case), NORMALS[row["normals"]], row["voxelizer"], row["threads"], seconds(row["cpu_s"]),
                    count(row["evaluations"]), count(row["surface_cells"]),
                ])
    return table(["case", "normals", "search", "threads", "CPU s", "values of f", "surface cells"], rows)


def reduction(results):
    """Exact drawings: total time, Jaccard index to q = 1 and Dice with the truth."""
    rows = []
    exact = [row for row in results["reduction"] if not by_hand(row["case"])]
    for case in unique(exact, "case"):
        for quality in unique(exact, "quality"):
            _, _, _, total, overlap = PAPER_REDUCTION[organ(case)][quality]
            cells = [case_name(case), quality, seconds(total), f"{overlap:.2f}"]
            for configuration in ("paper", "default"):
                row = next(r for r in exact if (r["case"], r["quality"], r["configuration"]) == (case, quality, configuration))
                cells += [seconds(row["total_s"]), percent(row["jaccard"]), percent(row["dice_truth"])]
            rows.append(cells)
    header = ["case", "q", "paper: s", "Jaccard, %", "as printed: s", "Jaccard, %", "Dice, %", "default: s", "Jaccard, %", "Dice, %"]
    return table(header, rows)


def end_to_end(results):
    """Exact drawings."""
    rows = [
        [
            case_name(row["case"]), row["pipeline"], count(row["centres"]), seconds(row["total_s"]), seconds(row["cpu_s"]),
            f"{row['peak_mb']:.0f}" if row["peak_mb"] else "", percent(row["dice_truth"]), precise_percent(row.get("jaccard_exact")),
        ]
        for row in results["end_to_end"] if not by_hand(row["case"]) and row["pipeline"] != "default, tight"
    ]
    return table(["case", "pipeline", "centres", "seconds", "CPU s", "memory, MB", "Dice, %", "Jaccard to exact, %"], rows)


def editing(results):
    rows = [
        [
            case_name(row["case"]), row["edits"], seconds(row["median_s"]), seconds(row["rank_90_s"]), seconds(row["cpu_s"]),
            percent(row["within_half_mm"]), f"{row['largest_mm']:.2f}",
        ]
        for row in results["editing"]
    ]
    header = [
        "case", "edits", "median, s", "nine of ten within, s", "CPU s", "within 0.5 mm, %", "largest distance, mm",
    ]
    return table(header, rows)


WHAT_CORRECTING = {"opened": "opened", "edited": "edited", "anew": "edited, nothing kept"}


def correcting(results):
    rows = [[f"{case_name(row['case'])} {WHAT_CORRECTING[row['what']]}", seconds(row["seconds"]), seconds(row["cpu_s"])]
            for row in results["correcting"]]
    return table(["mask", "seconds", "CPU s"], rows)


def stages(results):
    rows = []
    for row in (row for row in results["end_to_end"] if row["pipeline"] == "default" and not by_hand(row["case"])):
        shares = [f"{seconds(time)} ({100 * time / row['total_s']:.0f} %)" for time in row["stages_s"].values()]
        rows.append([case_name(row["case"]), *shares, seconds(row["total_s"])])
    names = list(results["end_to_end"][0]["stages_s"])
    return table(["case", *(f"{name}, s" for name in names), "total, s"], rows)


def unique(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


TABLES = {f.__name__: f for f in (machine, solving, voxelizing, reduction, end_to_end, stages, editing, correcting)}
# What of the results a table is made of, where its name does not say it.
SOURCES = {"stages": "end_to_end"}


def filled(document, results, tables):
    """The document with each of the tables between its markers."""
    for name, make in tables.items():
        begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
        if begin not in document:
            raise SystemExit(f"error: the document has no marker {begin}")
        head, rest = document.split(begin, 1)
        document = f"{head}{begin}\n{make(results)}\n{end}{rest.split(end, 1)[1]}"
    return document


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)
    tables = {name: make for name, make in TABLES.items() if SOURCES.get(name, name) in results}
    if len(sys.argv) < 3:
        print("\n\n".join(make(results) for make in tables.values()))
        return
    with open(sys.argv[2], encoding="utf-8") as file:
        document = file.read()
    shown = {name: make for name, make in tables.items() if f"<!-- begin {name} -->" in document}
    if not shown:
        raise SystemExit(f"error: {sys.argv[2]} has no marker <!-- begin NAME --> of {', '.join(tables)}")
    document = filled(document, results, shown)
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(document)


if __name__ == "__main__":
    main()
