#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Embeds the files of a folder into the program. Usage: embed_page.py FOLDER ASSEMBLY.S TABLE.cpp

Writes the files, gzip'd, into one blob next to ASSEMBLY.S, an assembly source that includes it (an array in C++ takes the
compiler ten seconds for 4 MB), and the table of their names and places in it.
"""
import gzip
import pathlib
import sys

TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".woff2": "font/woff2",
}


def main(folder, assembly, table):
    folder, assembly = pathlib.Path(folder), pathlib.Path(assembly)
    blob, rows = b"", []
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        if path.suffix not in TYPES:
            sys.exit(f"embed_page: {path}: the server knows no content type for {path.suffix}")
        packed = gzip.compress(path.read_bytes(), 9, mtime=0)
        rows.append(f'    {{"/{path.relative_to(folder).as_posix()}", "{TYPES[path.suffix]}", {len(blob)}, {len(packed)}}},')
        blob += packed
    blob_path = assembly.with_suffix(".bin").resolve()
    blob_path.write_bytes(blob)
    assembly.write_text(
        ".section .rodata\n.balign 16\n.global kontur_page_blob\nkontur_page_blob:\n"
        f'.incbin "{blob_path}"\n.section .note.GNU-stack,"",%progbits\n'
    )
    pathlib.Path(table).write_text(
        "// Written by embed_page.py.\n#include \"viewer/server/page_table.h\"\n\nnamespace kontur::viewer {\n\n"
        f"const PageEntry kPageEntries[] = {{\n" + "\n".join(rows) + "\n};\n"
        f"const std::size_t kPageEntryCount = {len(rows)};\n\n}}  // namespace kontur::viewer\n"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
