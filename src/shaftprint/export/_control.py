"""A model as objects of python-control, which has no delays: with Pade approximations, and how wrong those are."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.linalg import block_diag

from shaftprint.arrays import FloatArray
from shaftprint.errors import ExportError
from shaftprint.export._model import ExportedModel, exported_model
from shaftprint.export.linear._delay_model import DelayModel, delay_model
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.notebook._library import library

if TYPE_CHECKING:
    from control import FrequencyResponseData, StateSpace

POINTS: Final = 200
PERCENT: Final = 100.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ControlModel:
    """A model in python-control, and how far it is from the exact one."""

    system: "StateSpace"
    """State space from inputs to outputs, its delays approximated."""
    exact: "FrequencyResponseData"
    """The exact response over the band."""
    pade_order: int
    """Order of the approximation of each delay; 0 where there is none."""
    band_rad_s: tuple[float, float]
    """Band over which the error is stated [rad/s]."""
    largest_error: dict[str, float]
    """Largest distance of the response from the exact one over that band, over the largest size of the exact one from
    the same input, by ``output / input``."""
    lateness_s: dict[str, float]
    """By how much an output comes later than its time stamps, which lie ahead of what can be known [s]; it is part of
    the error."""

    @property
    def remark(self) -> str:
        """What a user must know, in a sentence."""
        low, high = self.band_rad_s
        worst = max(self.largest_error, key=self.largest_error.__getitem__)
        late = "".join(f" {name} comes {time:.3g} s late." for name, time in self.lateness_s.items())
        if not self.pade_order:
            return f"No delay is in the model: it is exact.{late}"
        return (
            f"Delays are approximations of Pade of order {self.pade_order}: from {low:g} to {high:g} rad/s the "
            f"response of {worst} is wrong by up to {PERCENT * self.largest_error[worst]:.2g} % of its largest size; "
            f"beyond that band the phase is lost.{late}"
        )


def to_control(
    model: ExportedModel | Fingerprint, *, pade_order: int | None = None, band_rad_s: tuple[float, float] = (0.05, 50.0)
) -> ControlModel:
    """Return a model as a state space of python-control.

    Parameters
    ----------
    model
        The model, or the fingerprint of a shipped structure.
    pade_order
        Order of the Pade approximation of every delay; needed where there is one.
    band_rad_s
        Band over which the error of the approximation is found [rad/s].

    Raises
    ------
    ExportError
        If python-control is missing, there are delays but no order, the order or the band makes no sense, or the model
        has no state space.
    StructureError
        If a block of the structure has no equations in time.
    """
    control = library("control", "to_control")
    low, high = band_rad_s
    if not 0.0 < low < high < np.inf:
        raise ExportError(
            f"to_control: expected a band with two ascending frequencies above 0 rad/s, found {band_rad_s}."
        )
    chosen = exported_model(model, linear=True) if isinstance(model, Fingerprint) else model
    linear = delay_model(chosen)
    order = _order(linear, pade_order)
    a, b, c, d = _without_delays(linear, order)
    names = {"inputs": list(linear.inputs), "outputs": list(linear.outputs)}
    system = control.ss(a, b, c, d, name=chosen.structure.name, **names)
    omega = np.geomspace(low, high, POINTS)
    exact = linear.response(1j * omega)
    distance = np.abs(np.asarray(system(1j * omega, squeeze=False)) - exact).max(axis=-1)
    size = np.abs(exact).max(axis=-1)
    pairs = [(i, j) for i in range(len(linear.outputs)) for j in range(len(linear.inputs))]
    late = zip(linear.outputs, np.maximum(-linear.shift_s, 0.0), strict=True)
    return ControlModel(
        system=system,
        exact=control.frd(exact, omega, **names),
        pade_order=order,
        band_rad_s=(float(low), float(high)),
        largest_error={
            f"{linear.outputs[i]} / {linear.inputs[j]}": float(distance[i, j] / size[i, j]) for i, j in pairs
        },
        lateness_s={name: float(time) for name, time in late if time > 0.0},
    )


def pade(tau_s: float, order: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the Pade approximation of a delay as a state space.

    ``N(-s tau) / N(s tau)`` with ``N(x) = sum over k of (2 m - k)! / (k! (m - k)!) x^k`` for order ``m`` (Golub and Van
    Loan, Matrix Computations, 2013, section 9.3.1), in time ``t / tau``, so that no coefficient grows with the delay.
    """
    weights = np.ones(order + 1)
    for k in range(order):
        weights[k + 1] = weights[k] * (order - k) / ((2 * order - k) * (k + 1))
    bottom = weights[::-1] / weights[-1]
    top = bottom * (-1.0) ** np.arange(order, -1, -1)
    direct = top[0]
    a = np.zeros((order, order))
    a[:, 0] = -bottom[1:]
    a[:-1, 1:] += np.eye(order - 1)
    b = (top - direct * bottom)[1:, None]
    c = np.zeros((1, order))
    c[0, 0] = 1.0
    return a / tau_s, b / tau_s, c, np.array([[direct]])


