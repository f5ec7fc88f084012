"""What a staircase of the set point asks for, over frequency: steps that do not overshoot by themselves."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float

# Rate at which steps are seen [Hz]: what governor and engine do to them is far slower.
_RATE_HZ = 64.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StairsSpectrum:
    """A staircase and as long a rest after it, over frequency."""

    lines: ComplexArray
    """Its spectrum, in the unit of the levels, shape (frequencies,)."""
    omega_rad_s: FloatArray
    """Angular frequencies, ascending [rad/s], shape (frequencies,)."""
    samples: int
    """Samples of the staircase alone."""
    duration_s: float
    """Its length without the rest [s]."""

    def in_time(self, responses: ComplexArray) -> FloatArray:
        """Return what responses make of it, with the rest, shape (..., 2 * samples); frequencies last."""
        return np.asarray(np.fft.irfft(responses * self.lines, n=2 * self.samples, axis=-1))


def stairs_spectrum(levels: FloatArray, dwell_s: float) -> StairsSpectrum:
    """Return a staircase over frequency. ``levels``: its levels, in any unit. ``dwell_s``: time on each [s]."""
    steps = np.repeat(levels, round(_RATE_HZ * dwell_s))
    hertz = np.fft.rfftfreq(2 * steps.size, 1.0 / _RATE_HZ)
    # smoothed by the Lanczos factor, so that a step of limited band does not overshoot by itself
    lines = np.fft.rfft(steps, n=2 * steps.size) * np.sinc(2.0 * hertz / _RATE_HZ)
    omega = 2.0 * np.pi * hertz
    # an integrator has no value at zero, its loop has
    omega[0] = 1e-3 * omega[1]
    return StairsSpectrum(
        lines=frozen_complex(lines),
        omega_rad_s=frozen_float(omega),
        samples=steps.size,
        duration_s=steps.size / _RATE_HZ,
    )
