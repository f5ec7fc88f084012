"""What is not linear in governor and engine, as equations of signals."""

from dataclasses import dataclass

from shaftprint.errors import StructureError
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, choose, clip, power


def deadband(error: Formula, half_width: Number) -> Formula:
    """Return the part of an error that lies beyond a deadband.

    Khalil, Nonlinear Systems, 2002, section 1.2.7, "dead zone". Governors of ships have 0.1 to 0.25 % of rated speed.
    """
    width = as_formula(half_width)
    return error if width.equals(0.0) else error - clip(error, -width, width)


def raised(signal: Formula, exponent: float, *, keeps_sign: bool = False) -> Formula:
    """Return a power of a signal, such as the torque of a propeller or the force of a spring that hardens.

    ``exponent``: 1 or more: below, the slope at zero has no end. ``keeps_sign``: whether what is negative stays so:
    ``sign(u) abs(u)^n``. Raises StructureError if the exponent is below 1, or no whole number where the sign is not
    kept.
    """
    whole = float(exponent).is_integer()
    if exponent < 1.0 or not (whole or keeps_sign):
        raise StructureError(f"equations: expected a whole exponent of 1 or more, or the sign kept, found {exponent}.")
    if keeps_sign and not (whole and exponent % 2.0):
        return choose(signal, 0.0, -1.0, 1.0) * power(abs(signal), exponent)
    # products: what is negative has a power in every language then
    result = signal
    for _ in range(int(exponent) - 1):
        result = result * signal
    return result


def two_sided(signal: Formula, above: Number, below: Number) -> Formula:
    """Return ``above`` times what is positive of a signal, ``below`` times what is negative."""
    return signal * choose(signal, 0.0, below, above)


def rate_limited(flow: Flow, signal: Formula, fastest: Number, *, period_s: Number = 0.0) -> Formula:
    """Return a signal that follows another no faster than a rate.

    A computer that moves its output every period by no more than ``fastest T``: ``z_k = z_k-1 + clip(u_k - z_k-1, -r T,
    r T)``. The period is a property of the model: 10 ms more of it shift what a limited signal does by as much.

    Parameters
    ----------
    fastest
        Rate [1/s] in units of the signal.
    period_s
        Period of the computer [s]; 0 for every step of the simulation.
    """
    change = as_formula(fastest) * flow.period(period_s)
    return flow.sampled(lambda last: last + clip(signal - last, -change, change), period_s)


@dataclass(frozen=True, slots=True, eq=False)
class Governed:
    """What a PI governor with limits asks for and gives."""

    wanted: Formula
    """Rack before the limits."""
    given: Formula
    """Rack after the limits."""


def limited_pi(
    flow: Flow,
    error: Formula,
    *,
    proportional: Number,
    integral: Number,
    lowest: Number,
    highest: Number,
    anti_windup_s: Number,
    droop: Number = 0.0,
    drawn: Number = 0.0,
) -> Governed:
    """Return a PI governor whose integrator is led back while its output is limited.

    ``X = K_p e + I``, ``dI/dt = K_i e + (clip(X) - X) / T_aw``: back-calculation (Astrom and Hagglund, PID Controllers,
    1995, section 3.5). It is continuous, unlike an integrator that stops, so that a fit can follow it. With droop ``R``
    the error is less by ``R I``, which is ``R X`` in steady running.

    Parameters
    ----------
    proportional, integral
        Gains [-], [1/s].
    lowest, highest
        Limits of the rack.
    anti_windup_s
        Time in which the integrator is led back [s].
    droop
        Fall of the speed from no rack to full, in units of the error for a unit of rack.
    drawn
        What else changes the integrator [1/s], such as an observer.
    """
    state = flow.state("governor integral")
    felt = error - as_formula(droop) * state
    wanted = as_formula(proportional) * felt + state
    limited = clip(wanted, lowest, highest)
    flow.rate(state, as_formula(integral) * felt + (limited - wanted) / as_formula(anti_windup_s) + as_formula(drawn))
    return Governed(wanted, limited)


def second_order_lag(flow: Flow, signal: Formula, frequency: Number, damping: Number) -> Formula:
    """Return a signal behind a second-order lag, ``x'' + 2 zeta omega_n x' + omega_n^2 x = omega_n^2 u``."""
    omega = as_formula(frequency)
    position, speed = flow.state("lag"), flow.state("lag rate")
    flow.rate(position, speed)
    flow.rate(speed, omega * (omega * (signal - position) - 2.0 * as_formula(damping) * speed))
    return position


def first_order_lag(flow: Flow, signal: Formula, time_s: Number, name: str = "lag") -> Formula:
    """Return a signal behind a first-order lag, ``T dx/dt = u - x``; the signal itself where ``T`` is zero."""
    time = as_formula(time_s)
    if time.equals(0.0):
        return signal
    state = flow.state(name)
    flow.rate(state, (signal - state) / time)
    return state
