"""Whether a line is the model at all: what its segments hold that the model leaves, and that is no noise.

A wrong model is fitted too, with wrong numbers and small deviations, and the sum of squares does not show it: noise is
as large as it is found. So the fit is asked along what a right model leaves nothing of (score tests: Rao, Large sample
tests of statistical hypotheses, 1948; a model of the model's error: Ljung, Model validation and model error modeling,
1999):

- does what is left of speed or torque still follow the lever? Then the line answers otherwise, whatever the numbers.
- do gains, delays or the line of the lever go with the speed, or with size or direction of the move?
- do the segments contradict what the vessel file states?

Each is asked beside the free numbers, which take up what they can, and its deviation is the scatter of the segments.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import C_SET, GAUGE_K_I, GAUGE_K_P, T_D, T_GAUGE, T_SP, TAU_UP, G
from shaftprint.catalogue._sailing import TAU_U, A, B, E
from shaftprint.distributions import f_tail
from shaftprint.identify.judgement._prior_contradictions import from_prior
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.service._model import FREE, ServiceModel
from shaftprint.service._score import Simulated, scores
from shaftprint.time_domain._whitening import Whitening

# What is left follows the lever where chance does that once in so many fits; a trend counts from so many deviations on.
_CHANCE, _FAR = 1e-4, 4.3
# A trend of less is none by chance either where the likelihood gains so much by it: a wrong model leaves scatter of its
# own, which hides the trend. In 74 sound logs none gained more than 18.
_LIKELY, _GAINS_MUCH = 2.0, 24.0
# What may follow the lever as it likes explains more than one number that hangs on something: so many times as much.
_FREEDOM = 2.0
# Causes that are named.
_MOST = 2
# Times after a move between which what is left has a mean of its own [s].
_LAGS_S = (0.0, 0.15, 0.5, 1.5, 5.0)
# The largest of the trends is no chance any more from here on, in two of three fits.
_MAY_BE = 2.0
# Numbers that the first of the trends move, those along the speed: gains by a share, the others by the size itself.
_ALONG_SPEED = ((GAUGE_K_P.name, GAUGE_K_I.name), (T_D.name,), (C_SET.name,))
# So many deviations from what was known are no chance. That of the gauge's latency is known best: in 74 sound logs it
# was found within 1.5 of them, and dynamic inflow moves it first.
_PULLED, _PULLED_LATENCY = 4.0, 3.0
# A move is no smaller than this share of the speed, where its logarithm is taken.
_LEAST_SWING = 0.01
_GAINS, _LATENCY = "the gains of the governor", "the latency of the set point"
_RAMP = "a rate limit of the demand behind the lever, or a deadband of the governor"
# What goes with what, what does that, and the least of it that is worth a word.
_TRENDS = (
    (_GAINS, "hang on the speed", "a governor that takes its gains from a table over the speed", 0.04),
    ("the delay of the governor", "hangs on the speed", "an injection that counts in turns of the engine", 0.014),
    ("the scale of the lever", "hangs on the speed", "a lever whose line bends", 0.003),
    (_GAINS, "hang on the size of the move", _RAMP, 0.015),
    (_LATENCY, "hangs on the size of the move", _RAMP, 1.5e-3),
    (_GAINS, "hang on the direction of the move", "a smoke limiter, or a turbocharger that comes late", 0.008),
    (_LATENCY, "hangs on the direction of the move", "a rate limit that is another upwards than downwards", 1.5e-3),
)
_OTHER_WAY = "a ship at the quay or in shallow water, shafts that do not follow one lever, or a displacement far off"
# What of the vessel file may be contradicted, and what does that beside a wrong entry.
_STATED = {
    TAU_UP.name: ("inertia ahead of the gauge", "a rate limit of the demand, or a delay that hangs on the speed"),
    T_GAUGE.name: ("latency of the gauge", "dynamic inflow, or a filter in the channel of the torque"),
    C_SET.name: ("scale of the set point", "a set point that is not what the governor follows"),
    G.name: ("slope of the engine torque with speed", "an engine whose torque is limited at each speed"),
    A.name: ("slope of the thrust with the advance ratio", _OTHER_WAY),
    B.name: ("slope of the torque with the advance ratio", _OTHER_WAY),
    E.name: ("slope of the resistance", _OTHER_WAY),
    TAU_U.name: ("time of the ship", _OTHER_WAY),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Trend:
    """A number that the model has the same everywhere, and that goes with something."""

    what: str
    """The number."""
    along: str
    """What it hangs on, with the verb."""
    by: str
    """What does that."""
    size: float
    """Power with which it goes, or share by which it changes; of times seconds."""
    std: float
    """Its standard deviation."""
    gain: float
    """What twice the logarithm of the likelihood gains by it."""
    least: float
    """The least size that is worth a word."""

    @property
    def z(self) -> float:
        """Size over deviation."""
        return abs(self.size) / self.std

    @property
    def is_there(self) -> bool:
        """Whether it is no chance."""
        return self.z > _FAR or (self.z > _LIKELY and self.gain > _GAINS_MUCH)

    @property
    def words(self) -> str:
        """What goes with what."""
        return f"{self.what} {self.along} ({self.z:.0f} standard deviations), as with {self.by}"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Misfit:
    """What a fit leaves that is no noise."""

    speed: float
    """Mean square of what is left of the speed along the lever, over that of noise."""
    torque: float
    """The same of the torque."""
    chance: float
    """How often noise alone leaves as much of either."""
    gain: float
    """What twice the logarithm of the likelihood gains where both may follow the lever as they like."""
    hanging: float
    """How often noise alone makes all trends together as large as they are."""
    trends: tuple[Trend, ...]
    """What goes with what."""
    pulled: tuple[tuple[str, float], ...]
    """Numbers that the vessel file states, and how many deviations from there they are found."""
    spread: FloatArray
    """Covariance that the likeliest trend adds to the free numbers at the working point, shape (free, free)."""

    @property
    def reason(self) -> str:
        """What speaks against the model, the likeliest cause first; empty where nothing does."""
        # whether there is a cause the scatter says, which of them the likelihood
        worth = [one for one in self.trends if abs(one.size) > one.least]
        found = [(one.gain, one.words) for one in worth if one.is_there]
        if not found and worth and self.hanging < _CHANCE:
            found = [max((one.gain, one.words) for one in worth)]
        if self.chance < _CHANCE:
            follows = (
                f"what is left of the {'speed' if self.speed > self.torque else 'torque'} still follows the lever "
                f"({max(self.speed, self.torque):.0f} times as much as noise does), as with dynamic inflow, an elastic "
                "coupling, or a filter in a channel"
            )
            found.append((self.gain / _FREEDOM, follows))
        found += [
            (
                far**2,
                f"the {_STATED[name][0]} would be {abs(far):.0f} standard deviations "
                f"{'above' if far > 0.0 else 'below'} what is known of it, as with {_STATED[name][1]}",
            )
            for name, far in self.pulled
            if abs(far) > (_PULLED_LATENCY if name == T_GAUGE.name else _PULLED)
        ]
        return "; ".join(words for _, words in sorted(found, reverse=True)[:_MOST])


def misfit_of(
    runs: Sequence[Simulated], whitening: Whitening, model: ServiceModel, theta: FloatArray, prior: FloatArray
) -> Misfit:
    """Return what a fit leaves that is no noise.

    ``runs``: the segments that count beside their simulation at the greatest likelihood. ``whitening``: their noise.
    ``model``, ``theta``: the model and its free parameters there, shape (free,). ``prior``: curvature of what is known
    of them beforehand, shape (free, free).
    """
    levels = np.log([1.0 + float(np.mean(run.record.outputs["n"])) for run in runs])
    swings = np.log([max(float(np.ptp(run.record.drive["n_set"])), _LEAST_SWING) for run in runs])
    free = len(model.free)
    wide = [
        replace(run, slopes=np.concatenate([run.slopes, _trends(run, theta, level, swing), _answers(run)]))
        for run, level, swing in zip(runs, levels - levels.mean(), swings - swings.mean(), strict=True)
    ]
    each = scores(wide, whitening)
    slopes = np.array([one.slope for one in each])
    information = np.sum([one.information for one in each], axis=0)
    # what the free numbers, and what is known of them, take up
    taken = np.linalg.solve(information[:free, :free] + prior, information[:free, free:]).T
    beside = slopes[:, free:] - slopes[:, :free] @ taken.T
    total = beside.sum(axis=0) - taken @ prior @ (model.theta_known - theta)
    covariance = beside.T @ beside + taken @ prior @ taken.T
    count, lags = len(_TRENDS), len(_LAGS_S) - 1
    inner = information[free:, free:] - taken @ information[:free, free:]
    answers = slice(count, count + 2 * lags)
    hanging, speed, torque = (
        float(total[part] @ np.linalg.solve(covariance[part, part], total[part])) / (part.stop - part.start)
        for part in (slice(0, count), slice(count, count + lags), slice(count + lags, count + 2 * lags))
    )
    curvature, std = np.diag(inner), np.sqrt(np.diag(covariance))
    trends = tuple(
        Trend(
            what=what,
            along=along,
            by=by,
            least=least,
            gain=float(total[k] ** 2 / curvature[k]),
            size=float(total[k] / curvature[k]),
            std=float(std[k] / curvature[k]),
        )
        for k, (what, along, by, least) in enumerate(_TRENDS)
    )
    of_noise = np.linalg.inv(information[:free, :free] + prior)
    return Misfit(
        speed=speed,
        torque=torque,
        chance=min(2.0 * f_tail(max(speed, torque), float(lags), float(max(len(runs) - lags, 1))), 1.0),
        hanging=f_tail(hanging, float(count), float(max(len(runs) - count, 1))),
        trends=trends,
        gain=float(total[answers] @ np.linalg.solve(inner[answers, answers], total[answers])),
        pulled=tuple(_pulls(model, theta, of_noise)),
        spread=_spread(trends, taken[:count], theta, float(levels.mean())),
    )


def _spread(trends: Sequence[Trend], taken: FloatArray, theta: FloatArray, mean_level: float) -> FloatArray:
    """Return what a trend that is too small to be told may have done to the numbers, shape (free, free).

    ``taken``: what the free numbers take up of each trend, shape (trends, free). ``mean_level``: logarithm of the mean
    speed of the segments over that of the working point, for which the numbers are stated.
    """
    place, trend = max(enumerate(trends), key=lambda numbered: numbered[1].z)
    if trend.z < _MAY_BE:
        return np.zeros((theta.size, theta.size))
    own = np.zeros(theta.size)
    if place < len(_ALONG_SPEED):
        moving = [FREE.index(name) for name in _ALONG_SPEED[place]]
        own[moving] = theta[moving] if len(moving) > 1 else 1.0
    moved = trend.size * (-taken[place] - mean_level * own)
    # chance makes trends too: what is left of the square of the size
    return np.asarray((1.0 - trend.z**-2.0) * np.outer(moved, moved))


def _trends(run: Simulated, theta: FloatArray, level: float, swing: float) -> FloatArray:
    """Return what each trend adds to a segment for a size of one, shape (trends, samples, outputs).

    ``level``, ``swing``: logarithm of its speed and of the size of its move, less their means.
    """
    k_p, k_i, t_d, t_sp, scale = (FREE.index(one.name) for one in (GAUGE_K_P, GAUGE_K_I, T_D, T_SP, C_SET))
    gains = theta[k_p] * run.slopes[k_p] + theta[k_i] * run.slopes[k_i]
    drive = run.record.inputs["n_set"]
    up = float(np.sign(drive[-1] - drive[0]))
    late = run.slopes[t_sp]
    return np.stack(
        [
            level * gains,
            level * run.slopes[t_d],
            level * run.slopes[scale],
            swing * gains,
            swing * late,
            up * gains,
            up * late,
        ]
    )


def _answers(run: Simulated) -> FloatArray:
    """Return what follows the lever some time later, in the speed and in the torque, shape (columns, samples, outputs).

    Each is the change of the set point between two times ago: a mean between two lags of the answer to a step.
    """
    drive, rate_hz = run.record.inputs["n_set"], run.record.rate_hz
    samples = np.arange(drive.size)
    ago = [drive[np.maximum(samples - round(lag * rate_hz), 0)] for lag in _LAGS_S]
    changes = run.weight * -np.diff(ago, axis=0)
    columns = np.zeros((run.residuals.shape[1], *changes.shape, run.residuals.shape[1]))
    for output, own in enumerate(columns):
        own[:, :, output] = changes
    return columns.reshape(-1, *run.residuals.shape)


def _pulls(model: ServiceModel, theta: FloatArray, of_noise: FloatArray) -> Iterator[tuple[str, float]]:
    """Yield the numbers that the vessel file states, with the distance from there in standard deviations."""
    for name, prior_std in model.prior_std.items():
        place = model.free.index(name)
        prior = Prior(model.known[name], prior_std)
        yield name, from_prior(float(theta[place]), float(np.sqrt(of_noise[place, place])), prior)
