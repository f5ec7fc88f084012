"""What an identified model leaves unexplained, line by line."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import NORMAL_95, chi_square_quantile
from shaftprint.identify.likelihood import load_factors
from shaftprint.report.figures._style import (
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
    plain_log_axis,
)
from shaftprint.report.figures._uncertainty import COVERAGE
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification

# The picture shows at least this many standard deviations.
LEAST_STD = 3.2


def normalised_residuals(identification: "Identification") -> FloatArray:
    """Return measured minus model over standard deviation, real parts first, shape (2 channels, lines)."""
    data = identification.response
    residuals = _left(identification)
    std = np.sqrt(np.diagonal(data.covariance, axis1=1, axis2=2)).T
    return np.asarray(np.concatenate([residuals.real, residuals.imag]) / std)


def line_chi_square(identification: "Identification") -> FloatArray:
    """Return ``r^T C^-1 r`` of each line with its full covariance, shape (lines,)."""
    data = identification.response
    residuals = _left(identification)
    stacked = np.concatenate([residuals.real, residuals.imag]).T
    solved = np.linalg.solve(data.covariance, stacked[:, :, None])[:, :, 0]
    return np.asarray(np.einsum("lr,lr->l", stacked, solved))


def _left(identification: "Identification") -> ComplexArray:
    """Return measured minus model, shape (channels, lines); the load of each window acts on ``k_q`` as in the fit."""
    data = identification.response
    model = identification.structure.response(
        identification.values, 1j * data.omega_rad_s, factors=load_factors(identification.structure, data)
    )
    return np.asarray(data.response.reshape(model.shape) - model)


def plot_residuals(identification: "Identification") -> "Figure":
    """Return normalised residuals and chi-square of each line; lines that were not fitted are hollow, below only.

    Of a model that explains the data 95 % of the residuals lie within 1.96 standard deviations, and 95 % of the lines
    below the drawn limit.
    """
    with house_style():
        figure = new_figure(10.5)
        top, bottom = figure.subplots(2, 1, sharex=True)
        _draw_residuals(top, identification)
        _draw_chi_square(bottom, identification)
        plain_log_axis(bottom)
        bottom.set_xlabel("frequency [rad/s]")
        titles = (f"residuals of {identification.structure.name}", "all numbers of a line together")
        letter_panels((top, bottom), titles)
        legend_below(figure, legend_entries((top, bottom)))
        return figure


def _draw_residuals(axes: "Axes", identification: "Identification") -> None:
    data, fitted = identification.response, identification.fitted
    residuals = normalised_residuals(identification)
    names = tuple(identification.fit_percent)
    axes.axhspan(-NORMAL_95, NORMAL_95, color="#dddddd", linewidth=0.0, label="95 % of a model that explains all")
    for row in range(residuals.shape[0]):
        part, channel = divmod(row, len(names))
        style = look(channel)
        axes.plot(
            data.omega_rad_s[fitted],
            residuals[row, fitted],
            linestyle="none",
            marker="x" if part else style.marker,
            markersize=4.0,
            color=style.colour,
            label=f"{'imaginary' if part else 'real'} part of {mathtext(names[channel])}",
        )
    largest = max(LEAST_STD, 1.1 * float(np.abs(residuals[:, fitted]).max()))
    axes.set_ylim(-largest, largest)
    axes.set_ylabel("residual over\nstandard deviation [-]")


def _draw_chi_square(axes: "Axes", identification: "Identification") -> None:
    chi_square = line_chi_square(identification)
    size = 2 * len(identification.fit_percent)
    for chosen, fill, text in (
        (identification.fitted, "black", "fitted line"),
        (~identification.fitted, "white", "line not fitted"),
    ):
        if chosen.any():
            axes.plot(
                identification.response.omega_rad_s[chosen],
                chi_square[chosen],
                linestyle="none",
                marker="o",
                markersize=4.0,
                color="black",
                markerfacecolor=fill,
                label=text,
            )
    limit = chi_square_quantile(COVERAGE, size)
    axes.axhline(limit, color=REFERENCE, label=f"95 % limit, {limit:.1f} for {size} numbers")
    axes.set_ylabel("chi-square of the line [-]")
    plain_log_axis(axes, "y")
