"""Motion of a line in time, exact between the samples."""

import importlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import StructureError
from shaftprint.torsion._line import TorsionalLine
from shaftprint.torsion._modes import state_space

NO_IMPULSE: Mapping[str, float] = {}
# Largest difference between two steps of a uniform grid, as a share of the step: rounding of sums of steps.
UNEVEN = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineTrace:
    """Deviations from the steady state in time."""

    line: TorsionalLine
    """The line."""
    time_s: FloatArray
    """Time [s], shape (samples,)."""
    speed_rad_s: FloatArray
    """Speed of each body [rad/s], shape (bodies, samples)."""
    link_torque_nm: FloatArray
    """Torque of each link [N m], shape (links, samples)."""

    @property
    def gauge_torque_nm(self) -> FloatArray:
        """Torque at the gauge [N m], shape (samples,)."""
        return frozen_float(self.link_torque_nm[self.line.gauge_link])

    def speed_of(self, mass: str) -> FloatArray:
        """Return the speed of a mass [rad/s], shape (samples,).

        Raises
        ------
        StructureError
            If there is no such mass.
        """
        return frozen_float(self.speed_rad_s[self.line.place(mass)])


def simulate_line(
    line: TorsionalLine,
    time_s: ArrayLike,
    torque_nm: Mapping[str, ArrayLike],
    *,
    damping_at_hz: float,
    impulse_nm_s: Mapping[str, float] = NO_IMPULSE,
) -> LineTrace:
    """Return the motion from rest under torques that are linear between the samples.

    The step is exact: ``x(t + h) = exp(A h) x(t) + ...`` with the integrals of a ramp from one matrix exponential (Van
    Loan, Computing integrals involving the matrix exponential, 1978).

    Parameters
    ----------
    time_s
        Uniform grid [s], shape (samples,).
    torque_nm
        Torque [N m] by the name of a mass, shape (samples,).
    damping_at_hz
        Frequency [Hz] at which viscous dampings stand for the losses of the links: in time a loss that does not change
        with frequency would act before its cause.
    impulse_nm_s
        Impulse [N m s] at the first sample, by the name of a mass; it changes the speed at once.

    Raises
    ------
    StructureError
        If a mass is not there, the grid is not uniform, the frequency is not above 0, or a torque does not fit.
    """
    time = np.asarray(time_s, dtype=np.float64)
    step = _step_of(time)
    if not damping_at_hz > 0.0:
        raise StructureError(f"damping_at_hz = {damping_at_hz:g}: expected a frequency above 0 Hz.")
    system = state_space(line, line.viscous_nm_s_rad(2.0 * np.pi * damping_at_hz))
    torque = np.zeros((time.size, len(line.bodies)))
    for mass, values in torque_nm.items():
        samples = np.asarray(values, dtype=np.float64)
        if samples.shape != time.shape:
            raise StructureError(f"torque on {mass}: expected {time.size} samples, found an array of {samples.shape}.")
        torque[:, line.place(mass)] += samples
    start = np.zeros(len(line.bodies))
    for mass, size in impulse_nm_s.items():
        start[line.place(mass)] += size
    states = _march(system.matrix, system.input, torque, step, system.input @ start)
    return LineTrace(
        line=line,
        time_s=frozen_float(time),
        speed_rad_s=frozen_float(states[:, system.springs :].T),
        link_torque_nm=frozen_float(system.link_torque @ states.T),
    )


def _step_of(time: FloatArray) -> float:
    if time.ndim != 1 or time.size < 2:
        raise StructureError(f"time_s: expected two or more samples in one row, found an array of shape {time.shape}.")
    step = (time[-1] - time[0]) / (time.size - 1)
    if not step > 0.0 or np.max(np.abs(np.diff(time) - step)) > UNEVEN * step:
        raise StructureError("time_s: expected ascending times of equal distance; resample the torque to such a grid.")
    return float(step)


def _march(matrix: FloatArray, gain: FloatArray, torque: FloatArray, step: float, start: FloatArray) -> FloatArray:
    """Return the states at all samples, shape (samples, states)."""
    states, inputs = gain.shape
    augmented = np.zeros((states + 2 * inputs, states + 2 * inputs))
    augmented[:states, :states] = matrix * step
    augmented[:states, states : states + inputs] = gain * step
    augmented[states : states + inputs, states + inputs :] = np.eye(inputs)
    # loaded where it is used: what knows a coupling beforehand, the fits, needs NumPy only
    onward: FloatArray = importlib.import_module("scipy.linalg").expm(augmented)
    level, ramp = onward[:states, states : states + inputs], onward[:states, states + inputs :]
    pushed = torque[:-1] @ level.T + np.diff(torque, axis=0) @ ramp.T
    states_in_time = np.empty((torque.shape[0], states))
    states_in_time[0] = start
    transition = onward[:states, :states]
    for sample, push in enumerate(pushed):
        states_in_time[sample + 1] = transition @ states_in_time[sample] + push
    return states_in_time
