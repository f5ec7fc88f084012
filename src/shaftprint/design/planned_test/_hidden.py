"""Whether the staircase of a plan can decide that a model holds, or noise hides it: what ``validate`` will say."""

import math
from dataclasses import dataclass

import numpy as np

from shaftprint.design.motion._motion import SIGNALS, motion
from shaftprint.design.motion._stairs import stairs_spectrum
from shaftprint.design.plan._plan import Plan
from shaftprint.distributions import deviations
from shaftprint.validation._settings import ValidationSettings

# What a linear model with the right numbers misses of steps where no limit acts, as the settings of validation say: the
# line is another one at another speed.
_LINEAR = 0.09
# Deviations below which a normal number is five times in six.
_FIVE_OF_SIX = 1.0
# Signals that are compared, and the outputs that show them.
_COMPARED = {"speed": "n", "shaft torque": "M_s"}


@dataclass(frozen=True, kw_only=True, slots=True)
class HiddenMotion:
    """Mean squares of one output over the whole staircase, over that of its working point."""

    moved: float
    """Of what the steps move."""
    noise: float
    """Of the noise."""
    beyond: float
    """Up to which the interval of the error of a right model reaches by noise alone, in five tests of six."""

    @property
    def share(self) -> float:
        """End of the interval of the error over the motion that is measured, which holds the noise too."""
        return math.hypot(_LINEAR, math.sqrt(self.beyond / (self.moved + self.noise)))

    def growth(self, share: float) -> float:
        """Return how many times as high the steps have to be for the interval to end at a share."""
        return math.sqrt(max(self.beyond / (share**2 - _LINEAR**2) - self.noise, 0.0) / self.moved)


def hidden_motion(plan: Plan, settings: ValidationSettings) -> tuple[HiddenMotion, ...]:
    """Return what noise hides of the staircase of a plan, of speed and of shaft torque.

    The mean square of noise of the one-sided density ``G`` over ``T`` seconds has the variance ``int G^2 df / T``
    (Bendat and Piersol, Random Data, on errors of mean square estimates).
    """
    stairs = stairs_spectrum(np.array(plan.stairs_rpm) / plan.legs[0].level_rpm, plan.timetable.dwell_s)
    responses = motion(plan.structures[0], plan.ship.values[None, :], stairs.omega_rad_s)[0]
    hertz = np.arange(1, int(settings.highest_hz * stairs.duration_s) + 1) / stairs.duration_s
    density = plan.noise[0].of_outputs(*_COMPARED.values()).at(hertz)
    found = []
    for place, signal in enumerate(_COMPARED):
        powers = density[:, place, place].real / stairs.duration_s
        found.append(
            HiddenMotion(
                moved=float(np.var(stairs.in_time(responses[SIGNALS.index(signal)])[: stairs.samples])),
                noise=float(np.sum(powers)),
                beyond=(deviations(settings.coverage) + _FIVE_OF_SIX) * math.sqrt(float(np.sum(powers**2))),
            )
        )
    return tuple(found)


def stairs_sentences(plan: Plan) -> list[str]:
    """Return that the staircase is too low for the noise, and how high it would have to be; nothing where it tells."""
    if not plan.stairs_rpm:
        return []
    settings = ValidationSettings()
    asked, largest_rpm = settings.largest_error, max(plan.stairs_rpm)
    motions = hidden_motion(plan, settings)
    hidden = max(one.share for one in motions)
    if hidden <= asked:
        return []
    needed_rpm = largest_rpm * max(one.growth(asked) for one in motions)
    return [
        f"The steps of {largest_rpm:.0f} rpm at the end may prove nothing: with this noise `validate` would know the "
        f"error of the model to {100.0 * hidden:.1f} % of what they move, where it asks for {100.0 * asked:.0f} %. The "
        f"limits leave no room for the {needed_rpm:.0f} rpm that would show it in five tests of six; --no-staircase "
        "gives their time to the lines."
    ]
