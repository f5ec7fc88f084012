"""Noise and smooth response of a record's transform, band by band, before any model is known.

In a band of many lines response and leakage are polynomials of second order, as in the local polynomial method of
``spectra`` (Pintelon and Schoukens, System Identification: A Frequency Domain Approach, second edition, chapter 7)::

    Y(f) = (h0 + h1 x + h2 x^2) U(f) + t0 + t1 x + t2 x^2 + V(f)

What the polynomials leave is noise, whatever structure is right. The response in the middle of each band is what the
search from many starts looks at; the directions in which the input can act within a band are those in which a model
can be wrong.
"""

from dataclasses import dataclass, fields

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray

ORDERS = 3
# Lines of a band, and as many bands as a record should have before its bands get wider than the narrowest.
WIDEST, NARROWEST, WANTED_BANDS = 64, 24, 40
# Noise is the mean over so many bands to either side.
REACH = 1
# No line is taken to be better known than to this share of what is there: data without noise keep a covariance.
ROUNDING = 1e-10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineBands:
    """What bands of lines tell by themselves."""

    places: IntArray
    """Lines of each band, shape (bands, lines of the widest); where a band is shorter its last line again."""
    there: BoolArray
    """Which of them are its own, shape (bands, lines of the widest)."""
    middle: FloatArray
    """Middle of each band, in lines, shape (bands,)."""
    along: ComplexArray
    """Unit vectors that the input spans beside the leakage, shape (bands, lines of the widest, orders)."""
    response: ComplexArray
    """Response in the middle of each band, shape (bands, outputs)."""
    spread: FloatArray
    """Variance of that response for noise of variance 1, shape (bands,)."""
    noise: ComplexArray
    """Covariance ``E[V V^H]`` of the noise of each band, smoothed, shape (bands, outputs, outputs)."""
    samples: FloatArray
    """Complex samples behind each of them, shape (bands,)."""

    @property
    def weight_factor(self) -> FloatArray:
        """Factor that makes an estimated covariance right as a weight, shape (bands,); see ``spectra``."""
        return np.asarray(self.samples / (self.samples - self.noise.shape[-1]))

    def chosen(self, rows: IntArray) -> "LineBands":
        """Return some of the bands."""
        return LineBands(**{part.name: getattr(self, part.name)[rows] for part in fields(self)})

    def at_lines(self, count: int) -> ComplexArray:
        """Return the noise at every line, right as a weight, shape (lines, outputs, outputs)."""
        line = np.arange(count, dtype=np.float64)
        scaled = self.weight_factor[:, None, None] * self.noise
        size = scaled.shape[-1]
        covariance = np.empty((count, size, size), dtype=np.complex128)
        for i in range(size):
            for j in range(size):
                covariance[:, i, j] = np.interp(line, self.middle, scaled[:, i, j].real)
                if i != j:
                    covariance[:, i, j] += 1j * np.interp(line, self.middle, scaled[:, i, j].imag)
        return covariance


def bands_of(source: ComplexArray, outputs: ComplexArray) -> LineBands:
    """Cut lines into bands and fit each by itself.

    ``source``: transform of the input at consecutive lines, shape (lines,), at least ``NARROWEST``. ``outputs``:
    transforms of the outputs, shape (outputs, lines).
    """
    places, there = _cut(source.size)
    half = 0.5 * (there.sum(axis=1) - 1)
    middle = places[:, 0] + half
    x = np.where(there, (places - middle[:, None]) / half[:, None], 0.0)
    powers = x[:, :, None] ** np.arange(ORDERS) * there[:, :, None]
    level = np.sqrt(np.mean(np.abs(source[places]) ** 2, axis=1))[:, None, None]
    # the response in the middle stands last: its element of R alone gives its variance
    columns = np.concatenate([powers, (source[places][:, :, None] / level * powers)[:, :, ::-1]], axis=2)
    basis, upper = np.linalg.qr(columns)
    seen = np.moveaxis(outputs[:, places], 0, 2) * there[:, :, None]
    shares = basis.conj().swapaxes(1, 2) @ seen
    last = upper[:, -1, -1]
    remainder = seen - basis @ shares
    power = np.sum(np.abs(seen) ** 2, axis=1)
    squares = remainder.swapaxes(1, 2) @ remainder.conj() + (ROUNDING**2 * power)[:, :, None] * np.eye(len(outputs))
    samples = (there.sum(axis=1) - 2 * ORDERS).astype(np.float64)
    near = np.abs(np.subtract.outer(np.arange(len(places)), np.arange(len(places)))) <= REACH
    together = near @ samples
    return LineBands(
        places=places,
        there=there,
        middle=middle,
        along=basis[:, :, ORDERS:],
        response=shares[:, -1] / (last * level[:, 0, 0])[:, None],
        spread=1.0 / np.abs(last * level[:, 0, 0]) ** 2,
        noise=np.tensordot(near.astype(np.float64), squares, axes=1) / together[:, None, None],
        samples=together,
    )


def _cut(lines: int) -> tuple[IntArray, BoolArray]:
    """Return the lines of bands as alike in length as possible."""
    width = int(np.clip(lines // WANTED_BANDS, NARROWEST, WIDEST))
    edges = np.linspace(0, lines, max(lines // width, 1) + 1).round().astype(np.int64)
    widest = int(np.diff(edges).max())
    places = edges[:-1, None] + np.arange(widest)
    there = places < edges[1:, None]
    return np.minimum(places, edges[1:, None] - 1), there
