# SPDX-License-Identifier: Apache-2.0
"""kontur batch: a cohort that goes on whatever happens to one of its cases."""
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import time

import numpy
import pytest
from support import KONTUR, ball_array, ball_planes, circle, kontur, names, read_nifti, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
ARRAY_SCRIPT = pathlib.Path(__file__).parent.parent.parent / "examples" / "slurm" / "kontur-array.sh"


def write_table(folder, rows, columns="case,contours,image,output"):
    (folder / "cases.csv").write_text("\n".join([columns, *rows]) + "\n")
    return folder / "cases.csv"


@pytest.fixture
def cohort(tmp_path):
    """Two good cases and between them one without its contours. Paths are relative to the table."""
    write_planes(tmp_path / "ball, drawn.json", ball_planes())
    write_nifti(tmp_path / "image.nii.gz", ball_array())
    (tmp_path / "out").mkdir()
    good = '"ball, drawn.json",image.nii.gz'
    write_table(tmp_path, [f"a,{good},out/a.nii.gz", "b,absent.json,image.nii.gz,out/b.nii.gz", f"c,{good},out/c.nii.gz"])
    return tmp_path


def batch(folder, *words):
    return kontur("batch", folder / "cases.csv", "--summary", folder / "summary.json", *words)


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def times(folder):
    return {path.name: path.stat().st_mtime_ns for path in (folder / "out").iterdir()}


def test_one_failed_case_stops_no_other(cohort):
    result = batch(cohort, "--jobs", 2)
    assert result.returncode == 1
    assert result.stderr == "kontur: error: 1 of 3 cases failed\n"
    assert names(cohort / "out") == ["a.nii.gz", "c.nii.gz"]
    found = summary(cohort)
    assert (found["done"], found["failed"], found["open"]) == (2, 1, 0)
    assert [(c["case"], c["state"]) for c in found["cases"]] == [("a", "done"), ("b", "failed"), ("c", "done")]
    a, b, c = found["cases"]
    assert a["mask"]["voxels"] == numpy.count_nonzero(read_nifti(cohort / "out" / "a.nii.gz"))
    assert a["residual_mm"]["max"] < 0.1
    assert b["exit_code"] == 74 and "absent.json" in b["error"]
    assert "2 done, 1 failed, 0 open" in result.stdout
    assert re.search(r"^b +failed .*absent.json", result.stdout, re.MULTILINE)


def test_a_terminal_shows_what_is_done_and_how_long_the_rest_will_take(cohort):
    ours, theirs = pty.openpty()
    result = subprocess.run([KONTUR, "batch", cohort / "cases.csv"], stdout=subprocess.PIPE, stderr=theirs, timeout=60)
    os.close(theirs)
    assert result.returncode == 1
    shown = b""
    try:
        while part := os.read(ours, 1 << 16):
            shown += part
    except OSError:  # what a terminal gives whose other end is closed
        pass
    finally:
        os.close(ours)
    assert re.search(r"1 of 3 cases, about \d+ s left", shown.decode())
    assert re.search(r"2 of 3 cases, 1 failed, about \d+ s left", shown.decode())


def test_a_second_run_makes_only_what_is_missing(cohort):
    batch(cohort)
    before = times(cohort)
    write_planes(cohort / "absent.json", ball_planes())
    result = batch(cohort)
    assert result.returncode == 0, result
    assert result.stdout.startswith("b: ")
    assert {name: time for name, time in times(cohort).items() if name != "b.nii.gz"} == before
    (cohort / "out" / "c.nii.gz").unlink()
    assert batch(cohort).stdout.startswith("c: ")
    assert summary(cohort)["done"] == 3


def test_a_case_whose_input_or_options_changed_is_made_again(cohort):
    batch(cohort)
    before = times(cohort)
    write_planes(cohort / "ball, drawn.json", ball_planes()[:5])
    batch(cohort)
    assert all(after > before[name] for name, after in times(cohort).items())
    before = times(cohort)
    table = cohort / "cases.csv"
    table.write_text(table.read_text().replace("out/a.nii.gz", "out/a2.nii.gz"))
    batch(cohort)
    assert {name for name, time in times(cohort).items() if before.get(name) != time} == {"a2.nii.gz"}


