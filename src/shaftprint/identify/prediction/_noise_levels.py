"""How strong the noise under a test line is: spectra of the outputs, from a recording or as stated."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.spectra._frequency_response import FrequencyResponse

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NoiseLevels:
    """One-sided power spectral densities of the outputs' noise, with what one volt of set point asks for.

    A line that lasts ``T`` seconds with the set-point amplitude ``A`` has a response ``H`` whose error has the
    covariance ``E[dH dH^H] = 2 S / (T A^2)``: twice the density over the length is the mean square of a Fourier
    amplitude of the noise (Bendat and Piersol, Random Data, section 5.2).
    """

    frequency_hz: FloatArray
    """Frequencies at which the density is stated [Hz], ascending, shape (frequencies,)."""
    density: ComplexArray
    """Density ``S`` of the outputs over their working-point values [1/Hz], Hermitian, shape (frequencies, outputs,
    outputs)."""
    outputs: tuple[str, ...]
    """Names of the outputs, such as ``("n", "M_s")``."""
    set_point_per_v: float
    """Change of the set point over the working-point speed for one volt [1/V], positive."""
    orders_hz: tuple[float, ...] = ()
    """Where orders of the shaft line stand at the working point [Hz]: they are taken out of the torque, which costs a
    steady sine beside one; the density is without them."""

    def __post_init__(self) -> None:
        """Check the shapes and make the arrays read-only.

        Raises IdentificationError if a shape does not fit, frequencies are not positive and ascending, or a density is
        not positive definite.
        """
        frequency = frozen_float(self.frequency_hz)
        count, size = frequency.size, len(self.outputs)
        if np.shape(self.density) != (count, size, size):
            raise IdentificationError(
                f"noise levels: expected densities of shape {(count, size, size)}, found {np.shape(self.density)}."
            )
        if not count or not np.all(frequency > 0.0) or not np.all(np.diff(frequency) > 0.0):
            raise IdentificationError("noise levels: expected positive, ascending frequencies in Hz.")
        if not self.set_point_per_v > 0.0:
            raise IdentificationError(
                f"noise levels: expected a positive set point for one volt, found {self.set_point_per_v}."
            )
        density = frozen_complex(self.density)
        for hertz, matrix in zip(frequency, density, strict=True):
            if not np.all(np.isfinite(matrix)) or np.linalg.eigvalsh(matrix)[0] <= 0.0:
                raise IdentificationError(
                    f"noise levels at {hertz:g} Hz: expected a Hermitian, positive definite density."
                )
        object.__setattr__(self, "frequency_hz", frequency)
        object.__setattr__(self, "density", density)

    def at(self, frequency_hz: ArrayLike) -> ComplexArray:
        """Return the density at other frequencies, shape (lines, outputs, outputs).

        Straight lines on a log-log plot between the stated frequencies, the outermost levels beyond them.
        """
        wanted, stated = np.log(np.asarray(frequency_hz, dtype=np.float64)), np.log(self.frequency_hz)
        level = np.diagonal(self.density, axis1=1, axis2=2).real
        root = np.exp(0.5 * np.stack([np.interp(wanted, stated, np.log(column)) for column in level.T], axis=1))
        deviation = np.sqrt(level)
        shape = self.density / (deviation[:, :, None] * deviation[:, None, :])
        interpolated = np.empty((wanted.size, *shape.shape[1:]), dtype=np.complex128)
        for i, j in np.ndindex(*shape.shape[1:]):
            interpolated[:, i, j] = np.interp(wanted, stated, shape[:, i, j].real)
            interpolated[:, i, j] += 1j * np.interp(wanted, stated, shape[:, i, j].imag)
        return interpolated * root[:, :, None] * root[:, None, :]

    def times(self, factor: float) -> "NoiseLevels":
        """Return the levels with so many times the density."""
        return replace(self, density=factor * self.density)

    def of_outputs(self, *names: str) -> "NoiseLevels":
        """Return the levels of some of the outputs.

        Raises
        ------
        IdentificationError
            If a name is not an output.
        """
        unknown = [name for name in names if name not in self.outputs]
        if unknown or not names:
            raise IdentificationError(
                f"noise levels: expected outputs of {', '.join(self.outputs)}, found {', '.join(unknown) or 'none'}."
            )
        places = [self.outputs.index(name) for name in names]
        return replace(self, outputs=names, density=self.density[np.ix_(range(self.frequency_hz.size), places, places)])


def noise_levels(
    response: FrequencyResponse,
    campaign: "Campaign",
    *,
    set_point_per_v: float,
    orders_hz: Sequence[float] = (),
    as_weights: bool = False,
) -> NoiseLevels:
    """Return the noise levels behind a measured response: its covariance times length and squared amplitude of lines.

    Parameters
    ----------
    response
        What was measured, from one input, at the lines of the campaign that it marks as used.
    campaign
        The campaign that was sailed.
    set_point_per_v
        Change of the set point over the working-point speed for one volt [1/V].
    orders_hz
        Where orders of the shaft line stand at the working point [Hz].
    as_weights
        Whether to keep the factor by which a covariance of few samples is enlarged: for lines that are estimated from
        as few samples again, where what is planned does not count that cost, as it does for legs.

    Raises
    ------
    IdentificationError
        If the response has several inputs or no used line, or a line is not in the campaign.
    """
    if len(response.inputs) != 1 or not response.used.any():
        raise IdentificationError(
            f"noise levels: expected a response from one input with used lines, found {len(response.inputs)} inputs "
            f"and {int(response.used.sum())} used lines."
        )
    tested = _tested_lines(campaign)
    places = np.flatnonzero(response.used)
    unknown = [response.lines[index] for index in places if response.lines[index] not in tested]
    if unknown:
        raise IdentificationError(
            f"noise levels: campaign {campaign.name} has no line {', '.join(unknown)}; give the campaign that the "
            "recording was made with."
        )
    size = len(response.outputs)
    enlarged = np.ones(len(response.lines)) if as_weights else response.weight_factors
    density = np.empty((places.size, size, size), dtype=np.complex128)
    for row, index in enumerate(places):
        amplitude_v, seconds = tested[response.lines[index]]
        amplitude = set_point_per_v * amplitude_v
        # as a weight a covariance of few samples is larger than that of the errors
        spread = response.covariance[index] / enlarged[index]
        same = spread[:size, :size] + spread[size:, size:]
        crossed = spread[size:, :size] - spread[:size, size:]
        density[row] = (same + 1j * crossed) * (0.5 * seconds * amplitude**2)
    return NoiseLevels(
        frequency_hz=response.frequency_hz[places],
        density=density,
        outputs=response.outputs,
        set_point_per_v=set_point_per_v,
        orders_hz=tuple(orders_hz),
    )


def _tested_lines(campaign: "Campaign") -> dict[str, tuple[float, float]]:
    """Return amplitude [V] and length [s] of every line of a campaign by its name."""
    sines = {sine.name: (sine.amplitude_v, sine.window_s) for sine in campaign.sines}
    of_legs = {
        f"{one.name}/{harmonic}": (amplitude_v, one.window_s)
        for leg in campaign.legs
        for one in (leg, *campaign.beside(leg))
        for harmonic, amplitude_v in one.lines.items()
    }
    return sines | of_legs


def stated_noise(
    frequency_hz: Sequence[float],
    densities: Sequence[Sequence[float]],
    coherences: Sequence[complex] | Sequence[Sequence[complex]],
    *,
    set_point_per_v: float,
    orders_hz: Sequence[float] = (),
    outputs: Sequence[str] = ("n", "M_s"),
) -> NoiseLevels:
    """Return the noise levels of speed, torque and further outputs from a table.

    ``frequency_hz``: frequencies [Hz], shape (frequencies,). ``densities``: densities of the outputs [1/Hz], shape
    (frequencies, outputs). ``coherences``: complex coherence of every pair of outputs, below 1 in magnitude: of the
    first with each later one, then of the second, shape (frequencies, pairs), or (frequencies,) where there is one
    pair. ``set_point_per_v``: change of the set point over the working-point speed for one volt [1/V]. ``orders_hz``:
    where orders of the shaft line stand at the working point [Hz]. ``outputs``: names of the outputs. Raises
    IdentificationError if the table makes no sense.
    """
    deviation = np.sqrt(np.asarray(densities, dtype=np.float64))
    shape = np.tile(np.eye(len(outputs), dtype=np.complex128), (len(frequency_hz), 1, 1))
    pairs = np.asarray(coherences, dtype=np.complex128).reshape(len(frequency_hz), -1)
    for (i, j), coherence in zip(combinations(range(len(outputs)), 2), pairs.T, strict=True):
        shape[:, i, j], shape[:, j, i] = coherence, np.conj(coherence)
    return NoiseLevels(
        frequency_hz=np.asarray(frequency_hz, dtype=np.float64),
        density=shape * deviation[:, :, None] * deviation[:, None, :],
        outputs=tuple(outputs),
        set_point_per_v=set_point_per_v,
        orders_hz=tuple(orders_hz),
    )
