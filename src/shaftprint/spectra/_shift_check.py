"""Whether speed and torque are shifted against each other, from the ratio of both at the lines.

Behind the gauge are inertia and load: ``M_s / n = (k + j w tau) exp(-j w t)`` with a torque that leads the speed. For
each delay ``t`` the load ``k`` and the inertia time ``tau`` that fit best are found by least squares. What the
telemetry or a pick-up really is late by, a few milliseconds, the fit of a structure finds; here the coarse errors are
named that no structure reaches: samples that were lost in one channel, a latency in the wrong unit, a telemetry whose
filter is slow, ``1 / (1 + j w T)`` in place of the delay.

Where a lever moves a pitch with the speed, what is shown of the pitch is one more load: ``M_s / n = (k + j w tau + q
theta / n) exp(-j w t)``.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, RealOrComplexArray
from shaftprint.reasons import Reason
from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.spectra._frequency_response import FrequencyResponse

_DELAYS_S = np.arange(-300, 301) * 0.01
_LAGS_S = np.geomspace(0.02, 2.0, 60)
# A delay below this is for the fit to find; one that is named lowers chi-square by as much as five deviations.
_LEAST_S, _LEAST_FALL = 0.025, 25.0
# A filter is told from a delay by three deviations.
_BETTER = 9.0
# Loads and inertia times that are possible at all.
_LOADS, _LONGEST_S = (0.5, 4.0), 3.0
_FEWEST_LINES = 4
# Of a ratio of two numbers that are hardly more than their noise neither size nor phase is known, nor how well.
_LARGEST_VARIANCE = 0.1
_PITCH = "theta"


def shift_reasons(response: "FrequencyResponse") -> tuple[Reason, ...]:
    """Return a reason where the torque comes later, or earlier, than load and inertia let expect.

    ``response``: response from the set point to speed ``n`` and torque ``M_s``.
    """
    used = response.used
    if np.count_nonzero(used) < _FEWEST_LINES:
        return ()
    places = [response.outputs.index(name) for name in ("n", "M_s")]
    speed, torque = response.response[places, 0][:, used]
    variance = np.diagonal(response.covariance, axis1=1, axis2=2)[used]
    half = len(response.outputs)
    share = sum(
        (variance[:, row] + variance[:, half + row]) / np.abs(value) ** 2
        for row, value in zip(places, (speed, torque), strict=True)
    )
    ratio = torque / speed
    known = share < _LARGEST_VARIANCE
    if np.count_nonzero(known) < _FEWEST_LINES:
        return ()
    ratio, share, omega, load = (
        ratio[known],
        share[known],
        response.omega_rad_s[used][known],
        response.load[used][known],
    )
    further: tuple[ComplexArray, ...] = ()
    if _PITCH in response.outputs:
        pitch = response.response[response.outputs.index(_PITCH), 0][used] / speed
        further = (pitch[known],)
    std = np.abs(ratio) * np.sqrt(share / 2.0)
    delayed, lagged = (
        _chi_squares(omega, ratio, std, load, further, undone)
        for undone in (np.exp(1j * omega * _DELAYS_S[:, None]), 1.0 + 1j * omega * _LAGS_S[:, None])
    )
    best, prompt = int(np.argmin(delayed)), delayed[_DELAYS_S.size // 2]
    delay_s, lag_s = float(_DELAYS_S[best]), float(_LAGS_S[np.argmin(lagged)])
    if lag_s >= _LEAST_S and prompt - lagged.min() > _LEAST_FALL and delayed[best] - lagged.min() > _BETTER:
        return (_of_filter(lag_s),)
    if abs(delay_s) < _LEAST_S or np.isinf(delayed[best]) or not prompt - delayed[best] > _LEAST_FALL:
        return ()
    return (
        Reason(
            kind="gauge latency",
            where="M_s",
            sentence=(
                "Speed and torque are shifted against each other: the torque comes about "
                f"{MILLI * abs(delay_s):.0f} ms {'later' if delay_s > 0.0 else 'earlier'} than load and inertia let "
                "expect; check latency_s of the torque gauge in the vessel file, whether the "
                "speed pick-up is late, and whether samples of one channel were lost."
            ),
        ),
    )


def _of_filter(lag_s: float) -> Reason:
    return Reason(
        kind="gauge latency",
        where="M_s",
        sentence=(
            "The torque is smaller and later the faster it moves, as behind a low-pass of "
            f"{0.5 / np.pi / lag_s:.1g} Hz: switch the filter of the gauge, its telemetry or the logger off, or set it "
            "to 20 Hz and more."
        ),
    )


def _chi_squares(
    omega_rad_s: FloatArray,
    ratio: ComplexArray,
    std: FloatArray,
    load: RealOrComplexArray,
    further: Sequence[ComplexArray],
    undone: ComplexArray,
) -> FloatArray:
    """Return the lowest chi-square for each way to be late, shape (ways,); infinite where the best fit is impossible.

    ``further`` are loads over the speed that were measured, each with a real factor of its own. ``undone`` is what
    takes each way back, shape (ways, lines).
    """
    # slope of the load and inertia, both real, against the ratio taken back, whose noise grows with it
    weight = 1.0 / (std * np.abs(undone))
    rows = weight[:, None, :] * np.stack([load + 0j, 1j * omega_rad_s, *further])
    seen = ratio * undone * weight
    normal = (rows @ rows.conj().swapaxes(1, 2)).real
    factors = np.linalg.solve(normal, (rows.conj() @ seen[:, :, None]).real)[:, :, 0]
    k, tau = factors[:, 0], factors[:, 1]
    possible = (_LOADS[0] < k) & (k < _LOADS[1]) & (tau >= 0.0) & (tau < _LONGEST_S)
    left = seen - np.einsum("wr,wrl->wl", factors, rows)
    return np.where(possible, np.sum(np.abs(left) ** 2, axis=1), np.inf)
