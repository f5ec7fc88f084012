"""The legs of a campaign: their working points, and how well one model explains each of them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.survey._legs import LegMeasurement, LegTest


def leg_table(legs: Sequence["LegMeasurement"]) -> Table:
    """Return the working point of each leg and how much of it was measured."""
    return Table(
        title="Legs: working points from whole periods",
        columns=(*texts("leg"), *numbers("n_0 [rpm]", "M_0 [N m]", "set point [V]", "lines", "used")),
        rows=tuple(_cells(leg) for leg in legs),
        note="n_0 is the mean speed of the leg, M_0 the torque of its propeller there; its load is 1 by definition.",
    )


def leg_test_table(tests: Sequence["LegTest"], *, p_value: float | None) -> Table:
    """Return how well one model explains each leg.

    ``tests``: the legs with their shares of the test of fit. ``p_value``: that of the fit to all of them.
    """
    return Table(
        title="One model for all legs",
        columns=(*texts("leg"), *numbers("n_0 [rpm]", "M_0 [N m]", "chi-square", "freedom", "p")),
        rows=tuple(
            (
                one.name,
                *_speed_and_torque(one.working_point),
                plain(one.test.chi_square, 1),
                plain(one.test.mean, 1),
                p_value_text(one.test.p_value),
            )
            for one in tests
        ),
        note=(
            "p is the probability of a misfit at least this large if the same model holds at all speeds. All "
            f"together: p = {p_value_text(p_value)}."
        ),
    )


def _cells(leg: "LegMeasurement") -> tuple[str, ...]:
    point, response = leg.working_point, leg.spectra.response
    return (
        leg.name,
        *_speed_and_torque(point),
        plain(point.set_point_v, 3),
        str(len(response.lines)),
        str(int(response.used.sum())),
    )


def _speed_and_torque(point: "WorkingPoint") -> tuple[str, str]:
    return (
        with_deviation(rpm_from_rev_s(point.engine_speed_rev_s), rpm_from_rev_s(point.engine_speed_std_rev_s)),
        with_deviation(point.shaft_torque_nm, point.shaft_torque_std_nm),
    )
