# SPDX-License-Identifier: Apache-2.0
"""Stacks that begin anywhere in a gap: which slices they keep, and what the table takes the mean of."""
import numpy as np
import pytest

import starts


def test_every_start_is_there_and_keeps_slices_as_far_apart():
    truth = np.zeros((4, 4, 20), bool)
    truth[1:3, 1:3, 3:19] = True
    kept = dict(starts.kept_slices(truth))
    assert len(kept) == 10
    for drawing, some in kept.items():
        step, start = (int(part) for part in drawing.removeprefix("slices").split("_from"))
        assert some[0] == 3 + start and set(np.diff(some)) == {step}


def test_one_slice_alone_is_no_stack():
    truth = np.zeros((4, 4, 20), bool)
    truth[1:3, 1:3, 3:8] = True
    assert set(dict(starts.kept_slices(truth))) == {"slices2_from0", "slices2_from1", "slices4_from0"}


def row(structure, drawing, dice):
    return {"object": structure, "drawing": drawing, "kontur": {"dice": dice}}


def test_structures_with_few_starts_count_as_much_as_those_with_many():
    rows = [row("a", "slices4_from0", 0.8), row("a", "slices4_from1", 0.6), row("b", "slices4_from0", 0.9)]
    assert starts.means(rows) == {"1 in 4": pytest.approx(0.8)}
