"""Two masses in place of the whole line, for identification."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex
from shaftprint.torsion._forced_response import forced_response
from shaftprint.torsion._line import TorsionalLine
from shaftprint.torsion._modes import modes

# Frequencies at which the errors are taken, as shares of the natural frequency.
GRID = np.linspace(0.02, 3.0, 150)
ACCURATE = 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class TwoMasses:
    """Engine side and propeller side of the torque gauge with one spring, at the propeller shaft.

    ``J_e dw_e/dt = T - M_s``, ``M_s = k q + c (w_e - w_p)``, ``dq/dt = w_e - w_p``, ``J_p dw_p/dt = M_s - d w_p``.
    """

    engine_kg_m2: float
    """``J_e`` [kg m2]: everything upstream of the gauge."""
    propeller_kg_m2: float
    """``J_p`` [kg m2]: everything downstream of it."""
    stiffness_nm_rad: float
    """``k`` [N m/rad]: gives the natural frequency of the whole line's first mode."""
    damping_nm_s_rad: float
    """``c`` [N m s/rad]: gives its damping ratio."""
    load_nm_s_rad: float
    """``d`` [N m s/rad]: slope of the propeller torque."""
    frequency_hz: float
    """Natural frequency of the first mode [Hz]."""
    frequency_std_hz: float
    """Its standard deviation [Hz]."""
    damping_ratio: float
    """Damping ratio of the first mode."""
    series_hz: float
    """What all springs from the driven mass to the propeller behind each other give with these masses [Hz]."""
    gauge_error: float
    """Error of the gauge torque at the natural frequency, as a share of it."""
    accurate_to_hz: float
    """Up to here gauge torque and speed of the driven mass are within a tenth of those of the whole line [Hz]."""

    def response(self, frequency_hz: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Return speed of the engine side [rad/s] and gauge torque [N m] for a torque of 1 N m on the engine side."""
        s = 2j * np.pi * frequency_hz
        coupling = self.damping_nm_s_rad + self.stiffness_nm_rad / s
        load = self.propeller_kg_m2 * s + self.load_nm_s_rad
        behind = coupling * load / (coupling + load)
        speed = 1.0 / (self.engine_kg_m2 * s + behind)
        return frozen_complex(speed), frozen_complex(speed * behind)


def two_masses(line: TorsionalLine, *, driven: Sequence[str]) -> TwoMasses:
    """Return the two masses that stand for a line up to its first mode, and how well they do.

    The masses are the sums on either side of the gauge, so that slow motion is exact and the spring carries what the
    gauge shows. Stiffness and damping are those that give the first mode's natural frequency and damping ratio:
    ``k = omega_1^2 J_e J_p / (J_e + J_p)`` and, to first order in the damping,
    ``2 zeta omega_1 = c (1 / J_e + 1 / J_p) + d J_e / (J_p (J_e + J_p))``.

    ``driven``: masses on which the engine torque acts, an equal share on each; the speed of the first is the engine
    speed. Raises StructureError if a mass is not there.
    """
    behind = line.is_downstream
    engine = float(np.sum(line.inertia_kg_m2 * (1.0 - behind)))
    propeller = float(np.sum(line.inertia_kg_m2 * behind))
    load = float(np.sum(line.load_nm_s_rad))
    mode = modes(line)
    omega, ratio = 2.0 * np.pi * float(mode.frequency_hz[0]), float(mode.damping_ratio[0])
    pair = 1.0 / engine + 1.0 / propeller
    lost = load * engine / (propeller * (engine + propeller))
    compliance = _compliance(line, line.place(driven[0]), int(np.argmax(line.inertia_kg_m2 * behind)))
    bare = TwoMasses(
        engine_kg_m2=engine,
        propeller_kg_m2=propeller,
        stiffness_nm_rad=omega**2 / pair,
        damping_nm_s_rad=(2.0 * ratio * omega - lost) / pair,
        load_nm_s_rad=load,
        frequency_hz=omega / (2.0 * np.pi),
        frequency_std_hz=float(mode.frequency_std_hz[0]),
        damping_ratio=ratio,
        series_hz=float(np.sqrt(pair / compliance)) / (2.0 * np.pi),
        gauge_error=0.0,
        accurate_to_hz=0.0,
    )
    return _with_errors(bare, line, driven)


def _with_errors(bare: TwoMasses, line: TorsionalLine, driven: Sequence[str]) -> TwoMasses:
    frequency = bare.frequency_hz * np.append(GRID, 1.0)
    exact_line = forced_response(line, frequency, dict.fromkeys(driven, 1.0 / len(driven)))
    exact = np.stack([exact_line.speed_of(driven[0]), exact_line.gauge_torque_nm])
    errors = np.abs(np.stack(bare.response(frequency)) / exact - 1.0)
    wrong = np.flatnonzero(errors[:, :-1].max(axis=0) > ACCURATE)
    right = int(wrong[0]) if wrong.size else GRID.size
    last = frequency[right - 1] if right else 0.0
    return replace(bare, gauge_error=float(errors[1, -1]), accurate_to_hz=float(last))


def _compliance(line: TorsionalLine, first: int, last: int) -> float:
    """Return the sum of the compliances on the way from one body to another [rad/(N m)]."""
    reached = {first: 0.0}
    while last not in reached:
        for link in line.links:
            ends = [body for body in link.between if body in reached]
            if len(ends) == 1:
                other = link.between[0] if link.between[1] == ends[0] else link.between[1]
                bend = 1.0 / link.stiffness_nm_rad if link.stiffness_nm_rad else np.inf
                reached[other] = reached[ends[0]] + bend
    return reached[last]
