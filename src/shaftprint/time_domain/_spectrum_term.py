"""Excited lines of a record as a part of the likelihood, with the leakage of a motion that was cut.

At each line ``Y = G U + sum_j c_j F_j + V``: what the input does, free responses of the structure whose sizes tell in
which state the record begins and ends (``models.free_responses``), and noise. Weighted by the noise, residuals are
linear in the sizes, which are eliminated for every set of parameters (Golub and Pereyra, The differentiation of
pseudo-inverses and nonlinear least squares problems whose variables separate, 1973). Of the derivatives all that the
free responses can follow is projected out (Kaufman, A variable projection method for solving separable nonlinear least
squares problems, 1975): the slope of the cost stays exact, and the products of the derivatives are the information that
is left where the sizes are unknown.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._term import FittedTerm, Repeats, Term, TermTest
from shaftprint.identify.likelihood._term_check import TermCheck
from shaftprint.models._structure import Structure
from shaftprint.time_domain._bands import ORDERS
from shaftprint.time_domain._nodes import Nodes
from shaftprint.time_domain._spectrum import Spectrum

# Sizes are told apart until one shape is the others' but for this share, as the root of it.
RIDGE = 1e-12
TINY = 1e-300


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpectrumRepeats(Repeats):
    """Transforms of the outputs of repeats of a record, each at rest at begin and end."""

    outputs: ComplexArray
    """Shape (repeats, outputs, lines)."""

    def chosen(self, repeats: IntArray | slice) -> "SpectrumRepeats":
        """Return some of the repeats."""
        return SpectrumRepeats(outputs=self.outputs[repeats])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FittedSpectrum(FittedTerm):
    """How well a record is explained through its transform."""

    structure: Structure
    """The structure, with its held and free parameters."""
    spectrum: Spectrum
    """The data."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output over time (thesis eq. 2.41), of the sampled record without its mean."""
    fit_ceiling: Mapping[str, float]
    """FitPercent that the noise allows, of each output."""
    residuals: ComplexArray
    """What the model leaves at each line, over the noise: of unit variance, shape (outputs, lines)."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"lines of record {self.spectrum.record.name}"

    @property
    def seconds(self) -> float:
        """Length of the used samples [s]."""
        return int(self.spectrum.record.used.sum()) / self.spectrum.record.rate_hz

    @property
    def checks(self) -> tuple[TermCheck, ...]:
        """Nothing: each band of lines is tested on its own."""
        return ()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpectrumTerm(Term):
    """A structure and the excited lines of a record to fit it to."""

    spectrum: Spectrum
    """The data."""
    shapes: Structure | None
    """Free responses of the structure; None where the record is taken to begin and end in one state."""
    channels: tuple[int, ...]
    """Output that each of them belongs to."""
    s: ComplexArray
    """Laplace variable of the lines [rad/s], shape (lines,)."""
    nodes: Nodes
    """Where the free responses are evaluated."""
    weights: ComplexArray
    """``W`` with ``W^H W`` twice the inverse of the noise, shape (outputs, outputs, lines): real parts count one."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"lines of record {self.spectrum.record.name}"

    @property
    def data_count(self) -> int:
        """Number of real data beside those that tell the state at begin and end."""
        return 2 * self.spectrum.outputs.size - len(self.channels)

    @property
    def row_count(self) -> int:
        """Number of rows of ``sensitivity``: a real and an imaginary part of every line."""
        return 2 * self.spectrum.outputs.size

    @property
    def is_likelihood(self) -> bool:
        """Whether the residuals are weighted by their noise."""
        return True

    @property
    def least_deviation(self) -> float:
        """Smallest standard deviation of an output in a band of lines, as a share of what is there."""
        there = np.mean(np.abs(self.spectrum.outputs) ** 2, axis=1)
        noise = np.mean(np.diagonal(self.spectrum.noise, axis1=1, axis2=2).real, axis=0)
        return float(np.sqrt(np.min(noise / np.maximum(there, TINY))))

    @property
    def null_cost(self) -> float:
        """Half the square sum of the weighted lines."""
        return 0.5 * float(np.sum(np.abs(self._weighted(self.spectrum.outputs)) ** 2))

    def with_floor(self, floor: float) -> "SpectrumTerm":
        """Return the term with a share of each line's value added to the noise."""
        spectrum = self.spectrum
        least = floor**2 * np.abs(spectrum.outputs.T) ** 2
        noise = spectrum.noise + least[:, :, None] * np.eye(least.shape[1])
        return replace(self, spectrum=replace(spectrum, noise=noise), weights=weights_of(noise))

    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return weighted residuals and below them their derivatives, both without what free responses can follow."""
        table = np.empty((theta.shape[0], 1 + theta.shape[1], 2 * self.spectrum.outputs.size))
        for row, values in enumerate(self.complete(theta)):
            outputs = repeats.outputs[row] if isinstance(repeats, SpectrumRepeats) else self.spectrum.outputs
            table[row] = self._projected(values, outputs)[0]
        return table

    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return true: a frequency response is finite for all parameters."""
        return np.ones(theta.shape[0], dtype=np.bool_)

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the weighted derivatives of what the input does, without what free responses can follow, twice.

        What the free responses tell of the parameters is left out. Their sizes are fitted to the noise where there is
        little motion at begin and end, and the derivatives of such sizes look like knowledge: in a loop whose two
        delays the data did not tell apart, their deviation came out at 0.016 s instead of far above 0.1 s.
        """
        values = self.complete(theta)
        slopes = self.structure.gradient(values, self.s)[1] * self.spectrum.source
        rows = _real(self._weighted(-slopes))
        if self.shapes is not None:
            across, _, gram = self._across(self.nodes.at_lines(self.shapes.response(values, self.nodes.s)))
            rows -= np.linalg.solve(gram, across @ rows.T).T @ across
        return rows, rows

    def assessed(self, values: FloatArray, number: int) -> tuple[FittedSpectrum, TermTest]:
        """Return FitPercent over time, and how much of the input is left in the residuals of each band."""
        spectrum = self.spectrum
        table, residuals = self._projected(self.structure_values(values), spectrum.outputs)
        whitened = _complex(table[0]).reshape(spectrum.outputs.shape) / np.sqrt(2.0)
        inside = 2.0 * np.sum(np.abs(residuals) ** 2, axis=1)
        noise = 2.0 * np.sum(np.diagonal(spectrum.noise, axis1=1, axis2=2).real, axis=0)
        motion = np.sqrt(spectrum.outside + 2.0 * np.sum(np.abs(spectrum.outputs) ** 2, axis=1))
        fitted = FittedSpectrum(
            structure=self.structure,
            spectrum=spectrum,
            fit_percent=_percents(spectrum.names, np.sqrt(inside + spectrum.outside) / motion),
            fit_ceiling=_percents(spectrum.names, np.sqrt(noise + spectrum.outside) / motion),
            residuals=whitened,
        )
        return fitted, self._tested(whitened, number)

    def redrawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> SpectrumRepeats:
        """Return lines of repeats from rest to rest, with noise of the covariance that was found."""
        spectrum = self.spectrum
        roots = np.linalg.cholesky(spectrum.noise)
        parts = rng.standard_normal((2, count, *spectrum.outputs.T.shape)) / np.sqrt(2.0)
        noise = np.einsum("lab,klb->kal", roots, parts[0] + 1j * parts[1])
        return SpectrumRepeats(
            outputs=self.structure.response(self.structure_values(values), self.s) * spectrum.source + noise
        )

    def _projected(self, values: FloatArray, outputs: ComplexArray) -> tuple[FloatArray, ComplexArray]:
        """Return the table of one set of parameters, (1 + free, rows), and the residuals without weights."""
        stacked = -self.structure.stacked(values, self.s) * self.spectrum.source
        stacked[0] += outputs
        if self.shapes is None:
            return _real(self._weighted(stacked)), stacked[0]
        shapes = self.shapes.stacked(values, self.nodes.s)
        across, length, gram = self._across(self.nodes.at_lines(shapes[0]))
        sizes = np.linalg.solve(gram, across @ _real(self._weighted(stacked[:1]))[0]) / length
        for channel in set(self.channels):
            columns = [j for j, c in enumerate(self.channels) if c == channel]
            stacked[:, channel] -= self.nodes.at_lines(np.einsum("j,kjl->kl", sizes[columns], shapes[:, columns]))
        table = _real(self._weighted(stacked))
        table[1:] -= np.linalg.solve(gram, across @ table[1:].T).T @ across
        return table, stacked[0]

    def _across(self, shapes: ComplexArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return weighted free responses of length 1, shape (shapes, rows), their lengths, and their products."""
        weighted = _real(np.stack([self.weights[:, c] * shapes[j] for j, c in enumerate(self.channels)]))
        length = np.maximum(np.linalg.norm(weighted, axis=1), TINY)
        weighted /= length[:, None]
        return weighted, length, weighted @ weighted.T + RIDGE * np.eye(len(weighted))

    def _weighted(self, lines: ComplexArray) -> ComplexArray:
        """Return ``W`` times lines of shape (..., outputs, lines)."""
        weighted = np.empty_like(lines)
        for i in range(lines.shape[-2]):
            weighted[..., i, :] = sum(self.weights[i, j] * lines[..., j, :] for j in range(i + 1))
        return weighted

    def _tested(self, whitened: ComplexArray, number: int) -> TermTest:
        """Return the squared distances of the bands from the model, in the directions in which the input acts."""
        bands, size = self.spectrum.bands, len(whitened)
        inside = np.where(bands.there, whitened[:, bands.places], 0.0)
        shares = np.einsum("bmo,abm->abo", bands.along.conj(), inside)
        squares = 2.0 * np.sum(np.abs(shares) ** 2, axis=(0, 2))
        count = 2 * ORDERS * size
        excess = 2.0 * (bands.samples - size)
        step = (self.spectrum.frequency_hz[1] - self.spectrum.frequency_hz[0]) * bands.middle
        names = [f"{f:.3g} Hz" for f in (self.spectrum.frequency_hz[0] + step).tolist()]
        # the mean is that of the count by the factor in the weights; the variance that of a scaled F variable
        return TermTest(
            chi_square=float(squares.sum()),
            count=count * squares.size,
            mean=float(count * squares.size),
            variance=float(np.sum(2.0 * count * (1.0 + (count + 2.0) / np.maximum(excess - 2.0, 1.0)))),
            lines=tuple(
                LineTest(experiment=number, name=name, distance=distance, data_count=count, excess=k)
                for name, distance, k in zip(names, squares.tolist(), excess.tolist(), strict=True)
            ),
        )


def weights_of(noise: ComplexArray) -> ComplexArray:
    """Return ``W`` of every line, shape (outputs, outputs, lines), from covariances (lines, outputs, outputs)."""
    roots = np.linalg.inv(np.linalg.cholesky(noise))
    return np.ascontiguousarray(np.sqrt(2.0) * np.moveaxis(roots, 0, 2))


def _real(lines: ComplexArray) -> FloatArray:
    """Return real and imaginary parts of lines (rows, outputs, lines) as rows of numbers."""
    return np.ascontiguousarray(lines).reshape(len(lines), -1).view(np.float64)


def _complex(numbers: FloatArray) -> ComplexArray:
    return np.ascontiguousarray(numbers).view(np.complex128)


def _percents(names: Sequence[str], shares: FloatArray) -> dict[str, float]:
    return {name: 100.0 * (1.0 - share) for name, share in zip(names, shares.tolist(), strict=True)}
