"""Tables of tests with faults of generator and governor."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.leg_outcomes import Outcome
from benchmarks.monte_carlo_tables import table
from shaftprint.digits import p_value_text
from shaftprint.distributions import NORMAL_95

LOWEST_P_VALUE = 0.05


@dataclass(frozen=True, kw_only=True)
class Refusal:
    """What the program says of one recording of a governor that is another at each speed."""

    seed: int
    """Seed of the recording."""
    p_value: float
    """Of the joint fit, with what the vessel file knows."""
    free_p_value: float
    """Of the joint fit with nothing known beforehand."""
    trustworthy: bool
    """Whether the verdict lets numbers of the joint fit be used."""
    leg_p_values: Mapping[str, float]
    """Of each leg with a model of its own; empty where the joint fit is not refused."""
    offered: Sequence[str]
    """Legs whose own result is offered."""
    errors: Mapping[str, Mapping[str, float]]
    """Errors over deviations of the numbers of each leg that is offered."""
    words: str
    """What is said."""


def generator_table(cases: Sequence[tuple[str, Sequence[Outcome]]]) -> str:
    """Return one row a fault of the generator: what the intervals of all numbers together say.

    The change by the fault is that of the error over its deviation, against the first case with the same seeds: rms
    of the number that changes most.
    """
    rows = []
    for name, outcomes in cases:
        z = np.array([[one.error[number] / one.std[number] for number in one.error] for one in outcomes])
        rms, mean, covers = np.sqrt((z**2).mean(axis=0)), z.mean(axis=0), 100.0 * (np.abs(z) < NORMAL_95).mean(axis=0)
        p_values = np.array([one.p_value for one in outcomes])
        rows.append([
            name, f"{len(outcomes)}", _stated(outcomes, "K_p"), _stated(outcomes, "t_d"),
            f"{rms.min():.2f} to {rms.max():.2f}", f"{mean.min():+.2f} to {mean.max():+.2f}",
            f"{covers.min():.0f} to {covers.max():.0f} %", f"{covers.mean():.1f} %", _change(outcomes, cases[0][1]),
            f"{p_values.mean():.2f}", f"{100.0 * np.mean(p_values < LOWEST_P_VALUE):.0f} %",
        ])  # fmt: skip
    header = [
        "fault", "recordings", "stated std of `K_p`", "of `t_d`", "rms z", "mean z", "covers, each number",
        "covers, all", "change by the fault", "mean p", "p < 0.05",
    ]  # fmt: skip
    return table("Generator and recorder", header, rows) if rows else ""


def governor_table(cases: Sequence[tuple[str, Sequence[Refusal]]], *, rejected: float) -> str:
    """Return one row a governor: how often the joint fit is refused, and what is offered instead.

    Parameters
    ----------
    cases
        Names and recordings.
    rejected
        Probability below which a fit is refused.
    """
    rows = []
    for name, all_of in cases:
        refused = [one for one in all_of if one.p_value < rejected]
        z = np.array([abs(error) for one in refused for leg in one.errors.values() for error in leg.values()])
        alone = [p_value >= rejected for one in refused for p_value in one.leg_p_values.values()]
        p_values = [one.p_value for one in all_of]
        rows.append([
            name, f"{len(all_of)}", _share([one.p_value < rejected for one in all_of]),
            _share([one.free_p_value < rejected for one in all_of]),
            f"{p_value_text(float(np.median(p_values)))}, {p_value_text(max(p_values))}",
            _share([one.trustworthy for one in all_of]),
            _share([bool(one.offered) for one in refused]), _share(alone), _share(list(z < NORMAL_95)),
        ])  # fmt: skip
    header = [
        "governor", "recordings", "joint fit refused", "the same, nothing known", "median and largest p",
        "numbers of the joint fit trusted", "of those refused: a speed offered", "leg alone fits",
        "intervals of one speed that cover",
    ]  # fmt: skip
    return table(f"Governor, refused where p < {rejected:g}", header, rows) if rows else ""


def _change(outcomes: Sequence[Outcome], without: Sequence[Outcome]) -> str:
    ideal = {one.seed: one for one in without}
    pairs = [(one, ideal[one.seed]) for one in outcomes if one.seed in ideal]
    if outcomes is without or not pairs:
        return ""
    changes = [
        [one.error[name] / one.std[name] - other.error[name] / other.std[name] for name in one.error]
        for one, other in pairs
    ]
    return f"{np.sqrt(np.mean(np.square(changes), axis=0)).max():.2f}"


def _stated(outcomes: Sequence[Outcome], name: str) -> str:
    shares = np.array([one.std[name] / abs(one.truth[name]) for one in outcomes])
    return f"{100.0 * np.sqrt(np.mean(shares**2)):.2g} %"


def _share(held: Sequence[bool]) -> str:
    return f"{100.0 * np.mean(held):.0f} %" if held else ""
