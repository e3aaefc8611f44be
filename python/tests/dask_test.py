# SPDX-License-Identifier: Apache-2.0
"""The Dask recipe on a cluster of two workers on 127.0.0.1: no case is lost, whatever happens to a worker or to another case."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import kontur
import pytest

distributed = pytest.importorskip("distributed", reason="python3-distributed is not installed")

RECIPE = pathlib.Path(__file__).parents[2] / "examples" / "dask"
sys.path.insert(0, str(RECIPE))
import kontur_cohort

CASES = 8


@pytest.fixture
def cohort(tmp_path, case):
    kontur.write_contours(tmp_path / "kidney.json", case.contours)
    grid = kontur.grid_around(case.contours.bounding_box, [3, 3, 3], 10)
    kontur.write_image(tmp_path / "image.nii.gz", kontur.make_phantom_image(grid))
    rows = [f"case{n},kidney.json,image.nii.gz,out{n}.nii.gz,{0.5 + 0.05 * n}" for n in range(CASES)]
    write_table(tmp_path, rows)
    return tmp_path


def write_table(folder, rows):
    (folder / "cases.csv").write_text("\n".join(["case,contours,image,output,quality", *rows]) + "\n")


@pytest.fixture
def client(monkeypatch):
    """Workers are processes of their own, and a dead one is replaced, as on a cluster."""
    monkeypatch.setenv("PYTHONPATH", f"{RECIPE}:{os.environ['PYTHONPATH']}")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            yield client


def slow_case(row, folder, threads):
    time.sleep(0.5)
    return kontur_cohort.segment_case(row, folder, threads)


def deadly_case(row, folder, threads):
    if row["case"] == "case3":
        os.kill(os.getpid(), signal.SIGKILL)
    return kontur_cohort.segment_case(row, folder, threads)


def test_a_killed_worker_loses_no_case(cohort, client):
    killed = []

    def kill_a_busy_worker():
        pids = client.run(os.getpid)
        while not killed:
            busy = [address for address, tasks in client.processing().items() if tasks]
            if busy and list(cohort.glob("out*.nii.gz")):
                os.kill(pids[busy[0]], signal.SIGKILL)
                killed.append(pids[busy[0]])
            time.sleep(0.02)

    killer = threading.Thread(target=kill_a_busy_worker)
    killer.start()
    results = kontur_cohort.run_cohort(client, cohort / "cases.csv", work=slow_case)
    killer.join()
    assert killed
    assert [result["state"] for result in results] == ["done"] * CASES
    assert all((cohort / f"out{n}.nii.gz").exists() for n in range(CASES))


def test_a_case_that_kills_its_workers_stops_no_other(cohort, client):
    client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 1))
    results = kontur_cohort.run_cohort(client, cohort / "cases.csv", work=deadly_case)
    failed = [result for result in results if result["state"] == "failed"]
    assert [(result["case"], result["kind"]) for result in failed] == [("case3", "killed")]
    assert sum(result["state"] == "done" for result in results) == CASES - 1


def test_the_script_makes_the_same_bytes_as_the_command_line_and_goes_on(cohort):
    write_table(cohort, ["a,kidney.json,image.nii.gz,a.nii.gz,0.8", "b,absent.json,image.nii.gz,b.nii.gz,1",
                         "c,kidney.json,image.nii.gz,c.nii.gz,0.9"])
    words = [sys.executable, RECIPE / "kontur_cohort.py", cohort / "cases.csv", "--summary", cohort / "summary.json"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert result.returncode == 1 and "2 done, 1 failed" in result.stdout, result
    summary = json.loads((cohort / "summary.json").read_text())
    assert [(c["case"], c["state"]) for c in summary["cases"]] == [("a", "done"), ("b", "failed"), ("c", "done")]
    assert summary["cases"][1]["kind"] == "io" and "absent.json" in summary["cases"][1]["error"]
    subprocess.run([os.environ["KONTUR_CLI"], "segment", "kidney.json", "--image", "image.nii.gz", "--output", "same.nii.gz",
                    "--quality", "0.8"], cwd=cohort, check=True, capture_output=True)
    assert (cohort / "same.nii.gz").read_bytes() == (cohort / "a.nii.gz").read_bytes()

    before = (cohort / "a.nii.gz").stat().st_mtime_ns
    (cohort / "absent.json").write_bytes((cohort / "kidney.json").read_bytes())
    result = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0 and result.stdout.startswith("b: "), result
    assert (cohort / "a.nii.gz").stat().st_mtime_ns == before


def test_a_table_that_makes_no_sense_is_refused(tmp_path):
    for text, sentence in [("contours,image,output,colour\na,b,c,red\n", "line 2: unknown columns: colour"),
                           ("contours,output\na,b\n", "line 2: contours, output and either image"),
                           ("contours,image,output\na,b,c\nd,e,c\n", "same output")]:
        (tmp_path / "cases.csv").write_text(text)
        with pytest.raises(SystemExit, match=sentence):
            kontur_cohort.read_cases(tmp_path / "cases.csv")
