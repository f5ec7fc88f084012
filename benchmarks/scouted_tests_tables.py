"""Tables of ships that are not known: whether limits are kept, and what the main test found, beside the known ship."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.leg_outcomes import NAME
from benchmarks.monte_carlo_tables import table
from benchmarks.planned_tests_tables import ABSOLUTE
from benchmarks.sailed_limits import SPEED_NOISE, TOUCHED, SailedLimits
from shaftprint.arrays import FloatArray
from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95

if TYPE_CHECKING:
    from benchmarks.scouted_tests import Outcome

USES: Mapping[str, str] = {
    "at_full_load": "brake torque over full load",
    "at_motoring": "motoring torque over what there is",
    "lowest_speed": "lowest speed over the lowest allowed",
    "highest_speed": "highest speed over the highest allowed",
    "set_point_rpm": "set point from its level [rpm]",
    "rate_rpm_per_s": "change of the set point [rpm/s]",
}


def scouted_table(outcomes: Sequence["Outcome"]) -> str:
    """Return one row a limit and one row a number, over all ships."""
    sailed = [one for one in outcomes if not one.refused]
    return _limits(outcomes, sailed) + _numbers(sailed) if sailed else "\nNo ship gave a main test.\n"


def _limits(outcomes: Sequence["Outcome"], sailed: Sequence["Outcome"]) -> str:
    first = [SailedLimits(**one.scouting_limits) for one in sailed]
    main = [SailedLimits(**one.limits) for one in sailed]
    rows = [
        [words, *(_range(np.array([getattr(one, name) for one in limits])) for limits in (first, main))]
        for name, words in USES.items()
    ]
    share = np.array([one.limited for one in main])
    text = table(
        f"{len(outcomes)} ships: what was reached in the windows, median and range",
        ["reached", "scouting test", "main test"],
        rows,
    )
    text += (
        f"\nAll limits were kept by the main test on {sum(one.are_kept for one in main)} of {len(outcomes)} ships, by "
        f"the scouting test on {sum(one.are_kept for one in first)} of {len(sailed)}. A limit of torque or rack acted "
        f"in the main test on {np.count_nonzero(share)} ships, on {np.count_nonzero(share > TOUCHED)} for more than "
        f"{100.0 * TOUCHED:.2g} % of a window, at most for {100.0 * share.max():.2g} %. Speeds may pass theirs by "
        f"{100.0 * SPEED_NOISE:.2g} %.\n"
    )
    return text + "".join(f"\nShip {one.seed}, no main test: {one.refused}\n" for one in outcomes if one.refused)


def _range(values: FloatArray) -> str:
    return f"{np.median(values):.3g} ({values.min():.3g} to {values.max():.3g})"


def _numbers(sailed: Sequence["Outcome"]) -> str:
    names = list(sailed[0].known)
    header = [
        "number", "scouted, stated", "ship known, planned", "after scouting", "after / known", "quarters",
        "stated / known", "rms error / known", "main test: rms z, covers", "scouting test: rms z, covers",
    ]  # fmt: skip
    medians = {name: float(np.median(_of(name, "expected", sailed) / _of(name, "known", sailed))) for name in names}
    worst = max(medians, key=lambda name: medians[name])
    held = [abs(one.error[name]) < NORMAL_95 * one.std[name] for one in sailed for name in names]
    p_values = np.array([one.p_value for one in sailed])
    text = table(
        f"{len(sailed)} ships: the main test, medians over the ships", header, [_row(n, sailed) for n in names]
    )
    return text + (
        f"\nLargest median of after / known: {medians[worst]:.2f} (`{worst}`). All 95 % intervals of the main test "
        f"together hold the truth in {100.0 * np.mean(held):.1f} %; p-value of its joint fit: mean "
        f"{p_values.mean():.2f}, below 0.05 in {100.0 * np.mean(p_values < 0.05):.0f} %.\n"
    )


def _row(name: str, sailed: Sequence["Outcome"]) -> list[str]:
    known, expected, error, std, first_error, first_std = (
        _of(name, field, sailed) for field in ("known", "expected", "error", "std", "scouted_error", "scouted_std")
    )
    unit, factor = ABSOLUTE.get(name, (" %", 100.0))
    deviations = (f"{factor * float(np.median(one)):.2g}{unit}" for one in (first_std, known, expected))
    quarters = np.percentile(expected / known, [25.0, 75.0])
    return [
        f"`{name}`",
        *deviations,
        f"{np.median(expected / known):.2f}",
        f"{quarters[0]:.2f} to {quarters[1]:.2f}",
        f"{np.median(std / known):.2f}",
        f"{np.sqrt(np.mean((error / known) ** 2)):.2f}",
        _covers(error / std),
        _covers(first_error / first_std),
    ]


def _covers(z: FloatArray) -> str:
    return f"{np.sqrt(np.mean(z**2)):.2f}, {100.0 * np.mean(np.abs(z) < NORMAL_95):.0f} %"


def _of(name: str, field: str, sailed: Sequence["Outcome"]) -> FloatArray:
    """Return deviations or errors of each ship, over its value where that is not near zero.

    Fits are normalised at the first leg, predictions at the working point of the vessel file. Relative numbers are the
    same at both; ``g`` goes as the gains do.
    """
    values = np.array([getattr(one, field)[name] for one in sailed])
    of_fit = field not in ("known", "expected")
    if name == "g":
        return values * [one.ship["K_p"] / one.truth["K_p"] for one in sailed] if of_fit else values
    if name in ABSOLUTE:
        return values
    truths = [abs(one.truth[name] if of_fit else true_number(name, one.ship)) for one in sailed]
    return np.asarray(values / truths)


def true_number(name: str, ship: Mapping[str, float]) -> float:
    """Return a parameter or combination of a true ship."""
    return {**ship, **combinations_of(ship), "c_set": 1.0}[name]


def combinations_of(ship: Mapping[str, float]) -> dict[str, float]:
    """Return the combinations of a true ship."""
    return {one.name: float(one.of(ship)) for one in structure(NAME).combinations}  # type: ignore[arg-type]
