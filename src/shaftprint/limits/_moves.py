"""Where a search begins again: the calm part of a test, and places to which the best governor is pushed."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from shaftprint.arrays import BoolArray, frozen_bool
from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.limits._candidates import Kind
from shaftprint.limits._governor_fit import Fitted
from shaftprint.limits.prediction._prediction_error import OUTPUT
from shaftprint.limits.prediction._set_point import GovernorRecord

# Share of the tests, the calmest first, whose torque changes so little that no limit is near.
CALM = 0.5
# The push of a delay [s].
PUSH_S = 0.03
# The push of the set point's offset, over its deviation, and of the level of a torque limit with it.
REST_PUSH, LEVEL_SHARES = 1.0, (0.8, 0.9, 1.0, 1.1, 1.2, 1.35)
# A torque limit above this, over the torque of the working point, is none that the line rests near.
NEAR_REST = 2.0
# Offsets of the set point that are nearer to each other are one; the largest that is tried.
SAME_OFFSET, LARGEST_OFFSET = 1.5e-3, 0.045


def calm_part(record: GovernorRecord, campaign: Campaign) -> GovernorRecord:
    """Return the record with only the sines in use in which the torque changes least: no limit is near in them."""
    rate = np.abs(np.gradient(record.outputs[OUTPUT], 1.0 / record.rate_hz))
    inside = {sine.name: _inside(record, sine.settled_s, sine.stop_s) for sine in campaign.sines}
    inside = {name: where for name, where in inside.items() if where.any()}
    if len(inside) < 2:
        return record
    order = sorted(inside, key=lambda name: float(np.mean(rate[inside[name]])))
    kept = np.any([inside[name] for name in order[: max(round(CALM * len(order)), 2)]], axis=0)
    return replace(record, used=frozen_bool(kept))


def _inside(record: GovernorRecord, begin_s: float, end_s: float) -> BoolArray:
    return np.asarray(record.used & (record.time_s >= begin_s) & (record.time_s < end_s))


def delay_moves(here: Fitted) -> list[dict[str, float]]:
    """Return the delays inside the loop and before it, moved from one to the other: they trade along a valley."""
    late, before = here.values[GovernorSymbol.LOOP_DELAY], here.values[GovernorSymbol.SET_POINT_LATENCY]
    return [
        {
            GovernorSymbol.LOOP_DELAY: max(late + by_s, 0.005),
            GovernorSymbol.SET_POINT_LATENCY: max(before - by_s, 0.005),
        }
        for by_s in (-PUSH_S, PUSH_S)
    ]


def rest_moves(
    here: Fitted, *, calm: Mapping[str, float], offset: float, priors: Mapping[str, Prior]
) -> list[dict[str, float]]:
    """Return offsets of the set point at which the line may rest, beside a limit of the torque with other levels.

    A line that rests near its torque limit has an optimum with the limit acting at rest, a lower level, a lower set
    point and a slower governor, and one without.

    ``calm``: governor of the calm part of the test. ``offset``: offset of the set point in the slow parts of the test.
    ``priors``: what is known of the set point's scale and offset.
    """
    scale, known = priors[GovernorSymbol.SET_POINT_SCALE].mean, priors[GovernorSymbol.SET_POINT_OFFSET]
    offsets: list[float] = []
    for one in (offset, *(known.mean + side * REST_PUSH * known.std for side in (-1.0, 1.0))):
        if all(abs(one - other) > SAME_OFFSET for other in offsets):
            offsets.append(float(np.clip(one, -LARGEST_OFFSET, LARGEST_OFFSET)))
    levels: list[dict[str, float]] = [{}]
    gains = {name: calm[name] for name in (GovernorSymbol.PROPORTIONAL_GAIN, GovernorSymbol.INTEGRAL_GAIN)}
    if Kind.SMOKE in here.kinds:
        levels = [gains]
        at = here.values[GovernorSymbol.SET_POINT_OFFSET]
        offsets += [at - SAME_OFFSET, at + SAME_OFFSET]
    elif Kind.TORQUE in here.kinds and here.values[GovernorSymbol.TORQUE_LIMIT] < NEAR_REST:
        levels = [
            {GovernorSymbol.TORQUE_LIMIT: share * here.values[GovernorSymbol.TORQUE_LIMIT], **gains}
            for share in LEVEL_SHARES
        ]
    return [
        {GovernorSymbol.SET_POINT_SCALE: scale, GovernorSymbol.SET_POINT_OFFSET: one, **level}
        for one in offsets
        for level in levels
    ]