def test_a_case_whose_outputs_are_gone_is_open(cohort):
    batch(cohort)
    (cohort / "out" / "a.nii.gz").unlink()
    result = batch(cohort, "--collect")
    assert [c["state"] for c in summary(cohort)["cases"]] == ["open", "failed", "done"]
    assert "1 done, 1 failed, 1 open\n" in result.stdout


def test_rows_that_move_in_the_table_stay_done(cohort):
    batch(cohort)
    before = times(cohort)
    head, a, b, c = (cohort / "cases.csv").read_text().splitlines()
    (cohort / "cases.csv").write_text("\n".join([head, a.replace("a,", "new,", 1).replace("out/a", "out/new"), c, a, b]) + "\n")
    result = batch(cohort)
    assert re.findall("^([a-z]+): ", result.stdout, re.MULTILINE) == ["new", "b"]
    assert {name: time for name, time in times(cohort).items() if name != "new.nii.gz"} == before
    assert [x["state"] for x in summary(cohort)["cases"]] == ["done", "done", "done", "failed"]


def test_warnings_of_the_cases_are_counted_and_can_be_read(cohort):
    write_nifti(cohort / "half.nii.gz", ball_array(shape=(20, 40, 40)))
    good = '"ball, drawn.json"'
    write_table(cohort, [f"whole,{good},image.nii.gz,out/whole.nii.gz", f"cut,{good},half.nii.gz,out/cut.nii.gz"])
    result = batch(cohort)
    whole, cut = summary(cohort)["cases"]
    assert whole["warnings"] == [] and len(cut["warnings"]) > 0
    number = len(cut["warnings"])
    assert re.search(rf"^cut: .* ml, .* s, {number} warning", result.stdout, re.MULTILINE)
    assert re.search(r"^whole +done .* 0$", result.stdout, re.MULTILINE)
    assert re.search(rf"^cut +done .* {number}$", result.stdout, re.MULTILINE)
    assert re.fullmatch(rf"read the .*warnings? in {cohort}/summary.json", result.stdout.splitlines()[-1])
    assert f"kontur: warning: {cut['warnings'][0]}\n" in pathlib.Path(cut["log"]).read_text()
    last = kontur("batch", cohort / "cases.csv").stdout.splitlines()[-1]
    assert last.endswith(f"in the .log files of {cohort}/cases.journal")


def test_what_spreadsheets_make_of_a_table_is_read(cohort):
    write_planes(cohort / "more.json", ball_planes()[:2])
    row = 'a,"ball, drawn.json ; more.json",image.nii.gz,out/a.nii.gz,TRUE'
    write_table(cohort, [row, ",,,,", ",,,,,,"], "Case,Contours,Image,Output,Date")
    result = batch(cohort)
    assert result.returncode == 0, result
    assert summary(cohort)["done"] == 1
    assert kontur("batch", cohort / "cases.csv", "--count").stdout == "1\n"


@pytest.mark.parametrize("output, sentence", [("folder.nii", "it is no regular file"), ("link.nii", "link.nii would replace the table")])
def test_an_output_that_cannot_be_is_refused_before_any_work(cohort, output, sentence):
    good = '"ball, drawn.json",image.nii.gz'
    table = write_table(cohort, [f"a,{good},out/a.nii.gz", f"b,{good},{output}"])
    (cohort / "folder.nii").mkdir()
    (cohort / "link.nii").symlink_to(table)
    result = batch(cohort)
    assert result.returncode in (65, 74)
    assert "cases.csv: line 3: " in result.stderr and sentence in result.stderr
    assert names(cohort / "out") == []


SLOW = "case,contours,image,output,spacing-mm,voxelizer"


