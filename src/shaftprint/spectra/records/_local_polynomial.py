"""The local polynomial method: a response and a transient, both smooth, in a narrow band of a Fourier transform.

In a band around the frequency ``f0``, with ``x = (f - f0) / half width``, the transforms of a record obey::

    Y(f) = (H + h1 x + h2 x^2 + ...) U(f) + t0 + t1 x + t2 x^2 + ... + V(f)

where the second polynomial holds what was moving already at the beginning of the record and still moved at its end,
which leaks into all bins, and ``V`` is the noise. ``H`` follows by least squares, its covariance from what is left
(Pintelon and Schoukens, "System Identification: A Frequency Domain Approach", second edition, chapter 7). Several
records share the response and have each their own transient.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

_SMALLEST_EXCESS = 6
_TRIED = 2
# Rows decomposed at a time. Measured on a million samples: 0.35 s, without blocks 2 s, with 512 rows, whose columns
# collide in the cache, 6 s.
_BLOCK = 200
_ROUNDING = 1e-13
_RIDGE = 1e-10
# A test that fails more often without cause would select bands by their noise: with 1, covariances are 4 % too large.
# What it then misses is 16 times smaller in the halves of the band, in which the response is measured.
_STRICTNESS = 3.0
# Of a column of length 1, what the columns before it leave: less is rounding.
_LEAST_REST = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Transform:
    """The bins of one record."""

    resolution_hz: float
    """Distance between bins [Hz]; the first bin is one such distance above 0."""
    values: ComplexArray
    """Fourier transform over the root of the number of samples, inputs first, shape (channels, bins)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BandFit:
    """The fit in one band."""

    response: ComplexArray
    """Response where it was wanted, shape (outputs, inputs)."""
    inverse: ComplexArray
    """Covariance of the response to each input for noise of variance 1, shape (inputs, inputs)."""
    noise: ComplexArray
    """What is left of the outputs, ``sum e e^H`` over bins, shape (outputs, outputs)."""
    finer: ComplexArray
    """The same after a fit with more orders, shape (outputs, outputs)."""
    power: FloatArray
    """Squared magnitude of the outputs, summed over bins, shape (outputs,)."""
    excess: int
    """Number of bins more than coefficients."""
    known: bool
    """Whether every input moves, apart from the others and from the transients."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bands:
    """Records in which bands can be fitted."""

    transforms: tuple[Transform, ...]
    """The records."""
    inputs: int
    """Number of inputs."""
    order: int
    """Order of the polynomials."""

    @property
    def outputs(self) -> int:
        """Number of outputs."""
        return len(self.transforms[0].values) - self.inputs

    def wide_enough(self, low_hz: float, high_hz: float) -> bool:
        """Return whether a band has enough bins for a fit and for its noise."""
        bins = [stop - start for start, stop in self.in_band(low_hz, high_hz).values()]
        columns = (self.order + 1) * (self.inputs + len(bins))
        return bool(bins) and sum(bins) - columns >= _SMALLEST_EXCESS + self.outputs

    def fit(self, low_hz: float, high_hz: float, *, at_hz: float | None = None, more: int = 0) -> BandFit:
        """Fit a band from ``low_hz`` up to, but without, ``high_hz``.

        ``low_hz``, ``high_hz``: borders of the band [Hz]. ``at_hz``: where the response is wanted [Hz]; in the middle
        when not given. ``more``: number of orders more that are tried after the fit, see ``BandFit.finer``. Returns the
        fit.
        """
        bins = self.in_band(low_hz, high_hz)
        middle = 0.5 * (low_hz + high_hz) if at_hz is None else at_hz
        half = 0.5 * (high_hz - low_hz)
        orders = self.order + more + 1
        total = sum(stop - start for start, stop in bins.values())
        transient = np.zeros((orders, len(bins), total), dtype=np.complex128)
        response = np.empty((orders, self.inputs, total), dtype=np.complex128)
        y = np.empty((self.outputs, total), dtype=np.complex128)
        first = 0
        for run, (record, (start, stop)) in enumerate(bins.items()):
            transform, part = self.transforms[record], slice(first, first + stop - start)
            x = ((np.arange(start, stop) + 1.0) * transform.resolution_hz - middle) / half
            powers = x ** np.arange(orders)[:, np.newaxis]
            transient[:, run, part] = powers
            response[:, :, part] = powers[:, np.newaxis] * transform.values[: self.inputs, start:stop]
            y[:, part] = transform.values[self.inputs :, start:stop]
            first = part.stop
        # the response itself, power 0, stands last of those that count; after it the orders that are only tried
        counted, tried = slice(1, self.order + 1), slice(self.order + 1, None)
        groups = [transient[: self.order + 1], response[counted], response[:1], transient[tried], response[tried]]
        rows = [group.reshape(-1, total) for group in groups]
        count = sum(len(group) for group in rows[:3])
        return _least_squares(np.concatenate(rows).T, y.T, self.inputs, count)

    def in_band(self, low_hz: float, high_hz: float) -> dict[int, tuple[int, int]]:
        """Return the bins of a band in each record that has more than its own transient takes."""
        bins = {}
        for record, transform in enumerate(self.transforms):
            step, count = transform.resolution_hz, transform.values.shape[1]
            start = min(max(int(np.ceil(low_hz / step - 1e-9)) - 1, 0), count)
            stop = min(max(int(np.ceil(high_hz / step - 1e-9)) - 1, start), count)
            if stop - start > self.order + 3:
                bins[record] = (start, stop)
        return bins


def _least_squares(columns: ComplexArray, y: ComplexArray, inputs: int, count: int) -> BandFit:
    """Fit the first so many columns; the last of them are the response's."""
    length = np.sqrt((np.abs(columns) ** 2).sum(axis=0))
    scale = np.where(length == 0.0, 1.0, length)
    # of the triangle, the part beside the columns holds the projections of the outputs, that below what is left of them
    triangle = _triangle(np.concatenate([columns / scale, y], axis=1))
    of_response, projections = slice(count - inputs, count), triangle[:, columns.shape[1] :]
    last, projected = triangle[of_response, of_response], projections[of_response]
    residual, finer = projections[count:], projections[columns.shape[1] :]
    identified = bool(np.all(length[of_response] > 0.0) and np.abs(np.diag(last)).min() > _LEAST_REST)
    inverse = np.zeros((inputs, inputs), dtype=np.complex128)
    if identified:
        inverse[:] = np.linalg.inv(last) / scale[of_response, np.newaxis]
    return BandFit(
        response=(inverse @ projected).T,
        inverse=inverse @ inverse.conj().T,
        noise=residual.T @ residual.conj(),
        finer=finer.T @ finer.conj(),
        power=(np.abs(y) ** 2).sum(axis=0),
        excess=len(y) - count,
        known=identified,
    )


