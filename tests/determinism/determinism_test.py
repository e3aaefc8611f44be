# SPDX-License-Identifier: Apache-2.0
"""The same drawing gives the same bytes of mask and mesh, whatever the number of threads and however often it is run.

KONTUR_DETERMINISM_CASES and _RUNS widen it: 20 and 3 are what docs/reliability.md states.
"""
import hashlib
import json
import os
import subprocess

import pytest
from drawings import CASES, drawing, options

KONTUR = os.environ["KONTUR_CLI"]
RUNS = int(os.environ.get("KONTUR_DETERMINISM_RUNS", "1"))
THREADS = (1, 2, 3, 4, 8)


def digests(folder, words, threads):
    for name in ("o.nii", "o.stl"):
        (folder / name).unlink(missing_ok=True)
    subprocess.run([KONTUR, "segment", "a.json", "--spacing-mm", "2", "--output", "o.nii", "--mesh", "o.stl", "--threads", str(threads), *words],
                   cwd=folder, check=True, capture_output=True, timeout=400)
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in ("o.nii", "o.stl")]


@pytest.mark.parametrize("seed", range(CASES))
def test_any_number_of_threads_gives_the_same_bytes(tmp_path, seed):
    (tmp_path / "a.json").write_text(json.dumps(drawing(seed)))
    words = options(seed)
    first = digests(tmp_path, words, THREADS[0])
    for run in range(RUNS):
        for threads in THREADS:
            assert digests(tmp_path, words, threads) == first, f"{threads} threads, run {run + 1}"
