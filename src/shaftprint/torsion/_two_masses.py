"""Two masses in place of the whole line, for identification."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import StructureError
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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineResponse:
    """Complex amplitudes at each frequency."""

    line: TorsionalLine
    """The line."""
    frequency_hz: FloatArray
    """Frequencies [Hz], shape (frequencies,)."""
    speed_rad_s: ComplexArray
    """Speed of each body [rad/s], shape (bodies, frequencies)."""
    link_torque_nm: ComplexArray
    """Torque of each link [N m], shape (links, frequencies)."""

    @property
    def gauge_torque_nm(self) -> ComplexArray:
        """Torque at the gauge [N m], shape (frequencies,)."""
        return frozen_complex(self.link_torque_nm[self.line.gauge_link])

    def speed_of(self, mass: str) -> ComplexArray:
        """Return the speed of a mass [rad/s], shape (frequencies,).

        Raises StructureError if there is no such mass.
        """
        return frozen_complex(self.speed_rad_s[self.line.place(mass)])


def forced_response(line: TorsionalLine, frequency_hz: ArrayLike, torque_nm: Mapping[str, ArrayLike]) -> LineResponse:
    """Return the steady response to torques on the masses.

    ``(-omega^2 J + j omega (D^T c D + d) + D^T k (1 + j psi / (2 pi)) D) theta = T``: the loss of the links is in the
    complex stiffness itself, exact at every frequency.

    ``frequency_hz``: frequencies [Hz] above 0, shape (frequencies,). ``torque_nm``: complex amplitude [N m] by the name
    of a mass: one number, or one for each frequency. Raises StructureError if a mass is not there, or a frequency is
    not above 0.
    """
    frequency = np.atleast_1d(np.asarray(frequency_hz, dtype=np.float64))
    if not np.all(frequency > 0.0):
        raise StructureError(
            f"forced response: expected frequencies above 0 Hz, found {np.min(frequency):g}; a constant torque has no "
            "steady angle."
        )
    torque = np.zeros((frequency.size, len(line.bodies)), dtype=np.complex128)
    for mass, amplitude in torque_nm.items():
        torque[:, line.place(mass)] += np.asarray(amplitude)
    s = 2j * np.pi * frequency[:, None]
    loss = np.array([link.relative_damping for link in line.links]) / (2.0 * np.pi)
    viscous = np.array([link.damping_nm_s_rad for link in line.links])
    dynamic = line.stiffness_nm_rad * (1.0 + 1j * loss) + s * viscous
    incidence = line.incidence
    matrix = np.einsum("la,fl,lb->fab", incidence, dynamic, incidence)
    diagonal = s**2 * line.inertia_kg_m2 + s * line.load_nm_s_rad
    matrix[:, range(diagonal.shape[1]), range(diagonal.shape[1])] += diagonal
    angle = np.linalg.solve(matrix, torque[:, :, None])[:, :, 0]
    return LineResponse(
        line=line,
        frequency_hz=frozen_float(frequency),
        speed_rad_s=frozen_complex((s * angle).T),
        link_torque_nm=frozen_complex((dynamic * (angle @ incidence.T)).T),
    )