def _order(linear: DelayModel, wanted: int | None) -> int:
    delays = [*linear.tau_s, *(shift for shift in linear.shift_s if shift > 0.0)]
    if not delays:
        return 0
    if wanted is None or not (isinstance(wanted, int) and 1 <= wanted <= 15):
        raise ExportError(
            f"to_control: expected an order from 1 to 15 for the Pade approximation of {len(delays)} delays of up to "
            f"{max(delays):.3g} s, which python-control does not have, found {wanted}; give pade_order=5, say."
        )
    return wanted


def _without_delays(linear: DelayModel, order: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return a state space in which every delay is approximated."""
    into, out = len(linear.inputs), len(linear.outputs)
    system = (linear.a, linear.b, linear.c, linear.d)
    if linear.tau_s.size:
        system = _closed(system, _side_by_side([pade(tau, order) for tau in linear.tau_s]), into, out)
    if np.any(linear.shift_s > 0.0):
        one = (np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.ones((1, 1)))
        behind = _side_by_side([pade(shift, order) if shift > 0.0 else one for shift in linear.shift_s])
        system = _in_series(system, behind)
    return system


System = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


def _side_by_side(parts: list[System]) -> System:
    a, b, c, d = (block_diag(*matrices) for matrices in zip(*parts, strict=True))
    return a, b, c, d


def _in_series(first: System, second: System) -> System:
    """Return what the second makes of what the first gives."""
    a, b, c, d = first
    e, f, g, h = second
    top = np.hstack([a, np.zeros((a.shape[0], e.shape[0]))])
    return (
        np.vstack([top, np.hstack([f @ c, e])]),
        np.vstack([b, f @ d]),
        np.hstack([h @ c, g]),
        h @ d,
    )


def _closed(system: System, late: System, into: int, out: int) -> System:
    """Return a system whose last outputs come back to its last inputs through another.

    ``z = C_2 x + D_21 u + D_22 w`` and ``w = G q + H z`` give ``(1 - D_22 H) z = C_2 x + D_21 u + D_22 G q``.
    """
    a, b, c, d = system
    e, f, g, h = late
    loop = np.linalg.inv(np.eye(h.shape[0]) - d[out:, into:] @ h)
    z_x, z_q, z_u = loop @ c[out:], loop @ d[out:, into:] @ g, loop @ d[out:, :into]
    w_x, w_q, w_u = h @ z_x, g + h @ z_q, h @ z_u
    return (
        np.block([[a + b[:, into:] @ w_x, b[:, into:] @ w_q], [f @ z_x, e + f @ z_q]]),
        np.vstack([b[:, :into] + b[:, into:] @ w_u, f @ z_u]),
        np.hstack([c[:out] + d[:out, into:] @ w_x, d[:out, into:] @ w_q]),
        d[:out, :into] + d[:out, into:] @ w_u,
    )
