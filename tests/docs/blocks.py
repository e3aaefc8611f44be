# SPDX-License-Identifier: Apache-2.0
"""The fenced blocks of a Markdown page, and how each kind of them is run.

The words behind the three backticks say what is done with a block:

    sh                  run by bash, in the page's folder, with kontur on the PATH; it must succeed
    python              run; all blocks of a page are one program
    cpp                 compiled against the built library and run
    json                must be JSON
    LANGUAGE file: NAME written to the page's folder, for the blocks that follow
    text                not code
    text output         what the block before prints; ... stands for anything
    LANGUAGE needs: MODULE  run where Python has the module
    LANGUAGE not run: REASON
"""
import contextlib
import dataclasses
import doctest
import importlib.util
import io
import json
import pathlib
import re
import subprocess

LANGUAGES = {"sh", "python", "cpp", "cmake", "json", "csv", "text"}


@dataclasses.dataclass
class Block:
    line: int
    language: str
    words: str
    text: str

    @property
    def file(self):
        return self.words.removeprefix("file:").strip() if self.words.startswith("file:") else None

    @property
    def reason_not_to_run(self):
        return self.words.removeprefix("not run:").strip() if self.words.startswith("not run:") else None


def blocks_of(page):
    """All fenced blocks; raises ValueError, with the line, for code that is not fenced or not labelled."""
    found, lines, fence, in_list = [], page.read_text().splitlines(), None, False
    for number, line in enumerate(lines, 1):
        if fence:
            if line.strip() == "```":
                found.append(Block(*fence, "\n".join(text for text in body) + "\n"))
                fence = None
            else:
                body.append(line)
            continue
        in_list = bool(re.match(r"\s*([-*]|\d+\.) ", line)) or (in_list and (line.startswith(" ") or not line))
        if start := re.match(r"```(\S*) ?(.*)", line):
            if start[1] not in LANGUAGES:
                raise ValueError(f"{page}:{number}: a block in the language {start[1]!r}")
            fence, body = (number, start[1], start[2]), []
        elif line.startswith("    ") and not in_list and line.strip():
            raise ValueError(f"{page}:{number}: an indented block, which no test runs; fence it")
    if fence:
        raise ValueError(f"{page}:{fence[0]}: a block without an end")
    return found


def lacks(block):
    """The module that the block needs, if Python does not have it."""
    module = block.words.removeprefix("needs:").strip() if block.words.startswith("needs:") else None
    return module if module and not importlib.util.find_spec(module) else None


class Runner:
    """Runs the blocks of one page in its folder."""

    def __init__(self, folder, environment, compile_words):
        self.folder, self.environment, self.compile_words = folder, environment, compile_words
        self.names, self.output = {"__name__": "__main__"}, ""

    def run(self, block):
        if block.file:
            target = self.folder / block.file
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(block.text)
        elif block.words == "output":
            flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
            assert doctest.OutputChecker().check_output(block.text, self.output, flags), f"printed:\n{self.output}"
        else:
            getattr(self, "run_" + block.language)(block)

    def call(self, *words):
        result = subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=240,
                                stdin=subprocess.DEVNULL)
        assert result.returncode == 0, f"exit code {result.returncode}\n{result.stdout}{result.stderr}"
        self.output = result.stdout

    def run_sh(self, block):
        self.call("bash", "-euo", "pipefail", "-c", block.text)

    def run_python(self, block):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("\n" * block.line + block.text, "the page", "exec"), self.names)
        self.output = printed.getvalue()

    def run_cpp(self, block):
        (self.folder / "program.cpp").write_text(block.text)
        self.call(*self.compile_words, "program.cpp", "-o", "program", "-lkontur")
        self.call("./program")

    def run_json(self, block):
        json.loads(block.text)

    def run_csv(self, block):
        assert len({line.count(",") for line in block.text.splitlines()}) == 1

    def run_cmake(self, block):
        raise AssertionError("a cmake block has to be written to a file that another block uses")

    def run_text(self, block):
        assert block.words == "", f"'{block.words}' means nothing"
