#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the constants of src/kontur/sureness/uncertainty_model.h to what simulated annotators drew.

Usage: bench/annotators/uncertainty_fit.py STATES.jsonl [--judge OTHER.jsonl]

STATES.jsonl is what kontur_annotators prints with --sample-step. Prints the constants, and the coverage of band, expected Dice and
volume with each structure left out of the constants in turn; with --judge also how constants of STATES.jsonl do on other
structures. Then how much of the true border the band holds as it is built, with the constants that organ_band.py fits.
States of fewer than three different planes are left out, as the library leaves them out.
"""
import argparse
import json

import numpy as np
from scipy import optimize

LEAST_DISTANCE, LEAST_SLOPE, MOST_SLOPE = 0.003, 0.3, 2.0
NINETY = 1.645
PLANES = -0.70  # power of the number of whole planes, which organ_band.py fits
LEAST_ERROR = 0.0006  # of the diameter: what truths.py cannot tell from 0


class State:
    """One drawing: what the library knows, and the truth. Lengths in diameters of the surface."""

    def __init__(self, line):
        size = line["size_mm"]
        self.structure, self.way, self.planes = line["structure"], line["way"], line["different_planes"]
        distance, slope, error, share = np.array(line["samples"]).T
        self.h = np.log(np.maximum(distance, LEAST_DISTANCE))
        self.g = np.log(np.clip(slope, LEAST_SLOPE, MOST_SLOPE))
        self.error, self.share = np.abs(error), share / share.sum()
        self.mean_h = np.log((np.exp(self.h) * self.share).sum())
        self.mean_g = (self.g * self.share).sum()
        self.known = PLANES * np.log(line["whole_planes"])
        self.shape = np.log(line["area_mm2"] ** 1.5 / line["volume_mm3"])
        self.area_per_volume = line["area_mm2"] * size / line["volume_mm3"]
        by_hand = NINETY * max(line["residual_mm"], line["disagreement_mm"] / np.sqrt(2), line["hand_mm"])
        self.drawing = np.hypot(line["voxel_mm"] / 2, by_hand) / size
        self.hand_odds = line["area_mm2"] * line["disagreement_mm"] / (np.sqrt(8) * line["volume_mm3"])
        away, _, area, _, width = np.array(line["border"]).T
        self.held = area @ (away <= width) / area.sum()
        self.dice = line["dice"]
        self.odds = 1 / max(line["dice"], 1e-3) - 1
        self.volume_ratio = line["true_volume_mm3"] / line["volume_mm3"]

    def half_widths(self, b, own_slope=True):
        g = self.g if own_slope else self.mean_g
        return np.hypot(np.exp(b[0] + b[1] * self.h + b[2] * g + b[3] * self.mean_h + b[4] * self.shape + self.known), self.drawing)

    def coverage(self, b, own_slope=True):
        return self.share[self.error <= self.half_widths(b, own_slope)].sum()

    def missed(self, d):
        return np.log((self.share * np.exp(d[2] * self.h + d[3] * self.g)).sum() * self.area_per_volume)

    def expected_odds(self, d):
        return np.exp(d[0] + d[1] * self.missed(d)) + d[4] * self.hand_odds


def weights_of(states):
    """Every structure counts as much as another."""
    names, counts = np.unique([s.structure for s in states], return_counts=True)
    count = dict(zip(names, counts))
    return np.array([1 / count[s.structure] for s in states])


def fit_band(states, start=(-2.27, 0.76, -0.6, 0.41, 0.56)):
    """90 % quantile regression of the log error, with the drawing's own error as given."""
    weights = np.concatenate([w * s.share for w, s in zip(weights_of(states), states)])
    error = np.log(np.maximum(np.concatenate([s.error for s in states]), LEAST_ERROR))
    design = np.concatenate([np.stack([np.ones_like(s.h), s.h, s.g, np.full_like(s.h, s.mean_h), np.full_like(s.h, s.shape)], 1)
                             for s in states])
    drawing, known = (np.concatenate([np.full_like(s.h, getattr(s, name)) for s in states]) for name in ("drawing", "known"))

    def loss(b):
        missed = np.exp(design @ b + known)
        width = np.hypot(missed, drawing)
        off = error - np.log(width)
        slope = np.where(off > 0, -0.9, 0.1)
        gradient = ((weights * slope * (missed / width) ** 2)[:, None] * design).sum(axis=0)
        return (weights * np.where(off > 0, 0.9 * off, -0.1 * off)).sum(), gradient

    return optimize.minimize(loss, start, jac=True, method="BFGS", options={"gtol": 1e-6, "maxiter": 200}).x


def fit_dice(states, start=(-3.28, 1.9, 0.85, -0.7, 0.5)):
    """Least squares of log((1 - Dice) / Dice), bounded where few states say anything: what hands add stays as it is."""
    weights = weights_of(states)
    truth = np.log(np.array([s.odds for s in states]))

    def residual(d):
        full = (d[0], d[1], d[2], d[3], start[4])
        found = np.log([s.expected_odds(full) for s in states])
        return np.sqrt(weights) * np.arctan(found - truth)

    found = optimize.least_squares(residual, start[:4], bounds=([-8, 0.5, 0.4, -1.5], [2, 3, 1.6, 0]), diff_step=1e-3).x
    return np.append(found, start[4])