def test_two_batches_of_one_table_share_its_cases(cohort):
    good = '"ball, drawn.json"'
    slow = f"slow,{good},,out/slow.nii.gz,0.1,exhaustive"  # minutes
    write_table(cohort, [slow, f"a,{good},image.nii.gz,out/a.nii.gz,,"], SLOW)
    first = subprocess.Popen([KONTUR, "batch", cohort / "cases.csv"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(500):
        if any((cohort / "cases.journal").glob("slow-*.log")):
            break
        time.sleep(0.01)
    second = batch(cohort)
    assert second.returncode == 1
    assert "1 done, 0 failed, 0 open, 1 being made by another process" in second.stdout
    assert second.stderr == "kontur: error: 0 of 2 cases failed, 1 being made by another process\n"
    assert [c["state"] for c in summary(cohort)["cases"]] == ["running", "done"]
    before = times(cohort)["a.nii.gz"]
    first.send_signal(signal.SIGTERM)
    assert first.wait(20) == 130
    assert times(cohort) == {"a.nii.gz": before}


def test_a_killed_batch_keeps_no_case(cohort):
    good = '"ball, drawn.json",image.nii.gz'
    write_table(cohort, [f"a,{good},out/a.nii.gz"])
    batch(cohort)
    [log] = (cohort / "cases.journal").glob("a-*.log")
    (cohort / "out" / "a.nii.gz").unlink()
    holder = subprocess.Popen([sys.executable, "-c", f"import fcntl, time; f = open({str(log)!r}, 'a'); fcntl.flock(f, fcntl.LOCK_EX); print(flush=True); time.sleep(60)"],
                              stdout=subprocess.PIPE)
    holder.stdout.readline()
    assert summary(cohort)["done"] == 1 and batch(cohort).returncode == 1
    assert [c["state"] for c in summary(cohort)["cases"]] == ["running"]
    holder.kill()
    holder.wait()
    assert batch(cohort).returncode == 0


def test_an_interrupted_batch_goes_on_where_it_was(cohort):
    """Outputs are whole or absent, and nothing that was done is done again."""
    good = '"ball, drawn.json",image.nii.gz'
    slow = '"ball, drawn.json",,out/slow.nii.gz,0.1,exhaustive'  # minutes
    columns = "case,contours,image,output,spacing-mm,voxelizer"
    rows = [f"{n},{good},out/{n}.nii.gz,," for n in "abc"]
    write_table(cohort, [*rows, f"slow,{slow}"], columns)
    words = [KONTUR, "batch", cohort / "cases.csv"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for _ in "abc":
        process.stdout.readline()
    time.sleep(0.5)  # the slow one has started
    process.send_signal(signal.SIGTERM)
    stdout, stderr = process.communicate(timeout=20)
    assert process.returncode == 130
    assert stderr == "kontur: error: interrupted; 3 of 4 cases are done, and the same command goes on from there\n"
    assert names(cohort / "out") == ["a.nii.gz", "b.nii.gz", "c.nii.gz"]
    before = times(cohort)
    write_table(cohort, [*rows, "slow,\"ball, drawn.json\",,out/slow.nii.gz,2,"], columns)
    result = batch(cohort)
    assert result.returncode == 0, result
    assert result.stdout.startswith("slow: ")
    assert {name: time for name, time in times(cohort).items() if name != "slow.nii.gz"} == before


def test_every_column_is_an_option_of_segment(cohort):
    write_table(
        cohort,
        ['"ball, drawn.json;more.json",image.nii.gz,out/m.nii.gz,7,biharmonic,out/m.stl,out/m.json'],
        "contours,image,output,label_value,kernel,mesh,report",
    )
    write_planes(cohort / "more.json", [circle("x", 2.5), circle("y", 2.5)])
    assert batch(cohort).returncode == 0
    assert set(numpy.unique(read_nifti(cohort / "out" / "m.nii.gz"))) == {0, 7}
    report = json.loads((cohort / "out" / "m.json").read_text())
    assert (report["kernel"], report["contours"]) == ("biharmonic", 11)
    assert (cohort / "out" / "m.stl").exists()
    assert summary(cohort)["cases"][0]["case"] == "1"


@pytest.mark.parametrize(
    "columns, rows, sentence",
    [
        ("contours,image,output", ["a.json,i.nii,o.nii", "a.json,i.nii"], "line 3: 2 cells stand below 3 columns"),
        ("contours,image,output,colour", ["a.json,i.nii,o.nii,"], "line 1: the column 'colour' is neither case nor contours nor an option"),
        ("contours,image,output,--mesh", ["a.json,i.nii,o.nii,b.json"], "line 1: the column '--mesh' is neither"),
        ("contours,image,output,-mesh", ["a.json,i.nii,o.nii,m.stl"], "line 1: the column '-mesh' is neither"),
        ("contours,image,output,-h", ["a.json,i.nii,o.nii,1"], "line 1: the column '-h' is neither"),
        ("contours,image,output,help", ["a.json,i.nii,o.nii,1"], "line 1: the column 'help' is neither"),
        ("contours,image,output,mesh=q.stl --name", ["a.json,i.nii,o.nii,m"], "line 1: the column 'mesh=q.stl --name' is neither"),
        ("contours,spacing-mm,output,spacing_mm", ["a.json,4,o.nii,4"], "line 1: the column 'spacing_mm' is a second one for spacing-mm"),
        ("contours,image", ["a.json,i.nii"], "line 1: there is no column 'output'"),
        ("case;contours;spacing-mm;output", ["a;a.json;0,8;o.nii"], "line 1: semicolons separate the columns; save the table with commas"),
        ("contours\timage\toutput", ["a.json\ti.nii\to.nii"], "line 1: tabs separate the columns"),
        ("case,contours,image,output", ["x,a.json,i.nii,o.nii", ",a.json,i.nii,p.nii", "x,b.json,i.nii,q.nii"], "line 4: the case 'x' is already that of line 2"),
        ("case,contours,image,output", ["2,a.json,i.nii,o.nii", ",a.json,i.nii,p.nii"], "line 3: the case '2' is already that of line 2"),
        ("contours,image,output", ["a.json,i.nii,o.nii", " ; ,i.nii,p.nii"], "line 3: the cell below 'contours' is empty"),
        ("contours,image,output", ["a.json,i.nii,"], "line 2: the cell below 'output' is empty"),
        ("contours,image,output", ["a.json,i.nii,o.nii", "a.json,i.nii,o.jpg"], "line 3: "),
        ("contours,image,output,mesh", ["a.json,i.nii,o.nii,m.off"], "line 2: m.off is no name for a mesh"),
        ("contours,image,output,picture", ["a.json,i.nii,o.nii,p.jpg"], "line 2: p.jpg does not end with .png"),
        ("contours,spacing-mm,output", ["a.json,4,o.dcm"], "line 2: o.dcm would refer to the DICOM images it was made on"),
        ("contours,image,output", ["a.json,i.nii,o.nii", "a.json,i.nii,absent/o.nii"], "line 3: cannot write "),
        ("contours,image,output,report", ["a.json,i.nii,o.nii,cases.csv"], "line 2: cases.csv does not end with .json"),
        ("contours,image,output", ["a.json,i.nii,o.nii", "b.json,i.nii,./o.nii"], "line 3: ./o.nii is already an output of line 2"),
        ("contours,image,output", ['"a.json,i.nii,o.nii'], "line 2: a quote is not closed"),
        ("contours,image,image", ["a,b,c"], "two columns are named 'image'"),
        ("contours,image,output", [], "has no rows"),
    ],
)
def test_a_table_that_makes_no_sense_is_refused_before_any_work(tmp_path, columns, rows, sentence):
    table = write_table(tmp_path, rows, columns)
    result = kontur("batch", table)
    assert result.returncode in (64, 65, 66, 69, 74)
    assert sentence in result.stderr
    assert set(names(tmp_path)) <= {"cases.csv", "cases.journal"} and not any((tmp_path / "cases.journal").glob("*"))


OVERWRITES = "contours,spacing-mm,output,report"


@pytest.mark.parametrize(
    "rows, sentence",
    [
        (["a.json,4,{here}/o.nii,", "b.json,4,o.nii,"], "line 3: o.nii is already an output of line 2"),
        (["a.json,4,o.nii,", "b.json,4,link/o.nii,"], "line 3: link/o.nii is already an output of line 2"),
        (["a.json,4,o.nii,b.json", "b.json,4,p.nii,"], "line 2: b.json would replace an input of line 3"),
        (["a.json,4,o.nii,link/a.json"], "line 2: link/a.json would replace an input of line 2"),
    ],
)
def test_no_row_writes_over_another_one(tmp_path, rows, sentence):
    for name in ("a.json", "b.json"):
        write_planes(tmp_path / name, ball_planes())
    (tmp_path / "link").symlink_to(".")
    before = names(tmp_path)
    write_table(tmp_path, [row.format(here=tmp_path) for row in rows], OVERWRITES)
    result = kontur("batch", tmp_path / "cases.csv")
    assert result.returncode == 65
    assert sentence in result.stderr
    assert names(tmp_path) == sorted([*before, "cases.csv"])


@pytest.mark.parametrize("summary, what", [("a.json", "input"), ("r.json", "output"), ("link/a.json", "input")])
def test_the_summary_replaces_nothing_of_the_cases(tmp_path, summary, what):
    write_planes(tmp_path / "a.json", ball_planes())
    (tmp_path / "link").symlink_to(".")
    write_table(tmp_path, ["a.json,4,o.nii,r.json"], OVERWRITES)
    before = (tmp_path / "a.json").read_bytes()
    result = kontur("batch", "cases.csv", "--summary", summary, cwd=tmp_path)
    assert result.returncode == 65
    assert f"{summary} would replace an {what} of line 2" in result.stderr
    assert (tmp_path / "a.json").read_bytes() == before
    assert not (tmp_path / "o.nii").exists()


@pytest.fixture
def scanned(tmp_path):
    """Two cases on one DICOM series, whose masks are kept beside its slices."""
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", tmp_path / "axial"], check=True)
    (tmp_path / "axial" / "dicom").rename(tmp_path / "dicom")
    first = names(tmp_path / "dicom")[0]
    write_planes(tmp_path / "ball.json", [circle(a, d, center=(-15.0, -25.0, 110.0), radius=3.5) for a in "xyz" for d in (-1, 1)])
    write_table(tmp_path, ["a,ball.json,dicom,dicom/a.dcm", f"b,ball.json,dicom/{first},dicom/b.nii"])
    return tmp_path


def test_a_changed_slice_makes_its_cases_again_and_their_outputs_beside_it_do_not(scanned):
    assert batch(scanned).returncode == 0
    assert not re.search("^[ab]: ", batch(scanned).stdout, re.MULTILINE)
    a_slice = sorted((scanned / "dicom").glob("*.dcm"))[-1]
    os.utime(a_slice, (1, 1))
    assert re.findall("^([ab]): ", batch(scanned).stdout, re.MULTILINE) == ["a", "b"]


def test_what_else_appears_in_a_folder_of_slices_makes_no_case_again(scanned):
    """Outputs in a subfolder, the table with its journal and summary, notes."""
    (scanned / "dicom" / "out").mkdir()
    (scanned / "ball.json").rename(scanned / "dicom" / "ball.json")
    write_table(scanned / "dicom", ["a,ball.json,.,out/a.nii", "b,ball.json,.,b.dcm"])
    assert batch(scanned / "dicom").returncode == 0
    assert summary(scanned / "dicom")["done"] == 2
    (scanned / "dicom" / "notes.txt").touch()
    (scanned / "dicom" / "old.dcm").write_bytes((scanned / "dicom" / "b.dcm").read_bytes())  # a segmentation
    (scanned / "dicom" / ".kontur-abcdef").mkdir()
    result = batch(scanned / "dicom")
    assert result.returncode == 0 and not re.search("^[ab]: ", result.stdout, re.MULTILINE), result


def test_no_row_replaces_a_slice_of_another_ones_image(scanned):
    last = names(scanned / "dicom")[-1]
    write_table(scanned, [f"a,ball.json,image.nii,dicom/{last}", "b,ball.json,dicom,b.nii"])
    result = batch(scanned)
    assert result.returncode == 65
    assert f"line 2: dicom/{last} would replace an input of line 3" in result.stderr


def test_changed_voxels_behind_a_detached_header_make_the_case_again(cohort):
    assert kontur("convert", cohort / "image.nii.gz", cohort / "image.nrrd").returncode == 0
    header, voxels = (cohort / "image.nrrd").read_bytes().split(b"\n\n", 1)
    (cohort / "image.nhdr").write_bytes(header + b"\ndata file: voxels.raw\n")
    (cohort / "voxels.raw").write_bytes(voxels)
    write_table(cohort, ['a,"ball, drawn.json",image.nhdr,out/a.nii.gz'])
    assert batch(cohort).returncode == 0
    assert not batch(cohort).stdout.startswith("a: ")
    os.utime(cohort / "voxels.raw", (1, 1))
    assert batch(cohort).stdout.startswith("a: ")


def test_flags_of_segment_are_yes_or_no_and_names_may_begin_with_a_dash(tmp_path):
    write_planes(tmp_path / "-k.json", ball_planes())
    row = "-k.json,4,-out.nii,-report.json,{},yes"
    columns = "contours,spacing-mm,output,report,date,quiet"
    write_table(tmp_path, [row.format("yes")], columns)
    result = kontur("batch", "cases.csv", cwd=tmp_path)
    assert result.returncode == 0, result
    assert "date" in json.loads((tmp_path / "-report.json").read_text())["provenance"]
    assert (tmp_path / "-out.nii").exists()
    write_table(tmp_path, [row.format("no")], columns)
    assert kontur("batch", "cases.csv", cwd=tmp_path).returncode == 0
    assert "date" not in json.loads((tmp_path / "-report.json").read_text())["provenance"]
    write_table(tmp_path, [row.format("today")], columns)
    assert "line 2: date is yes or no, not today" in kontur("batch", "cases.csv", cwd=tmp_path).stderr


def test_a_slurm_task_writes_a_log_and_says_when_the_node_has_no_kontur(tmp_path):
    assert "\n#SBATCH --output=kontur-%A_%a.log\n" in ARRAY_SCRIPT.read_text()
    environment = {"PATH": os.defpath, "SLURM_ARRAY_TASK_ID": "1", "KONTUR": "/no/such/kontur"}
    result = subprocess.run(["/bin/bash", ARRAY_SCRIPT, "cases.csv"], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert result.returncode == 127 and result.stderr.startswith("/no/such/kontur is not on the node "), result


def test_a_slurm_array_makes_the_cases_one_by_one(cohort):
    """The script of the documentation, run as Slurm runs it; a summary afterwards finds what every task left."""
    count = int(kontur("batch", cohort / "cases.csv", "--count").stdout)
    assert count == 3
    environment = {**os.environ, "KONTUR": KONTUR, "SLURM_CPUS_PER_TASK": "1"}
    tasks = [
        subprocess.Popen(
            ["bash", ARRAY_SCRIPT, cohort / "cases.csv"],
            env={**environment, "SLURM_ARRAY_TASK_ID": str(task)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for task in range(1, count + 1)
    ]
    assert [task.wait(60) for task in tasks] == [0, 1, 0]
    result = batch(cohort, "--collect")
    assert result.returncode == 1
    assert [c["state"] for c in summary(cohort)["cases"]] == ["done", "failed", "done"]
    assert kontur("batch", cohort / "cases.csv", "--row", 4).returncode == 65
