# SPDX-License-Identifier: Apache-2.0
"""Every malformed file ends its command with a documented exit code and one sentence, soon, in little memory."""
import concurrent.futures
import os
import re
import resource
import subprocess
import time

import pytest
from malformed_files import cases

KONTUR = os.environ["KONTUR_CLI"]
SANITIZED = bool(os.environ.get("KONTUR_SANITIZED"))  # needs several times the memory and time
REFUSALS = {1, 65, 66, 69, 74, 77}  # 1: a batch with failed cases
MAX_CPU_S, MAX_WALL_S, MAX_MB, MAX_SENTENCE = 2.0, 120.0, 256, 2000
STEP = 1 if os.environ.get("KONTUR_MALFORMED_ALL") else int(os.environ.get("KONTUR_MALFORMED_STEP", "1"))  # every so many-th case


def limit_memory():
    """A runaway ends itself and not the machine."""
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(case, folder):
    """What is wrong with how the command ended, as a list of words."""
    place = folder / "cases" / case.name
    with open(place / ".stderr", "w+b") as stderr:
        process = subprocess.Popen([KONTUR, *case.words], cwd=place, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=stderr, preexec_fn=limit_memory)
        deadline = time.monotonic() + MAX_WALL_S
        pid = 0
        while pid == 0 and time.monotonic() < deadline:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            time.sleep(0.002)
        if pid == 0:
            process.kill()
            os.wait4(process.pid, 0)
            process.returncode = -9
            return [f"still runs after {MAX_WALL_S} s"]
        process.returncode = os.waitstatus_to_exitcode(status)
        stderr.seek(0)
        said = stderr.read().decode("utf-8", "replace")
    return complaints(case, process.returncode, said, usage)


def complaints(case, code, said, usage):
    wrong = []
    if code < 0:
        wrong.append(f"ended by signal {-code}")
    elif code not in REFUSALS | {0}:
        wrong.append(f"undocumented exit code {code}")
    elif code == 0 and case.refused:
        wrong.append("was accepted")
    lines = [line for line in said.split("\n") if line and not line.startswith("kontur: warning: ")]
    if code > 0 and not (len(lines) == 1 and re.fullmatch(r"kontur: error: .+", lines[0])):
        wrong.append(f"said {len(lines)} lines")
    if len(said) > MAX_SENTENCE or re.search(r"[\x00-\x09\x0b-\x1f\x7f]", said):
        wrong.append(f"said {len(said)} characters, or unprintable ones")
    if "unexpected:" in said or "ERROR: " in said or "runtime error" in said:
        wrong.append("said something unexpected")
    if not SANITIZED:
        if (seconds := usage.ru_utime + usage.ru_stime) > MAX_CPU_S:
            wrong.append(f"took {seconds:.1f} s")
        if (megabytes := usage.ru_maxrss / 1024) > MAX_MB + case.declared_mb:
            wrong.append(f"took {megabytes:.0f} MB")
    return [*wrong, f"stderr: {said[-300:]!r}"] if wrong else []


@pytest.mark.skipif(not KONTUR, reason="no program")
def test_every_malformed_file_ends_in_one_sentence(tmp_path):
    chosen, total = cases(tmp_path, STEP)
    assert total >= 500
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("KONTUR_MALFORMED_JOBS", "2"))) as pool:
        results = list(pool.map(lambda case: run(case, tmp_path), chosen))
    failed = [f"{case.name} ({' '.join(case.words)}): {'; '.join(wrong)}" for case, wrong in zip(chosen, results) if wrong]
    print(f"{len(chosen)} of {total} malformed files, {len(failed)} failures")
    assert not failed, "\n" + "\n".join(failed)
