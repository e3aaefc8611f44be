# SPDX-License-Identifier: Apache-2.0
"""Streams that cannot be written, and terminals that close: a documented exit code, and nothing half made."""
import math
import os
import signal
import subprocess
import time

import pytest
from support import KONTUR, SANITIZED, ball_planes, circle, names, write_planes


def run(folder, words, **streams):
    return subprocess.run([KONTUR, *map(str, words)], cwd=folder, timeout=60, **{"stdin": subprocess.DEVNULL, **streams})


@pytest.fixture
def folder(tmp_path):
    """Contours, and ones that are worth a warning: the last one crosses itself."""
    write_planes(tmp_path / "ball.json", ball_planes())
    eight = circle("z", 0.0)
    x, y, z = eight["origin"]
    turns = [2 * math.pi * n / 60 for n in range(60)]
    eight["contours"][0]["points"] = [[x + 10 * math.sin(t), y + 10 * math.sin(t) * math.cos(t), z] for t in turns]
    write_planes(tmp_path / "eight.json", [eight])
    return tmp_path


SEGMENT = ["segment", "eight.json", "--spacing-mm", 2, "--output", "out.nii"]


def close(*streams):
    return lambda: [os.close(stream) for stream in streams]


def test_the_case_of_these_tests_warns(folder):
    result = run(folder, SEGMENT, stderr=subprocess.PIPE)
    assert b"kontur: warning: " in result.stderr


def test_no_stderr_changes_no_exit_code(folder):
    with open("/dev/full", "wb") as full:
        assert run(folder, SEGMENT, stderr=full).returncode == 0
        assert run(folder, ["inspect", "absent.json"], stderr=full).returncode == 74
        assert run(folder, ["inspect", "--frobnicate"], stderr=full).returncode == 64
    assert run(folder, SEGMENT, preexec_fn=close(0, 1, 2)).returncode == 74  # the results had nowhere to go
    assert run(folder, SEGMENT, preexec_fn=close(0, 2), stdout=subprocess.PIPE).returncode == 0
    assert run(folder, ["inspect", "absent.json"], preexec_fn=close(2)).returncode == 74
    assert names(folder) == ["ball.json", "eight.json", "out.nii"]


@pytest.mark.parametrize("words", [["--version"], ["--help"], ["segment", "--help"], ["slicer", "--xml"], [], ["open", "--no-browser"]])
def test_words_that_do_not_arrive_are_a_failure(tmp_path, words):
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path)}
    with open("/dev/full", "wb") as full:
        result = run(tmp_path, words, stdout=full, stderr=subprocess.PIPE, env=environment)
    assert result.returncode == 74
    assert result.stderr.decode().endswith("kontur: error: standard output cannot be written\n")


def test_a_reader_that_has_gone_leaves_no_hidden_folder(folder):
    ours, theirs = os.pipe()
    os.close(ours)
    result = run(folder, SEGMENT, stdout=theirs, stderr=theirs)
    os.close(theirs)
    assert result.returncode == 74
    assert names(folder) == ["ball.json", "eight.json", "out.nii"]


SLOW = ["segment", "ball.json", "--spacing-mm", 0.1, "--voxelizer", "exhaustive", "--output", "out.nii"]  # minutes


def test_a_closed_terminal_ends_a_run_as_ctrl_c_does(folder):
    process = subprocess.Popen([KONTUR, *map(str, SLOW)], cwd=folder, stderr=subprocess.PIPE, text=True)
    time.sleep(0.5)
    process.send_signal(signal.SIGHUP)
    _, stderr = process.communicate(timeout=30)
    assert process.returncode == 130
    assert stderr == "kontur: error: interrupted; nothing was written\n"
    assert names(folder) == ["ball.json", "eight.json"]


def test_a_closed_terminal_leaves_no_case_of_a_batch_behind(folder):
    (folder / "cases.csv").write_text("contours,spacing-mm,voxelizer,output\nball.json,0.1,exhaustive,out.nii\n")
    process = subprocess.Popen([KONTUR, "batch", "cases.csv"], cwd=folder, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not (logs := list(folder.glob("cases.journal/*.log"))):
        assert time.monotonic() < deadline
        time.sleep(0.1)
    time.sleep(0.7)  # the case is at work
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=30)  # the case holds none of the batch's streams, but is waited for
    assert process.returncode == 130
    assert "out.nii" not in names(folder)
    assert [log.read_text() for log in logs] == ["kontur: error: interrupted; nothing was written\n"]


def test_nohup_outlives_the_terminal(folder):
    words = ["segment", "ball.json", "--spacing-mm", 0.25, "--voxelizer", "exhaustive", "--output", "out.nii"]
    ignore = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)  # noqa: E731
    process = subprocess.Popen([KONTUR, *map(str, words)], cwd=folder, stdout=subprocess.DEVNULL, preexec_fn=ignore)
    for _ in range(5):
        time.sleep(0.05)
        process.send_signal(signal.SIGHUP)
    assert process.wait(100) == 0
    assert "out.nii" in names(folder)


@pytest.mark.skipif(SANITIZED, reason="the sanitizer itself needs open files")
def test_too_few_open_files_are_a_failure_to_read(folder):
    words = ["sh", "-c", 'ulimit -n 4; exec "$0" inspect ball.json', KONTUR]
    result = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert result.returncode == 74
    assert result.stderr == "kontur: error: cannot open a pipe: Too many open files\n"
