"""What an identified model leaves unexplained, line by line."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import NORMAL_95, chi_square_quantile
from shaftprint.identify.likelihood._load_factors import load_factors
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Mark, Points, Straight
from shaftprint.report.charts._text import joined
from shaftprint.report.figures._uncertainty import COVERAGE

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification

# The picture shows at least this many standard deviations.
LEAST_STD = 3.2
WIDER = 1.4


def normalised_residuals(identification: "Identification") -> FloatArray:
    """Return measured minus model over standard deviation, real parts first, shape (2 channels, lines)."""
    data = identification.response
    residuals = unexplained(identification)
    std = np.sqrt(np.diagonal(data.covariance, axis1=1, axis2=2)).T
    return np.asarray(np.concatenate([residuals.real, residuals.imag]) / std)


def line_chi_square(identification: "Identification") -> FloatArray:
    """Return ``r^T C^-1 r`` of each line with its full covariance, shape (lines,)."""
    data = identification.response
    residuals = unexplained(identification)
    stacked = np.concatenate([residuals.real, residuals.imag]).T
    solved = np.linalg.solve(data.covariance, stacked[:, :, None])[:, :, 0]
    return np.asarray(np.einsum("lr,lr->l", stacked, solved))


def unexplained(identification: "Identification") -> ComplexArray:
    """Return measured minus model, shape (channels, lines); the load of each window acts on ``k_q`` as in the fit."""
    data = identification.response
    model = identification.structure.response(
        identification.values, 1j * data.omega_rad_s, factors=load_factors(identification.structure, data)
    )
    return np.asarray(data.response.reshape(model.shape) - model)


def residual_chart(identification: "Identification") -> Chart:
    """Return normalised residuals and chi-square of each line; lines that were not fitted are hollow, below only.

    Of a model that explains the data 95 % of the residuals lie within 1.96 standard deviations, and 95 % of the lines
    below the drawn limit.
    """
    omega = identification.response.omega_rad_s
    span = float(omega.min()) / WIDER, float(omega.max()) * WIDER
    frequency = Scale(title="frequency [rad/s]", log=True, span=span)
    residuals = normalised_residuals(identification)[:, identification.fitted]
    largest = max(LEAST_STD, 1.1 * float(np.abs(residuals).max()))
    return Chart(
        panels=(
            Panel(
                title=f"residuals of {identification.structure.name}",
                marks=[explained_band(span), *_residual_points(identification, residuals)],
                x=frequency,
                y=Scale(title="residual over its std [-]", span=(-largest, largest)),
            ),
            Panel(
                title="all numbers of a line together",
                marks=_chi_square_marks(identification),
                x=frequency,
                y=Scale(title="chi-square of the line [-]", log=True),
            ),
        ),
        heights_px=(240, 220),
    )


def explained_band(span: tuple[float, float]) -> Band:
    """Return where 95 % of the residuals of a right model lie."""
    ends = np.array(span)
    half = np.full(2, NORMAL_95)
    return Band(x=ends, lower=-half, upper=half, name="95 % of the residuals of a right model", shade="reference")


def _residual_points(identification: "Identification", residuals: FloatArray) -> list[Mark]:
    data, fitted = identification.response, identification.fitted
    names = tuple(identification.fit_percent)
    marks: list[Mark] = []
    for row, values in enumerate(residuals):
        part, channel = divmod(row, len(names))
        marks.append(
            Points(
                x=data.omega_rad_s[fitted],
                y=values,
                name=joined(f"{'imaginary' if part else 'real'} part of ", Symbol(names[channel])),
                shade=channel,
                marker="x" if part else None,
                words=[name for name, is_shown in zip(data.lines, fitted, strict=True) if is_shown],
            )
        )
    return marks


def _chi_square_marks(identification: "Identification") -> list[Mark]:
    data, chi_square = identification.response, line_chi_square(identification)
    size = 2 * len(identification.fit_percent)
    limit = chi_square_quantile(COVERAGE, size)
    marks: list[Mark] = []
    for chosen, filled, name in (
        (identification.fitted, True, "fitted line"),
        (~identification.fitted, False, "line not fitted"),
    ):
        if chosen.any():
            words = [line for line, is_shown in zip(data.lines, chosen, strict=True) if is_shown]
            marks.append(
                Points(x=data.omega_rad_s[chosen], y=chi_square[chosen], name=name, filled=filled, words=words)
            )
    marks.append(Straight(at=limit, axis="y", name=f"95 % limit, {limit:.1f} for {size} numbers"))
    return marks
