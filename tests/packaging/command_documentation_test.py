# SPDX-License-Identifier: Apache-2.0
"""Manual pages and completions know every command and option that --help shows."""
import os
import pathlib
import re
import shutil
import subprocess

import pytest

FOLDER = pathlib.Path(os.environ["KONTUR_BUILD"]) / "command_documentation"


def help_of(*words):
    return subprocess.run([os.environ["KONTUR_CLI"], *words, "--help"], capture_output=True, text=True, check=True).stdout


COMMANDS = re.findall(r"^  ([a-z-]+) ", help_of().split("Subcommands:")[1], re.MULTILINE)


def options_of(command):
    return sorted(set(re.findall(r"^  (?:-\w,)?(--[a-z0-9_-]+)", help_of(command), re.MULTILINE)))


def complete(*words):
    """What bash offers after these words."""
    script = (f'source "{FOLDER}/bash/kontur"; COMP_WORDS=({" ".join(repr(w) for w in words)}); COMP_CWORD={len(words) - 1};'
              ' _kontur; printf "%s\\n" "${COMPREPLY[@]}"')
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()


def test_there_is_something_to_document():
    assert len(COMMANDS) >= 6 and "--output" in options_of("segment")


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_has_a_page_with_all_options(command):
    page = FOLDER / "man1" / f"kontur-{command}.1"
    shown = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-rLL=200n", page], capture_output=True, text=True, check=True)
    assert shown.stderr == ""
    text = re.sub(r"\x1b\[\d*m|.\x08", "", shown.stdout).replace("‐", "-").replace("−", "-")
    for option in options_of(command):
        assert re.search(rf"(^|[ ,]){option}\b", text, re.MULTILINE), option
    assert command.replace("-", r"\-") in (FOLDER / "man1" / "kontur.1").read_text()


def test_bash_offers_commands():
    assert sorted(set(complete("kontur", "")) - {"-h", "--help", "--version"}) == sorted(COMMANDS)
    assert complete("kontur", "seg") == ["segment"]


@pytest.mark.parametrize("command", COMMANDS)
def test_bash_offers_each_option(command):
    assert sorted(complete("kontur", command, "--")) == options_of(command)


def test_bash_offers_values_and_files(tmp_path, monkeypatch):
    (tmp_path / "contours.json").write_text("")
    monkeypatch.chdir(tmp_path)
    assert complete("kontur", "segment", "--solver", "") == ["automatic", "iterative", "cholesky", "dense"]
    assert complete("kontur", "segment", "--solver", "ch") == ["cholesky"]
    assert complete("kontur", "segment", "--output", "con") == ["contours.json"]
    assert complete("kontur", "segment", "con") == ["contours.json"]
    assert complete("kontur", "segment", "--quality", "con") == []


@pytest.mark.parametrize("shell, file", [("bash", "bash/kontur"), ("zsh", "zsh/_kontur"), ("fish", "fish/kontur.fish")])
def test_each_shell_accepts_its_file(shell, file):
    if not shutil.which(shell):
        pytest.skip(f"{shell} is not installed")
    subprocess.run([shell, "-n", FOLDER / file], check=True)


@pytest.mark.parametrize("command", COMMANDS)
def test_zsh_and_fish_know_each_option(command):
    zsh, fish = (FOLDER / "zsh/_kontur").read_text(), (FOLDER / "fish/kontur.fish").read_text()
    part = zsh.split(f"    {command})\n")[1].split(";;")[0]
    lines = [line for line in fish.splitlines() if f"__fish_seen_subcommand_from {command}'" in line]
    for option in options_of(command):
        assert f"'{option}[" in part
        assert any(re.search(rf" -l {option[2:]}( |$)", line) for line in lines)
