#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A cohort on a Dask cluster, through the Python package: one task for each row of the table that `kontur batch` takes.

    kontur_cohort.py cases.csv --scheduler tcp://127.0.0.1:8786 --summary summary.json

The table, the images and the outputs lie where every worker reads and writes them. A case whose worker dies is made again by
another; one that kills its worker again and again is a failed case, and stops no other. What was done is noted beside the table,
so that the same command goes on after a stop.
"""
import argparse
import csv
import hashlib
import inspect
import json
import os
import pathlib
import sys

import distributed
import kontur

OPTIONS = [name for name, p in inspect.signature(kontur.segment).parameters.items()
           if p.kind is p.KEYWORD_ONLY and name not in ("image", "progress", "stop", "mesh", "threads")]
COLUMNS = ["case", "contours", "image", "spacing_mm", "margin_mm", "output", "mesh", "report", "label_value", "roi", "name", *OPTIONS]


def number(text):
    """The option's value: a number where it is one, else a word such as 'biharmonic'."""
    try:
        return float(text)
    except ValueError:
        return text


def read_cases(table):
    """The rows as dicts without empty cells; refuses what cannot be made before anything is."""
    with open(table, newline="", encoding="utf-8") as file:
        rows = [{key.replace("-", "_"): value for key, value in row.items() if value} for row in csv.DictReader(file)]
    for line, row in enumerate(rows, 2):
        if unknown := sorted(set(row) - set(COLUMNS)):
            raise SystemExit(f"{table}: line {line}: unknown columns: {', '.join(unknown)}")
        if not {"contours", "output"} <= set(row) or ("image" in row) == ("spacing_mm" in row):
            raise SystemExit(f"{table}: line {line}: contours, output and either image or spacing_mm are needed")
    outputs = [row["output"] for row in rows]
    if len(set(outputs)) < len(outputs):
        raise SystemExit(f"{table}: two rows have the same output")
    return rows


def files_sha256(paths):
    """As the provenance of `kontur segment` has it: of several files, or of those of a folder, of their digests, one per line."""
    def of(text):
        return hashlib.sha256("".join(f"{line}\n" for line in text).encode()).hexdigest()

    def of_path(path):
        if path.is_dir():
            return of(sorted(of_path(file) for file in path.iterdir() if file.is_file()))
        return hashlib.sha256(path.read_bytes()).hexdigest()

    digests = [of_path(path) for path in paths]
    return digests[0] if len(digests) == 1 else of(digests)