def _triangle(table: ComplexArray) -> ComplexArray:
    """Return the triangle of a QR decomposition; tall tables block by block, which keeps them in the cache."""
    columns = table.shape[1]
    while len(table) >= 2 * _BLOCK > 4 * columns:
        rows = len(table) // _BLOCK * _BLOCK
        triangles = np.asarray(np.linalg.qr(table[:rows].reshape(-1, _BLOCK, columns), mode="r"))
        table = np.concatenate([triangles.reshape(-1, columns), table[rows:]])
    triangle: ComplexArray = np.asarray(np.linalg.qr(table, mode="r"))
    return triangle


def is_smooth(bands: Bands, low_hz: float, high_hz: float) -> bool:
    """Return whether the polynomials of a band suffice: whether two orders more find no more than noise.

    Compares Wilks' statistic of the two fits with its mean and standard deviation under noise alone, in Bartlett's
    approximation for complex values.

    ``bands``: the records. ``low_hz``, ``high_hz``: borders of the band [Hz]. Returns True where the statistic is at
    most three standard deviations above its mean.
    """
    fit = bands.fit(low_hz, high_hz, more=_TRIED)
    records = len(bands.in_band(low_hz, high_hz))
    added = _TRIED * (bands.inputs + records)
    # rounding of the fit: neither noise-free outputs nor such as are multiples of each other have a determinant
    floor = np.diag(fit.power * _ROUNDING**2 + fit.noise.diagonal().real * _RIDGE + np.finfo(np.float64).tiny)
    gain = float(np.linalg.slogdet(fit.noise + floor)[1] - np.linalg.slogdet(fit.finer + floor)[1])
    freedom = 2.0 * bands.outputs * added
    return (2.0 * fit.excess - added - bands.outputs) * gain <= freedom + _STRICTNESS * math.sqrt(2.0 * freedom)


def misfit(bands: Bands, low_hz: float, high_hz: float) -> ComplexArray:
    """Return by how much the polynomials of a narrow band may miss the response in its middle.

    A band that cannot be split cannot be tested either: it has too few bins. Where a band around it, twice as wide, is
    not smooth, the difference to a fit of that one with two orders more stands for what the narrow band misses.

    ``bands``: the records. ``low_hz``, ``high_hz``: borders of the band [Hz]. Returns the difference, 0 where the wide
    band is smooth or has too few bins, shape (outputs, inputs).
    """
    width = high_hz - low_hz
    low = max(low_hz - 0.5 * width, 0.5 * min(transform.resolution_hz for transform in bands.transforms))
    high = low + 2.0 * width
    finer = replace(bands, order=bands.order + _TRIED)
    if not finer.wide_enough(low, high) or is_smooth(bands, low, high):
        return np.zeros((bands.outputs, bands.inputs), dtype=np.complex128)
    wide = finer.fit(low, high, at_hz=0.5 * (low_hz + high_hz))
    return wide.response - bands.fit(low_hz, high_hz).response
