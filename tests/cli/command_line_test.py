# SPDX-License-Identifier: Apache-2.0
"""What every command shares: help, version, usage errors."""
import re

import pytest
from support import ball_array, ball_planes, kontur, names, succeed, write_nifti, write_planes

COMMANDS = ["segment", "trace", "suggest", "compare", "inspect", "convert", "phantom"]


def test_without_words_prints_the_help_that_lists_every_command():
    text = succeed()
    assert text == succeed("--help")
    for command in COMMANDS:
        assert re.search(rf"^  {command} ", text, re.MULTILINE), command


@pytest.mark.parametrize("command", COMMANDS)
def test_help_comes_before_a_command_too(command):
    assert succeed("help", command) == succeed("--help", command) == succeed(command, "--help")
    assert succeed("help") == succeed("--help")


@pytest.mark.parametrize("word", ["segmnt", "Segment", "ct.nii.gz"])
def test_what_is_no_command_is_told_which_there_are(word):
    result = kontur(word, "a.json", "--output", "b.nii")
    assert result.returncode == 64 and f"there is no command '{word}'; there are segment, " in result.stderr, result


@pytest.mark.parametrize(
    "words, sentence",
    [
        (["segmnt", "a.json"], "did you mean segment?"),
        (["segment", "a.json", "--imgae", "ct.nii"], "there is no option --imgae; did you mean --image?"),
        (["segment", "a.json", "--ouput=b.nii"], "there is no option --ouput; did you mean --output?"),
        (["trace", "a.nii", "--plaens", "b.json"], "there is no option --plaens; did you mean --planes?"),
        (["inspect", "--frobnicate", "a.json"], "there is no option --frobnicate\n"),
    ],
)
def test_a_misspelt_word_is_told_the_nearest(words, sentence):
    result = kontur(*words)
    assert result.returncode == 64 and sentence in result.stderr, result


def test_options_are_named_as_they_are_typed(tmp_path):
    two = write_nifti(tmp_path / "two.nii.gz", ball_array() + ball_array(radius=4))
    result = kontur("trace", two, "-o", tmp_path / "a.json")
    assert result.returncode == 65 and "choose one of 1, 2 with --label\n" in result.stderr, result


def test_an_image_in_the_place_of_contours_is_told_its_own(tmp_path):
    image = write_nifti(tmp_path / "ct.nii.gz", ball_array())
    planes = write_planes(tmp_path / "a.json", ball_planes())
    for words, what in (((image, planes), "ct.nii.gz is an image"), ((tmp_path, "--image", planes), f"{tmp_path} is a folder")):
        result = kontur("segment", *words, "--output", tmp_path / "b.nii")
        assert result.returncode == 65 and f"{what}, not a file of contours; an image goes behind --image" in result.stderr, result


def test_help_lists_the_exit_codes():
    assert re.findall(r"\d+ [a-z]+", succeed("--help").split("Exit codes: ")[1].split("(")[0]) == [
        "0 done",
        "64 wrong",
        "65 invalid",
        "66 corrupt",
        "69 unsupported",
        "70 no",
        "74 read",
        "77 too",
        "130 interrupted",
    ]


def test_version_is_one_line():
    assert re.fullmatch(r"kontur \d+\.\d+\.\d+\n", succeed("--version"))


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_has_an_example_that_begins_with_it(command):
    assert f"\n  kontur {command} " in succeed(command, "--help")


@pytest.mark.parametrize("command", COMMANDS)
def test_names_with_a_unit_show_it_in_help(command):
    for line in succeed(command, "--help").splitlines():
        if match := re.match(r"\s+--[a-z-]*-(mm|mb)\b(.*)", line):
            assert match[1].upper() in match[2] or match[1] in match[2], line


SEGMENT = ["segment", "a.json", "--output", "b.nii"]


