"""Interactive plot of differences between fingerprints."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.report.figures import shown_names, shown_percent
from shaftprint.report.plots._panels import Grid, room_px
from shaftprint.report.plots._plot import Plot, numbers
from shaftprint.report.plots._traces import MARKERS, colour, points
from shaftprint.report.plots._words import label_text, name_text

if TYPE_CHECKING:
    from shaftprint.report.comparison import Difference

ROW_PX, FRAME_PX = 30, 150


def difference_plot(found: Mapping[str, Sequence["Difference"]]) -> Plot:
    """Return differences in percent of the first fingerprint, each with its 95 % interval.

    Parameters
    ----------
    found
        Differences from the first fingerprint, by the name of the other.
    """
    names = shown_names(found)
    order = [name_text(name) for name in names]
    heading = "difference from the first fingerprint, with 95 % interval [%]"
    grid = Grid(x_titles=[heading], left_px=room_px(order))
    axes = grid.place(0, 0)
    traces = []
    for index, (label, differences) in enumerate(found.items()):
        shown = [(d, percent) for d in differences if (percent := shown_percent(d)) is not None]
        drawn = points(
            [percent[0] for _, percent in shown],
            [],
            label_text(label),
            axes,
            shade=colour(index),
            marker=MARKERS[index % len(MARKERS)],
            words=[d.outcome for d, _ in shown],
        )
        drawn["y"] = [name_text(d.first.name) for d, _ in shown]
        drawn["error_x"] = {
            "type": "data",
            "symmetric": False,
            "array": numbers([high - value for _, (value, _, high) in shown]),
            "arrayminus": numbers([value - low for _, (value, low, _) in shown]),
            "color": colour(index),
            "thickness": 1.4,
            "width": 4,
        }
        traces.append(drawn)
    layout = grid.layout()
    layout["xaxis"]["zeroline"] = True
    layout["yaxis"] |= {"type": "category", "categoryorder": "array", "categoryarray": order, "autorange": "reversed"}
    return Plot(traces=traces, layout=layout, height_px=FRAME_PX + ROW_PX * len(names))
