# SPDX-License-Identifier: Apache-2.0
"""What every command shares: help, version, usage errors."""
import re

import pytest
from support import kontur, succeed

COMMANDS = ["segment", "trace", "compare", "inspect", "convert", "phantom"]


def test_without_words_prints_the_help_that_lists_every_command():
    text = succeed()
    assert text == succeed("--help")
    for command in COMMANDS:
        assert re.search(rf"^  {command} ", text, re.MULTILINE), command


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
        ["trace", "a.nii", "--output", "b.json"],
        ["segment", "a.json", "--output", "b.nii", "--kernel", "gaussian"],
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_64(words):
    result = kontur(*words)
    assert result.returncode == 64
    assert result.stdout == ""
    assert re.fullmatch(r"kontur: error: .+\n", result.stderr)