@pytest.mark.parametrize(
    "words, limits",
    [
        ([*SEGMENT, "--threads", "-1"], "0 to 4096"),
        ([*SEGMENT, "--threads", "1000000"], "0 to 4096"),
        ([*SEGMENT, "--max-memory-mb", "-1"], "0 to 1000000000"),
        ([*SEGMENT, "--max-memory-mb", "nan"], "0 to 1000000000"),
        (["batch", "a.csv", "--threads", "-1"], "0 to 4096"),
        (["trace", "a.nii", "--planes", "b.json", "--output", "c.json", "--threads", "-1"], "0 to 4096"),
        (["compare", "a.nii", "b.nii", "--threads", "-1"], "0 to 4096"),
        (["phantom", "a", "--threads", "-1"], "0 to 4096"),
        (["phantom", "a", "--seed", "-1"], "0 to 18446744073709551615"),
        (["phantom", "a", "--seed", "18446744073709551616"], "0 to 18446744073709551615"),
        (["open", "--timeout", "-1"], "0 to 2147483647"),
        (["open", "--port", "70000"], "0 to 65535"),
        (["open", "--port", "-1"], "0 to 65535"),
        (["suggest", "a.json", "--planes", "0"], "1 to 1000"),
        (["batch", "a.csv", "--row", "0"], "1 to 2147483647"),
    ],
)
def test_a_number_out_of_its_range_is_refused_with_the_limits(tmp_path, words, limits):
    result = kontur(*words, cwd=tmp_path)
    assert result.returncode == 64
    assert re.search(f"{words[-2]} is {words[-1]}, but must be (a whole number )?from {limits}\n", result.stderr)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words, sentence",
    [
        (["--threads", "1.5"], "--threads is 1.5, but must be a whole number"),
        (["--spacing-mm", "one"], "--spacing-mm is one, but must be a number"),
        (["--use-image", "never"], "--use-image is auto|off, not never"),
        (["--mesh"], "--mesh needs 1 FILE"),
        (["--name", "a", "--name", "b"], "--name is given 2 times; 1 is possible"),
    ],
)
def test_a_word_that_an_option_does_not_take_is_refused_in_a_sentence(tmp_path, words, sentence):
    result = kontur(*SEGMENT, *words, cwd=tmp_path)
    assert (result.returncode, result.stderr) == (64, f"kontur: error: {sentence}\n")


@pytest.mark.parametrize(
    "words",
    [
        ["frobnicate"],
        ["--frobnicate"],
        ["segment"],
        ["segment", "contours.json"],
        ["compare", "a.nii"],
        ["compare", "a.nii", "b.nii", "--label", "liver"],
        ["inspect"],
        ["convert", "a.nii"],
        ["trace", "a.nii", "--planes", "b.json", "--image", "c.nii", "--output", "d.json"],
        ["segment", "a.json", "--output", "b.nii", "--kernel", "gaussian"],
        [*SEGMENT, "--spacing-mm", "1", "--frame", "0"],
        [*SEGMENT, "--spacing-mm", "1", "--series", "1.2.3"],
        [*SEGMENT, "--spacing-mm", "1", "--volume", "1"],
        [*SEGMENT, "--spacing-mm", "1", "--prefer", "qform"],
        [*SEGMENT, "--spacing-mm", "1", "--allow-missing-geometry"],
        ["batch", "a.csv", "--count", "--row", "2"],
        ["batch", "a.csv", "--count", "--summary", "b.json"],
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_64(words):
    result = kontur(*words)
    assert result.returncode == 64
    assert result.stdout == ""
    assert re.fullmatch(r"kontur: error: .+\n", result.stderr)


@pytest.mark.parametrize(
    "words, named",
    [
        (["segment", "ball.json", "--spacing-mm", 4, "--output", "out.nii", "--roi", "liver"], "'liver'; the file holds 'ball'"),
        (["convert", "ball.json", "out.mrk.json", "--roi", "liver"], "'liver'; the file holds 'ball'"),
        (["segment", "ball.json", "--spacing-mm", 4, "--output", "out.nii", "--holes", "xor"], "--holes"),
        (["trace", "mask.nii", "--planes", "ball.json", "--output", "out.json", "--holes", "xor"], "--holes"),
        (["convert", "ball.json", "out.mrk.json", "--holes", "xor"], "--holes"),
        (["convert", "ball.json", "out.mrk.json", "--image", "folder"], "--image"),
        (["convert", "mask.nii", "out.nrrd", "--roi", "liver"], "--roi"),
        (["convert", "ball.json", "out.mrk.json", "--frame", 0], "--frame"),
        (["convert", "ball.json", "out.mrk.json", "--volume", 1], "--volume"),
        (["inspect", "--check", "mask.nii"], "--check"),
    ],
)
def test_an_option_that_would_change_nothing_is_refused(tmp_path, words, named):
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / "mask.nii", ball_array())
    before = names(tmp_path)
    result = kontur(*words, cwd=tmp_path)
    assert result.returncode == 65
    assert re.fullmatch("kontur: error: .+\n", result.stderr)
    assert named in result.stderr
    assert names(tmp_path) == before


def test_o_is_short_for_output(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    succeed("segment", "ball.json", "--spacing-mm", 4, "-o", "out.nii", cwd=tmp_path)
    succeed("trace", "out.nii", "--planes", "ball.json", "-o", "traced.json", cwd=tmp_path)
    assert names(tmp_path) == ["ball.json", "out.nii", "traced.json"]
    for command in ("segment", "trace"):
        assert "\n  -o,--output FILE REQUIRED" in succeed(command, "--help")
    assert "--output is required" in kontur("segment", "ball.json", "--spacing-mm", 4, cwd=tmp_path).stderr


def test_options_that_name_what_is_there_are_welcome(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / "mask.nii", ball_array())
    succeed("segment", "ball.json", "--spacing-mm", 4, "--output", "out.nii", "--roi", "ball", cwd=tmp_path)
    succeed("inspect", "--check", "mask.nii", "ball.json", cwd=tmp_path)
