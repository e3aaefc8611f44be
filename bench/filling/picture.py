# SPDX-License-Identifier: Apache-2.0
"""What filling makes of two painted bodies, seen across the slices."""
import pathlib

import numpy as np
from matplotlib.colors import ListedColormap

import slices
from filling.methods import filled
from plots import pyplot, save

SHAPE, STEP = (80, 70, 73), 9
COLOURS = ListedColormap(["#ffffff", "#d98c3f", "#4d99e6", "#66bf66"])


def bean():
    """A slanted body with a dent, on every ninth slice."""
    x, y, z = (np.indices(SHAPE).T - (np.array(SHAPE) - 1) / 2).T
    x = x - 0.45 * z
    body = (x / 19) ** 2 + (y / 24) ** 2 + (z / 33) ** 2 < 1
    return (body & ((x - 22) ** 2 + y**2 + z**2 > 14**2)).astype(np.int16)


def sectors():
    """Three parts of a barrel that meet in its middle and turn around it."""
    x, y, z = (np.indices(SHAPE).T - (np.array(SHAPE) - 1) / 2).T
    part = 1 + np.floor(3 * ((np.arctan2(y, x) + 0.022 * z) / (2 * np.pi) % 1)).astype(np.int16)
    return np.where((np.hypot(x, y) < 30 - 0.012 * z**2) & (abs(z) < 34), part, 0).astype(np.int16)


def painted(labels):
    sparse = np.zeros_like(labels)
    sparse[:, :, STEP // 2 :: STEP] = labels[:, :, STEP // 2 :: STEP]
    return sparse


def rows(kontur):
    def fill(labels, *words):
        return filled(kontur, painted(labels), np.eye(4), words)

    one, three = bean(), sectors()
    kept = slices.occupied(painted(one) > 0)
    yield [("painted", painted(one)), ("shape-based", slices.shape_based(one > 0, kept, np.ones(3)).astype(np.int16)),
           ("kontur fill", fill(one)), ("the body", one)]
    yield [("painted", painted(three)), ("kontur fill --alone", fill(three, "--alone")), ("kontur fill", fill(three)),
           ("the body", three)]


def add_arguments(parser):
    parser.add_argument("picture", type=pathlib.Path)


def run(options):
    figure, axes = pyplot.subplots(2, 4, figsize=(10, 5.4))
    for row, panels in zip(axes, rows(options.kontur)):
        for axis, (title, labels) in zip(row, panels):
            axis.imshow(labels[:, SHAPE[1] // 2 - 4].T, cmap=COLOURS, vmin=0, vmax=3, origin="lower", interpolation="nearest")
            dice = 2 * ((labels > 0) & (labels == panels[-1][1])).sum() / ((labels > 0).sum() + (panels[-1][1] > 0).sum())
            print(f"{title}: {dice:.3f}")
            axis.set_title(title if title in ("painted", "the body") else f"{title}: {dice:.3f}", fontsize=10)
            axis.set_axis_off()
    save(figure, options.picture)
