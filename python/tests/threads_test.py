# SPDX-License-Identifier: Apache-2.0
"""What Python's threads, forks and its end may do to the library."""
import os
import signal
import subprocess
import sys
import threading
import time

import kontur
import pytest

SETUP = "import gc, threading, time, kontur\ncase = kontur.phantom_case('kidney_radial6')\n"


@pytest.fixture
def three(case):
    """A drawing that takes some milliseconds."""
    return kontur.ContourSet(case.contours.contours[:3])


def ends_well(program):
    result = subprocess.run([sys.executable, "-c", SETUP + program], capture_output=True, text=True, timeout=60)
    assert (result.returncode, result.stdout) == (0, "end\n"), result


def test_a_listener_may_drop_its_own_editor():
    ends_well("""
box, called = [], threading.Event()
def listener(update):
    box.clear()
    called.set()
box.append(kontur.LiveEditor(listener))
box[0].edit(case.contours)
called.wait()
print("end")
""")


def test_the_cyclic_collector_may_take_an_editor_on_its_own_thread():
    ends_well("""
class Window:
    def __init__(self):
        self.me = self
        self.editor = kontur.LiveEditor(listener)
collected = threading.Event()
def listener(update):
    gc.collect()
    collected.set()
gc.disable()
window = Window()
window.editor.edit(case.contours)
del window
collected.wait()
print("end")
""")


def test_an_editor_may_be_closed_while_others_edit(three):
    def edit(editor):
        with pytest.raises(kontur.InvalidInputError, match="closed"):
            while True:
                editor.edit(three)

    for _ in range(200):
        editor = kontur.LiveEditor(lambda update: None)
        thread = threading.Thread(target=edit, args=[editor])
        thread.start()
        editor.close()
        thread.join()


def test_closing_ends_the_waits(case):
    ends = []

    def wait():
        try:
            editor.wait()
        except kontur.Error as error:
            ends.append((type(error), str(error)))

    editor = kontur.LiveEditor(lambda update: None)
    editor.edit(case.contours)
    thread = threading.Thread(target=wait)
    thread.start()
    time.sleep(0.05)
    editor.close()
    thread.join(timeout=20)
    assert ends == [(kontur.CancelledError, "the editor was closed before edit 1 was finished")]
    with pytest.raises(kontur.InvalidInputError, match="closed"):
        editor.wait()


@pytest.mark.parametrize("edited", [False, True])
def test_a_forked_child_has_no_editor(three, edited):
    editor = kontur.LiveEditor(lambda update: None)
    if edited:
        editor.edit(three)
        editor.wait()
    child = os.fork()
    if child == 0:
        try:
            signal.alarm(20)
            with pytest.raises(kontur.InvalidInputError, match="closed"):
                editor.edit(three)
            del editor
            os._exit(0)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] == 0
    assert editor.edit(three) == 1 + edited
    editor.close()


@pytest.mark.parametrize("work", [
    "kontur.segment(case.contours, case.grid)",
    "kontur.segment(case.contours, case.grid, progress=lambda stage, fraction: sum(range(1000)))",
    "editor.wait()",
])
def test_daemon_threads_do_not_keep_python_from_ending(work):
    ends_well(f"""
threading.excepthook = lambda raised: None  # it may still see the wait cancelled
editor = kontur.LiveEditor(lambda update: None)
editor.edit(case.contours)
for _ in range(3):
    threading.Thread(target=lambda: {work}, daemon=True).start()
time.sleep(0.05)
print("end")
""")


def test_threads_may_share_an_editor():
    ends_well("""
editor, three = kontur.Editor(), kontur.ContourSet(case.contours.contours[:3])
drawings = [kontur.ContourSet(case.contours.contours[:n]) for n in (1, 2, 3)]
def work():
    for n in range(30):
        editor.preview(drawings[n % 3])
threads = [threading.Thread(target=work) for _ in range(4)]
[t.start() for t in threads]
[t.join() for t in threads]
print("end")
""")


def test_a_listener_must_be_callable():
    with pytest.raises(TypeError, match="a callable is needed, not 5"):
        kontur.LiveEditor(5)
