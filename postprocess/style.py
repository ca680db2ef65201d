"""What all figures share: fonts, colours, how they are saved."""

import matplotlib.pyplot as plt
from matplotlib import colors

# Blue (c = 0) over a dark neutral to red (c = 1): lightness falls towards the middle, so that the membrane
# stands out from white paper at every composition.
COMPOSITION = colors.LinearSegmentedColormap.from_list(
    "composition", ["#1f6fd6", "#4a5fb0", "#5d5470", "#a84a5a", "#e0312f"]
)
INK = "#222222"
STREAMLINES = "#b5b5b5"
LINES = ["#0b5fa5", "#c8442b", "#3a8f4d", "#8659a8", "#b8860b", "#555555"]


def apply():
    plt.rcParams.update(
        {
            "font.size": 9,
            "axes.titlesize": 9,
            "axes.labelsize": 9,
            "legend.fontsize": 8,
            "xtick.labelsize": 8,
            "ytick.labelsize": 8,
            "axes.edgecolor": INK,
            "axes.linewidth": 0.8,
            "axes.prop_cycle": plt.cycler(color=LINES),
            "axes.grid": False,
            "legend.frameon": False,
            "lines.linewidth": 1.4,
            "savefig.dpi": 200,
        }
    )


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    return path
