"""Tables of planned tests that were sailed: errors beside plan and stated deviation, and what was asked for."""

from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks.leg_outcomes import Outcome
from benchmarks.monte_carlo_tables import table
from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95

LOOP_GAIN = "v K_p / (tau_up + tau_dn)"
# Largest rms errors [%] that a test of 12 minutes at two speeds may have.
BARS_12 = {
    "K_p": 1.8, "t_d": 12.0, LOOP_GAIN: 3.8, "tau_dn": 0.10, "k_q": 0.09, "K_p / K_i": 2.1, "tau_up": 5.0,
}  # fmt: skip
BARS_IDLE_600 = {"K_p": 2.3, "t_d": 13.0, LOOP_GAIN: 4.2, "tau_up": 5.7, "K_p / K_i": 2.5}
LOWEST_P_VALUE = 0.05
# Without size in the truth, so that errors are stated as they are, in the unit or in ms.
ABSOLUTE = {"g": ("", 1.0), "t_gauge": (" ms", 1e3)}


def case_table(
    title: str,
    outcomes: Sequence[Outcome],
    planned: Mapping[str, float],
    assumed: Mapping[str, float],
    bars: Mapping[str, float],
) -> str:
    """Return one row a number, and the p-values.

    Parameters
    ----------
    outcomes
        What the recordings gave.
    planned
        Planned standard deviation of each number for the assumed ship.
    assumed
        Parameters of the ship that the plan assumes.
    bars
        Largest rms errors that are asked for [%].
    """
    rows = [_row(name, outcomes, planned[name], assumed, bars.get(name)) for name in planned]
    header = [
        "number", "rms error", "asked", "planned std", "rms error / planned", "stated std", "rms z", "mean z", "covers",
    ]  # fmt: skip
    return table(f"{title}, {len(outcomes)} recordings", header, rows) + f"\n{_p_values(outcomes)}\n"


def summary(cases: Sequence[tuple[str, Sequence[Outcome]]]) -> str:
    """Return one row a case: what the intervals of all numbers together say."""
    rows = []
    for name, outcomes in cases:
        z = np.array([[one.error[number] / one.std[number] for number in one.error] for one in outcomes])
        rms, mean, covers = np.sqrt((z**2).mean(axis=0)), z.mean(axis=0), 100.0 * (np.abs(z) < NORMAL_95).mean(axis=0)
        rows.append([
            name, f"{len(outcomes)}", f"{rms.min():.2f} to {rms.max():.2f}", f"{mean.min():+.2f} to {mean.max():+.2f}",
            f"{covers.min():.0f} to {covers.max():.0f} %", f"{covers.mean():.1f} %",
        ])  # fmt: skip
    header = ["test", "recordings", "rms z", "mean z", "covers, each number", "covers, all"]
    return table("All tests", header, rows)


def _row(
    name: str, outcomes: Sequence[Outcome], planned: float, assumed: Mapping[str, float], bar: float | None
) -> list[str]:
    error, std, truth = (
        np.array([getattr(one, field)[name] for one in outcomes]) for field in ("error", "std", "truth")
    )
    z = error / std
    if name in ABSOLUTE:
        unit, factor = ABSOLUTE[name]
        # the recording may be normalised at another speed than the plan; g goes as the gains do
        at_plan = _at_plan(outcomes, assumed) if name == "g" else np.ones(len(outcomes))
        size, planned_size = factor * at_plan, factor * planned
    else:
        unit, size = " %", 100.0 / np.abs(truth)
        planned_size = 100.0 * planned / abs(_assumed_value(name, assumed))
    rms = float(np.sqrt(np.mean((size * error) ** 2)))
    stated = float(np.sqrt(np.mean((size * std) ** 2)))
    return [
        f"`{name}`", f"{rms:.2g}{unit}", "" if bar is None else f"{bar:g}{unit}", f"{planned_size:.2g}{unit}",
        f"{rms / planned_size:.2f}", f"{stated:.2g}{unit}", f"{np.sqrt(np.mean(z**2)):.2f}", f"{z.mean():+.2f}",
        f"{100.0 * np.mean(np.abs(z) < NORMAL_95):.0f} %",
    ]  # fmt: skip


def _at_plan(outcomes: Sequence[Outcome], assumed: Mapping[str, float]) -> FloatArray:
    return np.array([assumed["K_p"] / one.truth["K_p"] for one in outcomes])


def _assumed_value(name: str, assumed: Mapping[str, float]) -> float:
    total = assumed["tau_up"] + assumed["tau_dn"]
    combinations = {
        "t_d + t_sp": assumed["t_d"] + assumed["t_sp"],
        "K_p / K_i": assumed["K_p"] / assumed["K_i"],
        "v K_i / (k_q - g)": assumed["K_i"] / (assumed["k_q"] - assumed["g"]),
        LOOP_GAIN: assumed["K_p"] / total,
    }
    return {**assumed, **combinations}[name]


def _p_values(outcomes: Sequence[Outcome]) -> str:
    p_values = np.array([one.p_value for one in outcomes])
    limited = 100.0 * max(one.limited for one in outcomes)
    return (
        f"p-value of the joint fit: mean {p_values.mean():.2f}, below {LOWEST_P_VALUE:g} in "
        f"{100.0 * np.mean(p_values < LOWEST_P_VALUE):.0f} %. A limit of torque or rack acted for at most {limited:.2g}"
        " % of a leg."
    )
