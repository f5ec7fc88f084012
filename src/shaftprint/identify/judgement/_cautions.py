"""What does not speak against the numbers of a fit, but is close to it, in sentences."""

import math
from collections.abc import Collection, Mapping

import numpy as np

from shaftprint.digits import after_number, stated
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.judgement._evidence import Evidence, gain_reserve, loop_delay_s
from shaftprint.identify.judgement._line_quality import crossings_rad_s
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.judgement._prior_contradictions import off_nominal, strange_priors
from shaftprint.spelling import listed

# A fit that is better than this probability allows has less noise than its covariance says.
TOO_GOOD = 0.999


def cautions_of(evidence: Evidence, numbers: Mapping[str, Estimate], not_trusted: Collection[str]) -> tuple[str, ...]:
    """Return what a reader of a trustworthy fit must know all the same.

    ``numbers``: the margins among them, by name. ``not_trusted``: names of those that are not to be used.
    """
    return (
        *_small_margins(evidence, numbers, not_trusted),
        *_perhaps_unstable(evidence),
        *_beyond_the_lines(evidence),
        *_scale_of_set_point(evidence),
        *strange_priors(evidence.identification),
        *_too_good(evidence),
        *_unweighted(evidence),
    )


def _small_margins(evidence: Evidence, numbers: Mapping[str, Estimate], not_trusted: Collection[str]) -> list[str]:
    small = small_margins(evidence)
    told = [words for name, words in small.items() if name not in not_trusted]
    hidden = [name for name in small if name in not_trusted]
    known = [name for name in hidden if name in numbers and math.isfinite(numbers[name].std)]
    ranges = [f"the {name} is between {_range(numbers[name])}" for name in known]
    sentences = [f"The stability margins are small: {listed(told)}."] if told else []
    if hidden:
        reach = f": {listed(ranges)}" if ranges else ""
        sentences.append(f"Whether the {listed(hidden)} is small is not known well enough{reach}.")
    return sentences


def small_margins(evidence: Evidence) -> dict[str, str]:
    """Return the margins that are less than what is required, by name, in words."""
    margins, needs = evidence.margins, evidence.requirements
    if margins is None or evidence.loop != "small":
        return {}
    delay = loop_delay_s(evidence.identification)
    small = {}
    if gain_reserve(margins) < needs.gain_margin:
        small["gain margin"] = f"a gain margin of {gain_reserve(margins):.2f}, where {needs.gain_margin:g} is the least"
    degrees = float(np.degrees(abs(margins.phase_margin_rad)))
    if degrees < needs.phase_margin_deg:
        small["phase margin"] = f"a phase margin of {degrees:.0f} deg, where {needs.phase_margin_deg:g} is the least"
    if margins.delay_margin_s < needs.delay_margin_share * delay:
        small["delay margin"] = (
            f"a delay margin of {margins.delay_margin_s:.2g} s for a delay of {delay:.2g} s in the loop"
        )
    return small


def _range(number: Estimate) -> str:
    """Return the 95 % interval of a margin in words."""
    low, high = number.interval_95 or number.limits_95
    unit = after_number(number.unit)
    return f"{low:.3g} and {high:.3g}{unit}"


def _perhaps_unstable(evidence: Evidence) -> list[str]:
    """Return that the data allow unstable sets too."""
    if evidence.profile is None or evidence.margins is None:
        return []
    if evidence.identification.objective.stable(evidence.profile.points).all():
        return []
    return ["The data allow unstable loops too: some parameter sets at the ends of the 95 % intervals are."]


def _beyond_the_lines(evidence: Evidence) -> list[str]:
    """Return that the loop decides on its stability where there are no lines."""
    if evidence.identification.objective.others:
        return []
    omega = evidence.good_omega_rad_s
    outside = [c for c in crossings_rad_s(evidence.identification) if not omega[0] <= c <= omega[-1]]
    if not outside:
        return []
    frequencies = listed([f"{crossing:.2g}" for crossing in outside])
    return [
        f"The margins are extrapolated: the loop gain passes 1 or -1 at {frequencies} rad/s, and the good spectral "
        f"lines reach from {omega[0]:.2g} to {omega[-1]:.2g} rad/s."
    ]


def _scale_of_set_point(evidence: Evidence) -> list[str]:
    """Return that the set point was recorded at another scale than its line has, which the fit counts."""
    return [
        f"The scale of the set point, {one.name} = {stated(one.value, one.std, one.unit)}, is not that of its line: "
        "the lever bends, or its levels were others; it is counted in all numbers."
        for one in off_nominal(evidence.identification)
    ]


def _too_good(evidence: Evidence) -> list[str]:
    p_value = evidence.identification.p_value
    if p_value is None or p_value <= TOO_GOOD or math.isinf(evidence.identification.chi_square):
        return []
    if evidence.identification.objective.others:
        # the noise of records is found from what the structure leaves of them, and may hold more than noise: it is no
        # covariance that was known before, and says nothing against standard deviations
        return []
    return [
        f"The fit is better than the noise allows ({probability(p_value)}): the covariance of the data is too "
        "large, and so are the standard deviations."
    ]


def _unweighted(evidence: Evidence) -> list[str]:
    if evidence.identification.is_likelihood:
        return []
    return ["The fit was not weighted by the noise: whether the structure explains the data is judged coarsely."]
