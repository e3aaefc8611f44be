#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Label maps of which some slices are left, filled by `kontur fill` and by its peers: docs/fill.md.

Usage: bench/fill.py slices DATA OUTPUT [--every N] [--jobs N] [--only real|report|tune] [--images] [--all-starts]
       bench/fill.py topology DATA OUTPUT [--kind branches|holes]
       bench/fill.py together DATA [--cases N]
       bench/fill.py peers [--only large|tubes] [--size N]
       bench/fill.py picture PICTURE.png

Each needs --kontur build/release/bin/kontur; `fill.py COMMAND --help` says more. DATA is laid out as organ_sources.py says. Tables
are printed, and written as CSV into OUTPUT. With --itk build/release/bin/itk_fill ITK's filter is a peer, too, as it comes and with
dilations; itk_fill is built where CMake is told where the filter's sources are: -DKONTUR_ITK_MODULE=FOLDER.
"""
import argparse
import os
import pathlib

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

from filling import kept, peers, picture, together, topology

COMMANDS = {"slices": kept, "topology": topology, "together": together, "peers": peers, "picture": picture}


def program(path):
    return pathlib.Path(path).resolve()


def parser_of_all():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, module in COMMANDS.items():
        command = commands.add_parser(name, description=module.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
        if name in ("slices", "topology", "together"):
            command.add_argument("data", type=pathlib.Path)
        if name in ("slices", "topology"):
            command.add_argument("output", type=pathlib.Path)
            command.add_argument("--words", action="append", metavar="OPTIONS", help="options of `kontur fill` to try; again for more")
        command.add_argument("--kontur", required=True, type=program)
        if name in ("slices", "topology", "peers"):
            command.add_argument("--itk", type=program, metavar="ITK_FILL", help="measure ITK's filter, too")
        module.add_arguments(command)
    return parser


def main():
    options = parser_of_all().parse_args()
    COMMANDS[options.command].run(options)


if __name__ == "__main__":
    main()