def segment_case(row, folder, threads):
    """Makes one case, as `kontur segment` does: the same bytes. Returns what the summary says of it."""
    folder = pathlib.Path(folder)
    files = [folder / name for name in row["contours"].split(";")]
    notes = []
    contours = kontur.read_contours(files, roi=row.get("roi"), on_note=notes.append)
    if "name" in row:
        contours = kontur.ContourSet(contours, row["name"], contours.interior, contours.exterior, contours.surface, contours.empty_planes)
    digests = {"contour_files_sha256": files_sha256(files)}
    if "image" in row:
        grid = kontur.read_grid(folder / row["image"], on_note=notes.append)
        digests["image_sha256"] = files_sha256([folder / row["image"]])
    else:
        spacing = [float(word) for word in row["spacing_mm"].split(",")]
        grid = kontur.grid_around(contours.bounding_box, spacing * (3 // len(spacing)), float(row.get("margin_mm", 10)))
    options = {name: number(row[name]) for name in OPTIONS if name in row}
    image = kontur.read_image(folder / row["image"]) if "image" in row and options.get("use_image") != "off" else None
    made = kontur.segment(contours, grid, image=image, mesh="mesh" in row, threads=threads, **options)
    provenance = kontur.provenance(contours, grid, made.report) | digests
    names = {"segment_name": contours.name} if contours.name else {}
    kontur.write_mask(folder / row["output"], made.mask, provenance=provenance,
                      label_value=int(row.get("label_value", 1)), **names)
    if "mesh" in row:
        kontur.write_mesh(folder / row["mesh"], made.mesh, provenance=provenance)
    result = {"volume_ml": made.report.mask_volume_ml, "residual_max_mm": made.report.residual.max_mm,
              "warnings": notes + made.report.warnings, "provenance": provenance}
    if "report" in row:
        (folder / row["report"]).write_text(json.dumps(result, indent=2))
    return result


def attempt(work, row, folder, threads):
    """An error of the case is its result; only the death of a worker is Dask's to handle."""
    try:
        return {"state": "done", **work(row, folder, threads)}
    except kontur.Error as error:
        return {"state": "failed", "kind": error.kind, "error": str(error)}
    except Exception as error:
        return {"state": "failed", "kind": "unexpected", "error": repr(error)}


def fingerprint(row, folder):
    """A case is made again when its row, its inputs or kontur has changed."""
    inputs = [folder / name for name in [*row["contours"].split(";"), row.get("image", "")] if name]
    stats = [os.stat(path) if path.exists() else None for path in inputs]
    return json.dumps([kontur.__version__, row, [stat and (stat.st_size, stat.st_mtime_ns) for stat in stats]])


class Journal:
    """What became of each case: one small file each, written when the case has ended."""

    def __init__(self, table):
        self.folder = table.with_suffix(".dask")
        self.folder.mkdir(exist_ok=True)

    def read(self, number, made_from):
        path = self.folder / f"{number:05}.json"
        known = json.loads(path.read_text()) if path.exists() else {}
        return known.get("result") if known.get("made_from") == made_from else None

    def write(self, number, made_from, result):
        temporary = self.folder / f".{number:05}.tmp"
        temporary.write_text(json.dumps({"made_from": made_from, "result": result}))
        temporary.replace(self.folder / f"{number:05}.json")


def run_cohort(client, table, threads=1, work=segment_case):
    """All cases of the table on the client's workers: a list with one dict for each, in order."""
    table = pathlib.Path(table).resolve()
    folder, journal, rows = table.parent, Journal(table), read_cases(table)
    made_from = [fingerprint(row, folder) for row in rows]
    results = [journal.read(number, made) for number, made in enumerate(made_from, 1)]

    def submit(index):
        return client.submit(attempt, work, rows[index], str(folder), threads, key=f"kontur-{index + 1}-{os.urandom(4).hex()}", pure=False)

    def finish(index, result):
        results[index] = {"case": rows[index].get("case", str(index + 1)), **result}
        journal.write(index + 1, made_from[index], results[index])
        print(f"{results[index]['case']}: {result.get('error') or '%.2f ml' % result['volume_ml']}", flush=True)

    def is_done(index):
        return results[index] and results[index]["state"] == "done" and (folder / rows[index]["output"]).exists()

    waiting = {submit(index): index for index in range(len(rows)) if not is_done(index)}
    suspects = []
    for task in distributed.as_completed(list(waiting)):
        if task.status == "finished":
            finish(waiting[task], task.result())
        else:  # Dask gave up: workers that held it died, but that may have been the fault of another case there
            suspects.append(waiting[task])
    for index in sorted(suspects):  # one at a time, so that each is judged alone
        task = submit(index)
        distributed.wait(task)
        finish(index, task.result() if task.status == "finished"
               else {"state": "failed", "kind": "killed", "error": str(task.exception())})
    return results


def main():
    parser = argparse.ArgumentParser(description="Segment a cohort on a Dask cluster.")
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--scheduler", help="address of the scheduler; without it a cluster on this machine is started")
    parser.add_argument("--workers", type=int, default=2, help="of the cluster on this machine")
    parser.add_argument("--threads", type=int, default=1, help="of each case")
    parser.add_argument("--summary", type=pathlib.Path, help="JSON to write")
    options = parser.parse_args()
    if options.scheduler:
        client = distributed.Client(options.scheduler)
    else:
        client = distributed.Client(distributed.LocalCluster(
            n_workers=options.workers, threads_per_worker=1, host="127.0.0.1", dashboard_address=None))
    client.upload_file(__file__)  # so that workers know segment_case
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    import kontur_cohort

    with client:
        results = kontur_cohort.run_cohort(client, options.table, options.threads)
    done = sum(result["state"] == "done" for result in results)
    if options.summary:
        options.summary.write_text(json.dumps({"done": done, "failed": len(results) - done, "cases": results}, indent=2))
    print(f"{done} done, {len(results) - done} failed")
    return 0 if done == len(results) else 1


if __name__ == "__main__":
    sys.exit(main())
