#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables of two programs' Dice on the same drawings, by set and drawing.

Usage: bench/versus.py PEER.csv OURS... (--worst N lists the drawings on which ours is farthest behind)

PEER.csv is what bench/plain.py prints; OURS are JSON files of kontur_accuracy, or a CSV of the same columns.
"""
import argparse
import csv
import json
import pathlib

BEHIND = 0.002  # less says little: docs/accuracy/drawings.md, "How much of it is chance"


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return {(row["structure"], row["drawing"]): (row["set"], float(row["dice"])) for row in csv.DictReader(file)}


def read_ours(path):
    """{(structure, drawing): Dice}."""
    if path.suffix == ".csv":
        return {key: dice for key, (_, dice) in read_csv(path).items()}
    return {(row["object"], row["drawing"]): row["kontur"]["dice"] for row in json.loads(path.read_text())}


def cells(pairs):
    gains = [ours - peer for peer, ours in pairs]
    count = len(pairs)
    means = [sum(column) / count for column in zip(*pairs)]
    share = sum(gain > 0 for gain in gains) / count, sum(gain < -BEHIND for gain in gains) / count
    return f"{count} | {means[0]:.4f} | {means[1]:.4f} | {share[0]:.0%} | {share[1]:.0%} | {min(gains):+.4f} | {max(gains):+.4f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("peer", type=pathlib.Path)
    parser.add_argument("ours", nargs="+", type=pathlib.Path)
    parser.add_argument("--worst", type=int, default=0, metavar="N")
    options = parser.parse_args()
    peer = read_csv(options.peer)
    ours = {key: dice for path in options.ours for key, dice in read_ours(path).items()}
    rows = [(name, *key, dice, ours[key]) for key, (name, dice) in peer.items() if key in ours]
    print("| set | drawing | drawings | plain | kontur | ahead | behind by > 0.002 | worst | best |\n|---|---|---|---|---|---|---|---|---|")
    for name in dict.fromkeys(row[0] for row in rows):
        here = [row for row in rows if row[0] == name]
        for drawing in sorted({row[2] for row in here}):
            print(f"| {name} | {drawing} | {cells([row[3:] for row in here if row[2] == drawing])} |")
        print(f"| {name} | all | {cells([row[3:] for row in here])} |")
    for row in sorted(rows, key=lambda row: row[4] - row[3])[:options.worst]:
        print(f"{row[0]}/{row[1]}/{row[2]}: plain {row[3]:.4f}, kontur {row[4]:.4f}")


if __name__ == "__main__":
    main()
