# SPDX-License-Identifier: Apache-2.0
"""The functions of docs/fill.md for napari and 3D Slicer do what they say, with stand-ins that have what they use of either.

Neither program is in Debian: what is tested is what kontur has to do with it, not that the stand-ins are like them.
"""
import pathlib
import sys
import types

import numpy
import pytest

kontur = pytest.importorskip("kontur", reason="this build has no Python package")

from blocks import blocks_of

PAGE = pathlib.Path(__file__).parents[2] / "docs/fill.md"
SPACING = (2.5, 1, 1.2)  # along the arrays' axes: z, y, x


def function(name):
    """As the page has it."""
    [block] = [block for block in blocks_of(PAGE) if f"def {name}(" in block.text]
    names = {"kontur": kontur}
    exec(block.text, names)
    return names[name]


@pytest.fixture
def body():
    z, y, x = numpy.mgrid[:25, :48, :44]
    return (((z - 12) * 2.5) ** 2 + (y - 24) ** 2 + ((x - 22) * 1.2) ** 2 < 20**2).astype("uint8")


def painted(body):
    return numpy.where((numpy.arange(25) % 4 == 0)[:, None, None], body, 0)


def assert_filled(full, body):
    between = slice(8, 17)  # painted at both ends
    assert full.dtype == body.dtype and (full[::4] == painted(body)[::4]).all()
    assert (full[between] != body[between]).sum() < 0.03 * body[between].sum()


def test_the_selected_layer_of_napari_is_filled(body):
    layer = types.SimpleNamespace(data=painted(body), scale=numpy.array(SPACING))
    viewer = types.SimpleNamespace(layers=types.SimpleNamespace(selection=types.SimpleNamespace(active=layer)))
    function("fill_selected")(viewer)
    assert_filled(layer.data, body)


def test_a_segment_of_slicer_is_filled(body, monkeypatch):
    kept = {("node", "liver", "volume"): painted(body)}
    reference = types.SimpleNamespace(GetSpacing=lambda: SPACING[::-1])  # x, y, z

    class Util:
        @staticmethod
        def arrayFromSegmentBinaryLabelmap(node, segment, volume=None):
            assert volume is reference
            return kept[node, segment, "volume"].copy()

        @staticmethod
        def updateSegmentBinaryLabelmapFromArray(array, node, segment, volume=None):
            assert volume is reference
            kept[node, segment, "volume"] = array

    monkeypatch.setitem(sys.modules, "slicer", types.SimpleNamespace(util=Util))
    function("fill_segment")("node", "liver", reference)
    assert_filled(kept["node", "liver", "volume"], body)