def quantile(values, weights, fraction):
    order = np.argsort(values)
    return np.interp(fraction, np.cumsum(weights[order]) / weights.sum(), np.asarray(values)[order])


def fit_intervals(states, dice_without):
    """Of what each structure is off when it is left out: a new one is left out, too."""
    weights = weights_of(states)
    odds = np.array([s.expected_odds(dice_without[s.structure]) for s in states])
    ratio = np.array([s.odds for s in states]) / odds
    volume = (np.array([s.volume_ratio for s in states]) - 1) / odds
    lower = (1 / np.array([s.volume_ratio for s in states]) - 1) / odds
    return {"dice": (quantile(ratio, weights, 0.05), quantile(ratio, weights, 0.95)),
            "volume": (quantile(lower, weights, 0.95), quantile(volume, weights, 0.95))}


def fit_gain(states):
    """Power with which (1 - Dice) / Dice falls with the number of planes, along suggestions."""
    powers = []
    for name in sorted({s.structure for s in states}):
        own = [s for s in states if s.structure == name and s.way == "suggestion"]
        if len(own) > 4:
            powers.append(-np.polyfit(np.log([s.planes for s in own]), np.log([s.odds for s in own]), 1)[0])
    return np.median(powers)


def judged(states, fitted):
    """Rows (structure, coverage of the band, of Dice, of volume, log error of the odds, error of Dice), one for each state."""
    rows = []
    for s in states:
        band, dice, intervals = fitted(s.structure)
        odds = s.expected_odds(dice)
        low, high = intervals["dice"]
        below, above = intervals["volume"]
        rows.append((s.structure, s.coverage(band), low * odds <= s.odds <= high * odds,
                     1 / (1 + below * odds) <= s.volume_ratio <= 1 + above * odds,
                     np.log(odds / s.odds), 1 / (1 + odds) - s.dice, s.planes, s.coverage(band, own_slope=False), s.dice))
    return rows


def print_table(title, rows):
    names = sorted({r[0] for r in rows})
    mean = np.array([[np.mean([r[k] for r in rows if r[0] == name]) for k in (1, 2, 3, 7)] for name in names])
    print(f"{title}: {len(rows)} states of {len(names)} structures")
    print(f"  band covers {mean[:, 0].mean():.3f} of the surface (least {mean[:, 0].min():.3f} of {names[mean[:, 0].argmin()]}, "
          f"most {mean[:, 0].max():.3f}; worst tenth of states {np.quantile([r[1] for r in rows], 0.1):.3f}; "
          f"with the mean slope {mean[:, 3].mean():.3f}, least {mean[:, 3].min():.3f})")
    print("  structures below 0.85: " + ", ".join(f"{n} {m:.3f}" for n, m in zip(names, mean[:, 0]) if m < 0.85))
    for low, high in ((3, 4), (5, 7), (8, 13)):
        some = [r[1] for r in rows if low <= r[6] <= high]
        if some:
            print(f"  {low} to {high} planes: band covers {np.mean(some):.3f}")
    print(f"  Dice in its interval {mean[:, 1].mean():.3f}, volume {mean[:, 2].mean():.3f}")
    good = np.abs([r[5] for r in rows if r[8] > 0.9])
    print(f"  expected Dice above .9: off by {np.median(good):.4f} (median), {np.quantile(good, 0.68):.4f} (68 %), "
          f"{np.quantile(good, 0.9):.4f} (90 %); log odds sd {np.std([r[4] for r in rows]):.3f}")


def print_held(title, states):
    """How much of the true border the band holds, as the program that drew them has it."""
    names = sorted({s.structure for s in states})
    least = min((np.mean([s.held for s in states if s.structure == name]), name) for name in names)
    print(f"{title}, as built: of the border {np.mean([s.held for s in states]):.3f}, least {least[0]:.3f} of {least[1]}")
    for low, high in ((3, 4), (5, 7), (8, 13)):
        some = [s.held for s in states if low <= s.planes <= high]
        if some:
            print(f"  {low} to {high} planes: {np.mean(some):.3f} ({len(some)})")


def read(path):
    with open(path, encoding="utf-8") as file:
        lines = [json.loads(line) for line in file]
    return [State(line) for line in lines if line.get("different_planes", 0) >= 3 and line.get("samples")]


def without_each(states, fit):
    """{structure: what is fitted to all others}"""
    names = sorted({s.structure for s in states})
    return {name: fit([s for s in states if s.structure != name]) for name in names}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("states")
    parser.add_argument("--judge")
    options = parser.parse_args()
    states = read(options.states)
    band, dice = fit_band(states), fit_dice(states)
    band_without, dice_without = without_each(states, fit_band), without_each(states, fit_dice)
    intervals = fit_intervals(states, dice_without)
    print("kBand{" + ", ".join(f"{b:.2f}" for b in band) + "}")
    print("kDice{" + ", ".join(f"{d:.2f}" for d in (*dice, *intervals["dice"])) + "}")
    print("kVolume{" + ", ".join(f"{v:.2f}" for v in intervals["volume"]) + "}")
    print(f"kGainPower = {fit_gain(states):.2f}")
    left_out = judged(states, lambda name: (band_without[name], dice_without[name], intervals))
    print_table("each structure left out in turn", left_out)
    print_held("these structures", states)
    if options.judge:
        others = read(options.judge)
        print_table("other structures", judged(others, lambda name: (band, dice, intervals)))
        print_held("other structures", others)


if __name__ == "__main__":
    main()
