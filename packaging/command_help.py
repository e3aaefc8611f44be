# SPDX-License-Identifier: Apache-2.0
"""Reads what `kontur --help` and `kontur COMMAND --help` print, the one place where options are described."""
import dataclasses
import re
import subprocess


@dataclasses.dataclass
class Option:
    names: list  # such as ["-h", "--help"]
    value: str  # such as "MM", "a|b"; empty for a flag
    default: str
    notes: list  # such as "REQUIRED", "Needs: --spacing-mm"
    help: str

    @property
    def choices(self):
        return self.value.split("|") if "|" in self.value else []

    @property
    def takes_path(self):
        return self.value in ("FILE", "DIR")


@dataclasses.dataclass
class Command:
    name: str  # empty for the program itself
    summary: str
    usage: str
    positionals: list
    options: list
    commands: list  # (name, summary)
    footer: str


_NOTE = re.compile(r" (REQUIRED|(?:Needs|Excludes): \S+)")


def _entries(lines):
    """(head, help) of each entry: a head is indented by 2 columns, its help is on the same line or on the following ones."""
    entries = []
    for line in lines:
        if line.startswith("   "):
            entries[-1][1].append(line.strip())
            continue
        head, *text = re.split(r"\s{2,}", line.strip(), maxsplit=1)
        entries.append((head, text))
    return [(head, " ".join(text)) for head, text in entries]


def _option(head, text):
    notes = _NOTE.findall(head)
    names, _, value = _NOTE.sub("", head).replace(" ...", "").partition(" ")
    value, _, default = value.partition("=")
    return Option(names.split(","), value, default, notes, text)


def parse(name, text):
    """The Command that a help text describes."""
    blocks = [block.splitlines() for block in text.strip("\n").split("\n\n")]
    summary, usage = blocks[0][0], blocks[0][1].removeprefix("Usage: ")
    sections = {lines[0]: lines[1:] for lines in blocks[1:]}
    known = {title: _entries(sections.pop(title, [])) for title in ("Positionals:", "Options:", "Subcommands:")}
    footer = "\n\n".join("\n".join([title, *lines]) for title, lines in sections.items())
    positionals = [(_NOTE.sub("", head).removesuffix(" ..."), help) for head, help in known["Positionals:"]]
    options = [_option(*entry) for entry in known["Options:"]]
    return Command(name, summary, usage, positionals, options, known["Subcommands:"], footer)


def read(program):
    """The program itself and each of its commands, as the program at this path describes them."""

    def help_of(*words):
        return subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout

    main = parse("", help_of())
    return [main] + [parse(name, help_of(name)) for name, _ in main.commands]
