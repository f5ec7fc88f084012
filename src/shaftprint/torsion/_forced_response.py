"""Steady vibration under torques that go up and down with one frequency."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import StructureError
from shaftprint.torsion._line import TorsionalLine


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
