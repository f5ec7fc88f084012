"""Dry friction and play in a drive, as equations of signals.

Dry friction of an ideal law jumps where the motion turns, and holds what stands still; steps of a simulation cannot
follow that jump, and a law that goes smoothly through zero holds nothing. So bristles are bent, as in the laws of Dahl
(A solid friction model, 1968) and of LuGre (Canudas de Wit, Olsson, Astrom and Lischinsky, A new model for control of
systems with friction, IEEE Transactions on Automatic Control 40, 1995): with the share ``z`` of the friction that acts,

    t_w dz/dt = (w - abs(w) z / g) / (abs(w) + q / t_w),    T = T_C (z + t_w dz/dt)

Standing still, ``z`` is a spring that yields by ``q``; moving, it follows the speed's sign within ``t_w``. The excess
over ``abs(w)`` bounds how fast it changes, which those laws leave to the speed.
"""

from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, clip
from shaftprint.models.equations._limits import deadband


def coulomb_friction(flow: Flow, speed: Formula, size: Number, *, yielding: Number, within_s: Number) -> Formula:
    """Return dry friction, positive with the speed; what it holds stands still.

    Parameters
    ----------
    speed
        Speed of what rubs.
    size
        Torque or force ``T_C`` of the friction, in units of the output.
    yielding
        By how much what is held yields, ``q``: small against the moves, in units of the speed times seconds.
    within_s
        Time ``t_w`` within which the friction follows a change of the direction [s].
    """
    return stribeck_friction(flow, speed, size, breakaway=1.0, fading_speed=1.0, yielding=yielding, within_s=within_s)


def stribeck_friction(
    flow: Flow,
    speed: Formula,
    size: Number,
    *,
    breakaway: Number,
    fading_speed: Number,
    yielding: Number,
    within_s: Number,
) -> Formula:
    """Return dry friction that is larger at rest, ``g = 1 + (b - 1) exp(-(w / w_St)^2)``.

    Parameters
    ----------
    speed, size, yielding, within_s
        As in ``coulomb_friction``; ``size`` is that of what moves.
    breakaway
        Friction of what begins to move over that of what moves, ``b``; 1 for none that is larger.
    fading_speed
        Speed ``w_St`` over which the excess fades.
    """
    excess, time = as_formula(breakaway) - 1.0, as_formula(within_s)
    limit = 1.0 + excess * (-((speed / as_formula(fading_speed)) ** 2.0)).exp()
    bent = flow.state("bristles")
    # what is bent too far cannot be, and acts as if it were not: it says so to whoever looks for steady running, and a
    # search for the states of a start meets no impulse in it that would follow the noise of a sample
    possible = clip(bent, -limit, limit)
    too_far = (bent - possible) / time
    rate = (speed - abs(speed) * possible / limit) / (time * abs(speed) + as_formula(yielding)) - too_far
    flow.rate(bent, rate)
    flow.follows_within(time)
    return as_formula(size) * (bent + time * as_formula(rate))


def backlash(flow: Flow, signal: Formula, gap: Number, *, within_s: Number) -> Formula:
    """Return a signal behind a gear with play: it moves where the other pushes it, and stays in between.

    ``T dy/dt = u - y - clip(u - y, -b / 2, b / 2)`` (Khalil, Nonlinear Systems, 2002, section 1.2.7, "backlash", which
    is reached for short ``T``).

    Parameters
    ----------
    gap
        Width ``b`` of the play, in units of the signal.
    within_s
        Time in which what is pushed follows [s].
    """
    pushed = flow.state("pushed")
    flow.rate(pushed, deadband(signal - pushed, 0.5 * as_formula(gap)) / as_formula(within_s))
    flow.follows_within(within_s)
    return pushed
