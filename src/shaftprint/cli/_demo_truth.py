"""The truth of a simulated recording under the names of a fingerprint, to be printed beside the estimates."""

from collections.abc import Sequence

import numpy as np

from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._tables import print_table
from shaftprint.models import Structure, margins
from shaftprint.signals import Signals, StripAngles, WorkingPoint
from shaftprint.tug import Truth
from shaftprint.units import rpm_from_rev_s

DEGREES_PER_REVOLUTION = 360.0


# Parameters that are normalised with speed over torque of the working point: inertia times and governor gains.
SPEED_OVER_TORQUE = ("tau_up", "tau_dn", "tau_n", "K_p", "K_i")


def fingerprint_truth(truth: Truth, structure: Structure, point: WorkingPoint) -> dict[str, float]:
    """Return true parameters, combinations, inertias and margins by the names of the fingerprint.

    The load of the propeller drifts, so the line was tested at a torque that is a per cent or so off the nominal one.
    The parameters are normalised at the working point that was measured, like the estimates. The margins are those of
    the structure at the true parameters: the linear behaviour of the simulated line.
    """
    moved = rpm_from_rev_s(point.engine_speed_rev_s) / truth.engine_speed_rpm
    moved *= truth.shaft_torque_nm / point.shaft_torque_nm
    named = {
        name: value * moved if name in SPEED_OVER_TORQUE else value
        for name, value in truth.normalised.items()
        if name in structure.names
    }
    if "c_set" in structure.names:
        named["c_set"] = 1.0
    values = structure.vector(named)
    found = dict(named)
    complete = {name: np.asarray(value) for name, value in zip(structure.names, values, strict=True)}
    found |= {combination.name: float(combination.of(complete)) for combination in structure.combinations}
    found |= {
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "I_up": truth.physical["inertia_upstream_kg_m2"],
    }
    if structure.loop is not None:
        linear = margins(structure, values)
        found |= {
            "gain margin": linear.gain_margin,
            "phase margin": float(np.degrees(linear.phase_margin_rad)),
            "delay margin": linear.delay_margin_s,
        }
    return found


def print_measurement_truth(signals: Signals, truth: Truth) -> None:
    """Print what the measurement chain found beside what was put into it."""
    point, line = signals.working_point, signals.calibration
    slope_std = rpm_from_rev_s(float(np.sqrt(line.covariance[0, 0])))
    rows = [
        _row("engine speed n_0", "rpm", rpm_from_rev_s(point.engine_speed_rev_s),
             rpm_from_rev_s(point.engine_speed_std_rev_s), truth.engine_speed_rpm),
        _row("shaft torque M_s0", "N m", point.shaft_torque_nm, point.shaft_torque_std_nm, truth.shaft_torque_nm),
        _row("set-point line, slope", "rpm/V", rpm_from_rev_s(line.slope_rev_s_per_v), slope_std,
             truth.set_point_slope_rpm_per_v),
    ]  # fmt: skip
    for strips in signals.strips:
        true = next(found.angle_deg for found in truth.strips if found.channel == strips.channel)
        rows += _strip_rows(strips, true)
    columns = ("quantity", "unit", "value +/- 1 std", "truth")
    print_table("What the measurement chain found", columns, rows, numbers=(2, 3))


def _strip_rows(strips: StripAngles, true_deg: Sequence[float]) -> list[tuple[str, ...]]:
    """Return a row for each strip; which one is counted first cannot be seen in a recording."""
    found = DEGREES_PER_REVOLUTION * strips.angle_rev
    std = DEGREES_PER_REVOLUTION * strips.std_rev
    turned = [np.roll(true_deg, shift) for shift in range(found.size)]
    true = min(turned, key=lambda angles: float(np.abs(angles - found).max()))
    return [
        _row(f"{strips.channel}, strip {number} to the next", "deg", *map(float, row))
        for number, row in enumerate(zip(found, std, true, strict=True), start=1)
    ]


def _row(name: str, unit: str, value: float, std: float, true: float) -> tuple[str, ...]:
    return name, unit, with_uncertainty(value, std), f"{true:.6g}"
