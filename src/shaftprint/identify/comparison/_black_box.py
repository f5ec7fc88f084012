"""What the data say without physics: a rational model with a delay, as flexible as the noise allows, and its band.

Poles and delay are shared by all outputs, and each output is linear in what remains (variable projection: G. H. Golub
and V. Pereyra, SIAM Journal on Numerical Analysis 10, 1973). The order is the lowest that explains the data.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import NORMAL_95, chi_square_tail
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._fitted_response import FittedResponse
from shaftprint.identify.uncertainty._band import DECIBEL_PER_NEPER
from shaftprint.late import late
from shaftprint.notebook._shown import Shown
from shaftprint.spectra._frequency_response import FrequencyResponse

with late():
    # most verdicts need none of it
    from scipy.optimize import least_squares

MOST_SECTIONS = 4
GRID_POINTS = 121
EXPLAINS, ENOUGH = 0.01, 0.05
"""From the first p-value on a model explains the data, from the second on no larger one is tried."""
_LONGEST_DELAY_S = 2.0
_STEP = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class BlackBox(Shown):
    """A flexible linear model of one measured response, beside the structure that was fitted to it."""

    name: str
    """What was measured: a leg, or the response."""
    structure: str
    """Name of the structure beside it."""
    response: FrequencyResponse
    """The lines that both were fitted to."""
    order: int
    """Number of poles."""
    delay_s: float
    """Delay of all outputs [s]."""
    chi_square: float
    """Sum of the squared residuals over their covariance."""
    degrees_of_freedom: int
    """Data less parameters."""
    frequency_hz: FloatArray
    """Where the model is given, the band of the lines [Hz], shape (frequencies,)."""
    model: ComplexArray
    """The model there, shape (outputs, frequencies)."""
    magnitude_std: FloatArray
    """Standard deviation of the natural logarithm of its magnitude, shape (outputs, frequencies)."""
    phase_std: FloatArray
    """Standard deviation of its phase [rad], shape (outputs, frequencies)."""
    at_lines: ComplexArray
    """The model at the lines, shape (outputs, lines)."""
    structure_at_lines: ComplexArray
    """The structure there, shape (outputs, lines)."""
    whitened: FloatArray
    """Residuals over their covariance, independent with a deviation of 1, shape (lines, 2 outputs)."""
    structure_whitened: FloatArray
    """Those of the structure."""

    @property
    def p_value(self) -> float:
        """Probability that noise alone leaves as much or more."""
        return chi_square_tail(self.chi_square, self.degrees_of_freedom)

    @property
    def furthest(self) -> tuple[str, float, float, float]:
        """Where both differ most: output, frequency [Hz], how much the structure is higher [dB] and ahead [deg]."""
        ratio = np.log(self.structure_at_lines / self.at_lines)
        output, line = np.unravel_index(int(np.argmax(np.abs(ratio))), ratio.shape)
        decibels, degrees = DECIBEL_PER_NEPER * float(ratio[output, line].real), np.degrees(ratio[output, line].imag)
        return self.response.outputs[output], float(self.response.frequency_hz[line]), float(decibels), float(degrees)

    @property
    def record(self) -> dict[str, object]:
        """What is kept of it: numbers, model and band by frequency, correlations of residuals."""
        labels = ("of", "lines_apart", "structure", "model", "bound_95")
        return {
            "name": self.name,
            "structure": self.structure,
            "order": self.order,
            "delay_s": self.delay_s,
            "chi_square": self.chi_square,
            "degrees_of_freedom": self.degrees_of_freedom,
            "p_value": self.p_value,
            "outputs": list(self.response.outputs),
            "frequency_hz": self.frequency_hz.tolist(),
            "magnitude": np.abs(self.model).tolist(),
            "magnitude_std_fraction": self.magnitude_std.tolist(),
            "phase_deg": np.degrees(np.unwrap(np.angle(self.model))).tolist(),
            "phase_std_deg": np.degrees(self.phase_std).tolist(),
            "correlations": [dict(zip(labels, row, strict=True)) for row in self.correlations()],
        }

    def correlations(self, lags: int = 3) -> list[tuple[str, int, float, float, float]]:
        """Return how residuals of neighbouring lines go together, of each output and of two with each other.

        Each: of what, how many lines apart, of the structure, of the model, and the bound within which 95 % lie where
        a model holds.
        """
        told = []
        names = self.response.outputs
        lines = self.whitened.shape[0]
        for first in range(len(names)):
            for second in range(first, len(names)):
                label = names[first] if first == second else f"{names[first]} with {names[second]}"
                for lag in range(1 if first == second else 0, min(lags, lines // 4) + 1):
                    values = [_correlation(one, first, second, lag) for one in (self.structure_whitened, self.whitened)]
                    told.append((label, lag, values[0], values[1], NORMAL_95 / math.sqrt(2.0 * (lines - lag))))
        return told


def black_boxes(fit: Identification, legs: Sequence[str]) -> tuple[BlackBox, ...]:
    """Return a flexible model of each response of a fit; ``legs``: names of these, where it is of legs."""
    parts = fit.experiments
    found = (black_box(name, part) for name, part in zip(_names(parts, legs), parts, strict=True))
    return tuple(one for one in found if one is not None)


def _names(parts: Sequence[FittedResponse], legs: Sequence[str]) -> Sequence[str]:
    """Return what each response is called, each name once: pictures of them are told apart by it."""
    if len(legs) == len(parts):
        return legs
    if len(parts) == 1:
        return [parts[0].name]
    return [f"{part.name} from {', '.join(part.response.inputs)} ({at})" for at, part in enumerate(parts, start=1)]


def black_box(name: str, part: FittedResponse) -> BlackBox | None:
    """Return the flexible model of a response that a structure was fitted to; None where it has too few lines for one.

    ``name``: what was measured. ``part``: the response with the residuals of its structure; of one input.
    """
    response, lines = part.response, np.flatnonzero(part.fitted)
    outputs = len(response.outputs)
    if len(response.inputs) != 1:
        return None
    omega = 2.0 * np.pi * response.frequency_hz[lines]
    measured = response.response[:, 0, lines]
    roots = np.linalg.cholesky(response.covariance[lines])
    data = _stacked(measured.T)
    inverses = np.linalg.inv(roots)
    fit, freedom = None, 0
    for sections in range(1, MOST_SECTIONS + 1):
        count = 2 * sections + 1 + outputs * (2 * sections + 1)
        # half of the data at most: what is left has to show whether it explains them
        if 2 * count > data.size:
            break
        fit, freedom = _fitted(sections, omega, data, inverses), data.size - count
        if chi_square_tail(fit.cost_2, freedom) >= ENOUGH:
            break
    if fit is None:
        return None
    grid = np.geomspace(omega.min(), omega.max(), GRID_POINTS)
    model, slopes = fit.with_slopes(grid)
    at_lines, along = fit.with_slopes(omega)
    table = np.einsum("lij,ljp->lip", inverses, _stacked(along.transpose(1, 2, 0))).reshape(data.size, -1)
    # what it leaves beyond the noise widens the band
    covariance = np.linalg.pinv(table.T @ table) * max(1.0, fit.cost_2 / freedom)
    relative = slopes / model.T[None]
    variances = [np.einsum("pfo,pq,qfo->of", each, covariance, each) for each in (relative.real, relative.imag)]
    structure = measured.T - _complex(np.einsum("lij,lj->li", roots, part.whitened))
    return BlackBox(
        name=name,
        structure=part.structure.name,
        response=response.of_lines(*(response.lines[line] for line in lines)),
        order=2 * fit.sections,
        delay_s=float(fit.shape[-1]),
        chi_square=fit.cost_2,
        degrees_of_freedom=freedom,
        frequency_hz=grid / (2.0 * np.pi),
        model=model,
        magnitude_std=np.sqrt(variances[0]),
        phase_std=np.sqrt(variances[1]),
        at_lines=at_lines,
        structure_at_lines=structure.T,
        whitened=fit.left.reshape(data.shape),
        structure_whitened=part.whitened,
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Fit:
    """Poles, delay and what is linear beside them, at their best."""

    sections: int
    shape: FloatArray
    """Logarithms of damping and stiffness of each section, and the delay [s]."""
    weights: FloatArray
    """What is linear, shape (outputs, columns)."""
    left: FloatArray
    """Whitened residuals."""

    @property
    def cost_2(self) -> float:
        return float(self.left @ self.left)

    def with_slopes(self, omega: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Return the model, shape (outputs, frequencies), and its slopes, shape (numbers, frequencies, outputs)."""
        columns = _columns(self.shape, omega)
        model = columns @ self.weights.T
        slopes = []
        for place in range(self.shape.size):
            moved = self.shape.copy()
            moved[place] += _STEP
            slopes.append((_columns(moved, omega) @ self.weights.T - model) / _STEP)
        outputs = self.weights.shape[0]
        slopes += [column[:, None] * row for row in np.eye(outputs) for column in columns.T]
        return model.T, np.array(slopes)


