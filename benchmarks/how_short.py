"""How short a test can be: accuracy that room ``design`` predicts over the length of the test, as a table and a figure.

Every point is a plan of its own for the shipped Stan Tug within the limits of its vessel file. Run
``python -m benchmarks.how_short`` (two minutes); it writes ``docs/images/how-short.svg``.
"""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from benchmarks.planned_tests import CLOSED, TRUTH, VESSEL
from shaftprint.arrays import FloatArray
from shaftprint.campaign import load_campaign
from shaftprint.design import assumed_ship, design_campaign, limits_from_vessel, no_worse_than
from shaftprint.errors import DesignError
from shaftprint.identify import Prior, planned_response, predict_accuracy
from shaftprint.identify.prediction._accuracy import Accuracy
from shaftprint.survey import STAN_TUG_NOISE, STAN_TUG_NOISE_AT_SPEEDS

FIGURE = Path(__file__).parent.parent / "docs" / "images" / "how-short.svg"
MINUTES = (3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 30.0)
BUILDER = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.0285)}
RPM_PER_V = 251.0
# Errors of sailed tests over planned deviations lie between these for nearly all numbers (docs/decisions/0053).
BAND = (0.8, 1.4)
SHOWN = {
    "t_d": "delay t_d",
    "v K_p / (tau_up + tau_dn)": "loop gain",
    "K_p": "gain K_p",
    "K_p / K_i": "reset time",
    "tau_dn": "inertia tau_dn",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Way:
    """One way to test."""

    name: str
    """What it is."""
    speeds: tuple[float, ...]
    """Speeds of the legs over that of the working point."""
    volts: float
    """Largest deviation of the set point from its level [V]."""
    priors: Mapping[str, Prior] = field(default_factory=dict)
    """What is known from the builder."""


WAYS = (
    Way(name="two speeds, 1.0 V", speeds=(1.15, 0.78), volts=1.0),
    Way(name="two speeds, 0.6 V", speeds=(1.15, 0.78), volts=0.6),
    Way(name="one speed, 1.0 V, inertia from the builder", speeds=(1.0,), volts=1.0, priors=BUILDER),
    Way(name="one speed, 0.6 V, inertia from the builder", speeds=(1.0,), volts=0.6, priors=BUILDER),
)


def thesis() -> Accuracy:
    """Return what the campaign of the thesis would tell, with the inertia from the builder."""
    lines = planned_response(load_campaign("thesis"), STAN_TUG_NOISE)
    return predict_accuracy(CLOSED, lines, values=TRUTH, priors=BUILDER)


def percent(accuracy: Accuracy, name: str) -> float:
    """Return the standard deviation of a number over its value [%]."""
    estimate = accuracy.estimate(name)
    return 100.0 * estimate.std / abs(estimate.value)


def curve(way: Way, minutes: Sequence[float], wished: Accuracy) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return lengths [min] and the standard deviations [%] that plans of these lengths predict.

    Parameters
    ----------
    minutes
        Lengths to plan for; one that is too short for whole periods is left out.
    wished
        Every number is wished no worse than there, but the latency of the gauge.
    """
    lengths, rows = [], []
    for length in minutes:
        try:
            plan = design_campaign(
                assumed_ship(CLOSED, TRUTH, std={}),
                no_worse_than((*wished.parameters, *wished.combinations), but=("t_gauge",)),
                limits_from_vessel(VESSEL, set_point_rpm=RPM_PER_V * way.volts),
                STAN_TUG_NOISE_AT_SPEEDS,
                speeds=way.speeds,
                within_s=60.0 * length,
                rng=np.random.default_rng(1),
                priors=way.priors,
            )
        except DesignError as error:
            print(f"{way.name}, {length:g} min: {error}")
            continue
        lengths.append(plan.duration_s / 60.0)
        rows.append([percent(plan.predicted, name) for name in SHOWN])
    return np.array(lengths), dict(zip(SHOWN, np.array(rows).T, strict=True))


def print_table(curves: Mapping[str, tuple[FloatArray, dict[str, FloatArray]]], wished: Accuracy) -> None:
    """Print the curves."""
    print("| test | min | " + " | ".join(f"`{name}` %" for name in SHOWN) + " |\n|---|---" + "|---" * len(SHOWN) + "|")
    for name, (lengths, values) in curves.items():
        for place, length in enumerate(lengths):
            cells = " | ".join(f"{values[number][place]:.2g}" for number in SHOWN)
            print(f"| {name} | {length:.1f} | {cells} |")
    cells = " | ".join(f"{percent(wished, number):.2g}" for number in SHOWN)
    print(f"| sines of the thesis, inertia from the builder | 191 | {cells} |")


def draw(curves: Mapping[str, tuple[FloatArray, dict[str, FloatArray]]], wished: Accuracy, path: Path) -> None:
    """Draw every number of the first way, and the delay of all of them."""
    mpl.rcParams |= {"svg.hashsalt": "how-short", "svg.fonttype": "none", "font.size": 9}
    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    numbers, ways = figure.subplots(1, 2, sharex=True)
    first, (lengths, values) = next(iter(curves.items()))
    for name, label in SHOWN.items():
        (line,) = numbers.plot(lengths, values[name])
        numbers.fill_between(lengths, *(share * values[name] for share in BAND), color=line.get_color(), alpha=0.15)
        # two of the lines end at one place
        rise = {"K_p": -10.0, "K_p / K_i": 4.0}.get(name, -3.0)
        end = (lengths[-1], values[name][-1])
        numbers.annotate(label, end, xytext=(4, rise), textcoords="offset points", color=line.get_color())
    numbers.set_title(f"{first}: what becomes known", loc="left")
    for name, (length, of_way) in curves.items():
        (line,) = ways.plot(length, of_way["t_d"])
        # two of the lines end at one place; of them the stronger test has its name below
        rise = {"one speed, 0.6 V": 6.0, "one speed, 1.0 V": -24.0}.get(name.partition(", inertia")[0], -3.0)
        end = (length[-1], of_way["t_d"][-1])
        words = name.replace(", inertia", "\ninertia")
        ways.annotate(words, end, xytext=(4, rise), textcoords="offset points", color=line.get_color())
    ways.axhline(percent(wished, "t_d"), color="0.4", linestyle=":")
    ways.set_title("delay t_d (dotted: sines of the thesis, 191 min)", loc="left")
    for axis in (numbers, ways):
        axis.set(xscale="log", yscale="log", xlabel="length of the test [min]", xlim=(2.8, 130.0))
        axis.set_xticks([3, 5, 8, 12, 20, 30], ["3", "5", "8", "12", "20", "30"])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    numbers.set_ylabel("predicted standard deviation [%]")
    numbers.set_yticks([0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20], ["0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10", "20"])
    ways.set_yticks([5, 10, 20, 40], ["5", "10", "20", "40"])
    ways.set_ylim(4.0, 60.0)
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    """Plan, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=FIGURE, help="figure to write: SVG, or PNG to look at")
    options = parser.parse_args()
    wished = thesis()
    curves = {way.name: curve(way, MINUTES, wished) for way in WAYS}
    print_table(curves, wished)
    draw(curves, wished, options.output)


if __name__ == "__main__":
    main()
