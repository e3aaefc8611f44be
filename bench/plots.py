# SPDX-License-Identifier: Apache-2.0
"""How the benchmarks' plots look, and where they are written: the same figures make the same bytes."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

BLUE, RED, GREEN, VIOLET, GREY = "#1b6ca8", "#c4552d", "#4a8f3c", "#8a5fb0", "#777777"
METHOD_COLOURS = {"nearest slice": "#999999", "shape-based": RED, "plain": GREEN, "kontur": BLUE, "paper": VIOLET}
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "kontur", "font.size": 8, "axes.titlesize": 9, "axes.grid": True, "axes.axisbelow": True,
    "grid.color": "#dddddd", "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.6,
    "lines.markersize": 3.5,
})


def plain_ticks(axis, ticks):
    """Ticks of a logarithmic axis, as decimal numbers."""
    axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)


def save(figure, path, legend_of=None):
    """An SVG or a PNG, by the name of the file, without the date of the day. The legend of axes may stand below all panels."""
    below = 0.0
    if legend_of:
        handles, labels = legend_of.get_legend_handles_labels()
        figure.legend(handles, labels, ncol=len(labels), loc="lower center")
        below = 0.3 / figure.get_figheight()
    figure.tight_layout(rect=(0, below, 1, 1))
    figure.savefig(path, dpi=110, metadata={"Date": None} if str(path).endswith(".svg") else {"Software": None})
    pyplot.close(figure)