def _fitted(sections: int, omega: FloatArray, data: FloatArray, inverses: FloatArray) -> _Fit:
    centre = np.geomspace(omega.min(), omega.max(), sections + 2)[1:-1]
    # sections of ordinary damping, spread over the band
    begin = np.concatenate([np.log(centre), 2.0 * np.log(centre), [0.05]])
    widest = math.log(30.0)
    low = np.concatenate(
        [
            np.full(sections, math.log(omega.min()) - 2 * widest),
            np.full(sections, 2 * (math.log(omega.min()) - widest)),
            [0.0],
        ]
    )
    high = np.concatenate(
        [
            np.full(sections, math.log(omega.max()) + widest),
            np.full(sections, 2 * (math.log(omega.max()) + widest)),
            [_LONGEST_DELAY_S],
        ]
    )
    given = {"omega": omega, "data": data, "inverses": inverses}

    def residuals(shape: FloatArray) -> FloatArray:
        return _projected(shape, **given)[1]

    found = least_squares(residuals, begin, bounds=(low, high), x_scale="jac", max_nfev=200)
    weights, left = _projected(found.x, **given)
    return _Fit(sections=sections, shape=found.x, weights=weights, left=left)


def _projected(
    shape: FloatArray, *, omega: FloatArray, data: FloatArray, inverses: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the best linear part for given poles and delay, and the whitened residuals."""
    columns, outputs = _columns(shape, omega), data.shape[1] // 2
    spread = np.einsum("lc,oq->loqc", columns, np.eye(outputs)).reshape(omega.size, outputs, -1)
    table = np.einsum("lij,ljp->lip", inverses, _stacked(spread.transpose(0, 1, 2))).reshape(data.size, -1)
    whole = np.einsum("lij,lj->li", inverses, data).ravel()
    scale = np.linalg.norm(table, axis=0)
    solved = np.linalg.lstsq(table / scale, whole, rcond=1e-12)[0] / scale
    return solved.reshape(outputs, -1), whole - table @ solved


def _columns(shape: FloatArray, omega: FloatArray) -> ComplexArray:
    """Return what each output is a sum of: two numerators a section, and a direct part, all delayed."""
    s = 1j * omega
    sections = shape.size // 2
    columns = [np.ones_like(s)]
    for damping, stiffness in zip(np.exp(shape[:sections]), np.exp(shape[sections : 2 * sections]), strict=True):
        below = s**2 + damping * s + stiffness
        columns += [stiffness / below, math.sqrt(stiffness) * s / below]
    return np.asarray(np.stack(columns, axis=1) * np.exp(-s * shape[-1])[:, None])


def _stacked(values: ComplexArray) -> FloatArray:
    """Return real parts, then imaginary parts, along the second axis."""
    return np.concatenate([values.real, values.imag], axis=1)


def _complex(values: FloatArray) -> ComplexArray:
    half = values.shape[1] // 2
    return np.asarray(values[:, :half] + 1j * values[:, half:])


def _correlation(whitened: FloatArray, first: int, second: int, lag: int) -> float:
    """Return the correlation of two outputs' residuals, the second of so many lines further on."""
    residuals = _complex(whitened)
    earlier, later = residuals[: residuals.shape[0] - lag, first], residuals[lag:, second]
    power = math.sqrt(float(np.sum(np.abs(earlier) ** 2) * np.sum(np.abs(later) ** 2)))
    return float(np.real(np.sum(earlier * later.conj()))) / power
