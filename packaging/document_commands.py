#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the manual pages, also compressed, and shell completions. Usage: document_commands.py PROGRAM VERSION FOLDER"""
import gzip
import pathlib
import sys

import command_help
import completions
import man_pages


def main(program, version, folder):
    main_command, *commands = command_help.read(program)
    files = {f"man1/kontur{'-' * bool(c.name)}{c.name}.1": man_pages.page(c, version) for c in (main_command, *commands)}
    files["bash/kontur"] = completions.bash(main_command, commands)
    files["zsh/_kontur"] = completions.zsh(main_command, commands)
    files["fish/kontur.fish"] = completions.fish(main_command, commands)
    for name, text in files.items():
        path = pathlib.Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        if path.parent.name == "man1":
            # As Debian's policy wants them installed; without a time of their own, so that the same pages are the same bytes.
            compressed = pathlib.Path(folder) / "compressed" / f"{path.name}.gz"
            compressed.parent.mkdir(exist_ok=True)
            compressed.write_bytes(gzip.compress(text.encode(), 9, mtime=0))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
