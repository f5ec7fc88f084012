r"""Whether a line changes from day to day, along what may have changed, against an earlier fingerprint.

The slopes of the likelihood at that fingerprint tell it, without a fit: with its own error ``e``, which all days share,
and a change of size ``s`` along a direction ``v`` from some day on, a day has

    g = H (e + s v) + noise

``e`` has the covariance that the fingerprint states and is found from all days together, so that a valley that the
fingerprint leaves open is no change. The noise is as large as the segments scatter, never less than they state, and
each day has a share beside that which no length takes away. What the vessel file knows is as wrong on all days, and
cancels. The scale of the lever is each day's own.

A change counts that began one, two, four ... days ago. Whoever looks every day looks often: the limit is that which the
largest score of an unchanged line passes as often in a year as is asked for, drawn with the curvature of these days.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import C_SET, T_D, T_SP
from shaftprint.drift._causes import CAUSES, GAUGE, Cause, by_role
from shaftprint.drift._words import ALIKE
from shaftprint.errors import ServiceError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.service._day_folder import Day, read_day
from shaftprint.service._model import OVER_TORQUE, ServiceModel, service_model

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

DAYS_A_YEAR = 365
"""Days that are looked at in a year."""
WINDOWS = (1, 2, 4, 8, 16, 32, 64)
"""Days ago at which a change may have begun."""
_DRAWS = 200
# Share and time that a day differs by whatever its length: what was left of the errors in many simulated hours.
_FLOOR, _FLOOR_S = 0.003, 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Along:
    """A change along one cause."""

    cause: Cause
    """What may have changed."""
    size: float
    """By how much: a share, or a time [s]."""
    std: float
    """Its standard deviation."""
    gain: float
    """What twice the logarithm of the likelihood gains by it."""
    days: int
    """How many days ago it began."""

    @property
    def z(self) -> float:
        """Size over deviation."""
        return self.size / self.std


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Watch:
    """What days of service tell against a fingerprint."""

    days: tuple[str, ...]
    """Their names, in order of time."""
    causes: tuple[Along, ...]
    """The largest change along each cause, as seen from the last day; the likeliest first."""
    limit: float
    """Score beyond which a change is alarming."""
    a_year: float
    """How often an unchanged line does that in a year."""
    first: str | None
    """Name of the first day that gave an alarm; None where no day did."""
    propeller: str = ""
    """What the torque of the propeller does, in a sentence; it gives no alarm."""

    @property
    def is_alarm(self) -> bool:
        """Whether the last day gives an alarm."""
        return max(abs(one.z) for one in self.causes) > self.limit

    @property
    def headline(self) -> str:
        """Whether the line has changed, in one sentence."""
        if not self.is_alarm:
            seen = f" An earlier day gave an alarm: {self.first}." if self.first else ""
            return (
                f"No change is seen in {len(self.days)} day{'s' if len(self.days) > 1 else ''} of service; the largest "
                f"score is {max(abs(one.z) for one in self.causes):.1f}, and {self.limit:.1f} counts.{seen}"
            )
        best = self.causes[0]
        # causes are told apart by the likelihood, which is worth less where segments scatter more than they state
        wide = max(best.gain / best.z**2, 1.0)
        alike = [one for one in self.causes[1:] if best.gain - one.gain < 2.0 * np.log(ALIKE) * wide]
        words = ", or ".join(_words(one) for one in (best, *alike))
        since = self.days[-best.days]
        return f"The line has changed since {since}: {words}."


def _words(one: Along) -> str:
    size, std = (one.cause.in_unit(x) for x in (one.size, one.std))
    return f"{one.cause.more if size > 0.0 else one.cause.less}, by {abs(size):.2g} +/- {std:.1g} {one.cause.unit}"


def directions(model: ServiceModel) -> dict[Cause, FloatArray]:
    """Return the causes that service can see, and how the parameters move for one unit of each, shape (free,)."""
    roles = {one.name: one.role for one in model.structure.parameters if one.name in model.free}
    found: dict[Cause, FloatArray] = {}
    theta = model.theta
    for cause in CAUSES:
        names = by_role(cause, roles)
        if names:
            found[cause] = np.array(
                [
                    (value if cause.is_share else 1.0) * (name in names)
                    for name, value in zip(model.free, theta, strict=True)
                ]
            )
    found[GAUGE] = np.array([value * (name in OVER_TORQUE) for name, value in zip(model.free, theta, strict=True)])
    return found


@refusing_none(ServiceError)
def watch_folders(
    folders: Sequence[str | Path], vessel: "Vessel", fingerprint: Fingerprint, *, a_year: float = 1.0
) -> Watch:
    """Say whether a line changes, from the folders of its days of service.

    Parameters
    ----------
    folders
        Folders of ``shaftprint service fit --fingerprint``, in order of time.
    vessel
        The installation.
    fingerprint
        The one from which the days were fitted.
    a_year
        How many alarms a year an unchanged line may give.

    Raises
    ------
    ServiceError
        If a folder is no day, one is held against another fingerprint, or is what the fingerprint was made of.
    """
    days = [read_day(Path(folder)) for folder in folders]
    own = {one.sha256 for one in fingerprint.sources}
    for day in days:
        if any(one.sha256 in own for one in day.fingerprint.sources):
            raise ServiceError(
                f"{day.name}: expected a day that is not in the fingerprint of --against, found one that it was made "
                "of; what it tells would count twice: leave that day out."
            )
    model = service_model(vessel, fingerprint)
    if model.covariance is None:
        raise ServiceError(
            f"--against: expected a fingerprint of {', '.join(model.free)} with their covariance, as service fit "
            f"writes it, found one of {fingerprint.structure} without."
        )
    found = watch_days(days, model, model.covariance, a_year=a_year)
    return replace(found, propeller=_propeller(days, fingerprint))


def _propeller(days: Sequence[Day], fingerprint: Fingerprint) -> str:
    """Return what the torque of the propeller does: draught, trim and water move it more than fouling."""
    was, now = fingerprint.quantity("K_Q"), days[-1].fingerprint.quantity("K_Q")
    if not was.value:
        return ""
    share = 100.0 * (now.value / was.value - 1.0)
    return (
        f"The propeller took {abs(share):.1f} % {'more' if share > 0.0 else 'less'} torque at the same speed on "
        f"{days[-1].name}; draught, trim, berth and water do that too, so that it gives no alarm."
    )


def prior_information(covariance: FloatArray) -> FloatArray:
    """Return the inverse covariance of the fingerprint's error, shape (numbers, numbers).

    ``covariance``: that of the fingerprint at the model's working point, shape (numbers, numbers). Raises ServiceError
    if a number has no deviation.
    """
    size = np.sqrt(np.diag(covariance))
    if not np.all(size > 0.0):
        raise ServiceError(
            "service watch: expected a fingerprint whose numbers have deviations, found one that was held; identify it "
            "with all of them free."
        )
    scaled = np.linalg.inv(covariance / np.outer(size, size))
    return np.asarray(scaled / np.outer(size, size), dtype=np.float64)


def watch_days(
    days: Sequence[Day], model: ServiceModel, covariance: FloatArray, *, a_year: float = 1.0, seed: int = 1
) -> Watch:
    """Return whether a line changes.

    ``days``: in order of time, all held against one fingerprint. ``model``: the model at its values. ``covariance``: of
    its free parameters, shape (free, free). ``a_year``: how many alarms a year an unchanged line may give. ``seed``: of
    the drawn years. Raises ServiceError if there is no day, or one is held against another fingerprint.
    """
    if not days:
        raise ServiceError("service watch: expected at least one day, found none.")
    for day in days:
        if not np.allclose(day.theta, model.theta, rtol=1e-6, atol=1e-9):
            raise ServiceError(
                f"{day.name}: expected a day that was fitted from the fingerprint of --against, found one that began "
                "from other values; fit it again with that --fingerprint."
            )
    causes = directions(model)
    series = _Series.of(days, model, covariance, np.stack(list(causes.values())))
    limit = _limit(series, a_year, np.random.default_rng(seed))
    first = None
    scores: dict[int, list[tuple[float, float, float]]] = {}
    for day, scores in zip(days, series.scores(), strict=True):
        if first is None and max(abs(size / std) for one in scores.values() for size, std, _ in one) > limit:
            first = day.name
    found = [
        max(
            (
                Along(cause=cause, size=sizes[k][0], std=sizes[k][1], gain=sizes[k][2], days=window)
                for window, sizes in scores.items()
            ),
            key=lambda one: one.gain,
        )
        for k, cause in enumerate(causes)
    ]
    return Watch(
        days=tuple(day.name for day in days),
        causes=tuple(sorted(found, key=lambda one: -one.gain)),
        limit=limit,
        a_year=a_year,
        first=first,
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Sums:
    """What days tell together, so that more of them cost no more: sums over days and over their segments.

    A pair of slope ``g`` and curvature ``H`` of each segment enters as ``sum (g s - s^T H a)^2``, for which these are
    enough whatever ``s`` and ``a``.
    """

    slope: FloatArray
    """Sum of the slopes, shape (free,)."""
    information: FloatArray
    """Sum of the curvature, shape (free, free)."""
    slopes: FloatArray
    """Sum over segments of ``g g^T``, shape (free, free)."""
    mixed: FloatArray
    """Sum over segments of ``g vec(H)^T``, shape (free, free^2)."""
    curvatures: FloatArray
    """Sum over segments of ``vec(H) vec(H)^T``, shape (free^2, free^2)."""
    of_days: FloatArray
    """The same of the days, shape (free^2, free^2)."""

    @classmethod
    def of(cls, slopes: FloatArray, each: FloatArray, information: FloatArray) -> "_Sums":
        """Return the sums of one day: slopes (segments, free), curvature of each, and of all of them."""
        flat, total = each.reshape(len(each), -1), information.reshape(-1)
        return cls(
            slope=slopes.sum(axis=0), information=information, slopes=slopes.T @ slopes, mixed=slopes.T @ flat,
            curvatures=flat.T @ flat, of_days=np.outer(total, total),
        )  # fmt: skip

    def changed(self, by: "_Sums", sign: float) -> "_Sums":
        """Return these sums with those of other days added or taken off."""
        parts = {one.name: getattr(self, one.name) + sign * getattr(by, one.name) for one in fields(self)}
        return _Sums(**parts)

    def scatter(self, seen: FloatArray, change: FloatArray) -> float:
        """Return the sum over segments of ``(g s - s^T H a)^2`` for ``s`` seen and ``a`` a change.

        A segment's own ``H`` is not symmetric where the scale of the lever is taken out by the share of its day.
        """
        outer = np.outer(seen, change).reshape(-1)
        return float(seen @ self.slopes @ seen - 2.0 * (seen @ self.mixed @ outer) + outer @ self.curvatures @ outer)

    def per_day(self, seen: FloatArray, direction: FloatArray) -> float:
        """Return the sum over days of ``(s^T H v)^2``."""
        outer = np.outer(seen, direction).reshape(-1)
        return float(outer @ self.of_days @ outer)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Series:
    """Days as sums, with what each segment adds."""

    days: list[_Sums]
    """What each day tells."""
    prior: FloatArray
    """Inverse covariance of the error of the fingerprint, shape (free, free)."""
    directions: FloatArray
    """One direction a row, shape (causes, free)."""
    floor: FloatArray
    """Deviation of a day along each direction that no length takes away, shape (causes,)."""

    @classmethod
    def of(cls, days: Sequence[Day], model: ServiceModel, covariance: FloatArray, moved: FloatArray) -> "_Series":
        """Return days with the scale of the lever projected out of each."""
        scale = model.free.index(C_SET.name)
        rest = np.arange(len(model.free)) != scale
        sums = []
        for day in days:
            total = day.information.sum(axis=0)
            share = total[:, scale] / (total[scale, scale] + 1.0 / model.prior_std[C_SET.name] ** 2)
            slopes = (day.slopes - np.outer(day.slopes[:, scale], share))[:, rest]
            own = day.information - share[None, :, None] * day.information[:, scale][:, None, :]
            information = (total - np.outer(share, total[scale]))[np.ix_(rest, rest)]
            sums.append(_Sums.of(slopes, own[:, rest][:, :, rest], information))
        times = [model.free.index(name) for name in (T_D.name, T_SP.name)]
        is_time = np.array([bool(one[times].any()) and np.count_nonzero(one) == 1 for one in moved])
        return cls(
            days=sums,
            prior=prior_information(covariance[np.ix_(rest, rest)]),
            directions=moved[:, rest],
            floor=np.where(is_time, _FLOOR_S, _FLOOR),
        )

    @property
    def usual(self) -> FloatArray:
        """Mean curvature of a day, shape (free, free)."""
        return np.asarray(np.mean([one.information for one in self.days], axis=0))

    def scores(self) -> Iterator[dict[int, list[tuple[float, float, float]]]]:
        """Yield for each day size, deviation and gain of likelihood along each cause, by how many days ago it began."""
        free = len(self.prior)
        nothing = _Sums.of(np.zeros((1, free)), np.zeros((1, free, free)), np.zeros((free, free)))
        # sums up to each of the days at which a change may have begun
        upto: deque[_Sums] = deque([nothing], maxlen=max(WINDOWS) + 1)
        for number, day in enumerate(self.days, start=1):
            upto.append(upto[-1].changed(day, 1.0))
            own: FloatArray = np.linalg.inv(self.prior + upto[-1].information).astype(np.float64)
            yield {
                window: self._along(upto[-1 - window], upto[-1].changed(upto[-1 - window], -1.0), own)
                for window in _windows(number)
            }

    def _along(self, before: _Sums, after: _Sums, own: FloatArray) -> list[tuple[float, float, float]]:
        """Return size, deviation and gain of a change between two parts of the days, along each cause."""
        error = own @ (before.slope + after.slope)
        sizes = []
        for k, direction in enumerate(self.directions):
            beside = own @ (after.information @ direction)
            curvature = float(direction @ after.information @ direction - (after.information @ direction) @ beside)
            score = float(after.slope @ direction - (before.slope + after.slope) @ beside)
            size = score / curvature
            left = error - size * beside
            variance = float(beside @ self.prior @ beside)
            per_day = 0.0
            for part, moved, seen in (
                (before, left, -beside), (after, left + size * direction, direction - beside),
            ):  # fmt: skip
                variance += part.scatter(seen, moved)
                per_day += part.per_day(seen, direction)
            variance = max(variance, curvature) + self.floor[k] ** 2 * per_day
            sizes.append((size, float(np.sqrt(variance)) / curvature, score**2 / curvature))
        return sizes


def _windows(upto: int) -> list[int]:
    """Return days ago at which a change may have begun: the first day too."""
    return sorted({*(one for one in WINDOWS if one < upto), upto} if upto <= WINDOWS[-1] else WINDOWS)


def _limit(series: _Series, a_year: float, rng: np.random.Generator) -> float:
    """Return the score that an unchanged line passes so often in a year, drawn with days such as these."""
    usual = series.usual
    root = np.linalg.cholesky(usual + 1e-12 * np.diag(np.diag(usual)))
    free = len(usual)
    error = np.linalg.cholesky(np.linalg.inv(series.prior)) @ rng.standard_normal((free, _DRAWS))
    slopes = root @ rng.standard_normal((DAYS_A_YEAR, free, _DRAWS)) + usual @ error
    sums = np.concatenate([np.zeros((1, free, _DRAWS)), np.cumsum(slopes, axis=0)])
    largest = np.zeros((DAYS_A_YEAR, _DRAWS))
    for upto in range(1, DAYS_A_YEAR + 1):
        own = np.linalg.inv(series.prior + upto * usual)
        for window in _windows(upto):
            moved = window * usual @ series.directions.T
            beside = own @ moved
            curvature = np.sum(series.directions.T * moved, axis=0) - np.sum(moved * beside, axis=0)
            score = series.directions @ (sums[upto] - sums[upto - window]) - beside.T @ sums[upto]
            z = np.abs(score) / np.sqrt(np.maximum(curvature, 1e-300))[:, None]
            largest[upto - 1] = np.maximum(largest[upto - 1], z.max(axis=0))
    # an alarm is a day beyond the limit after one that was not
    for limit in np.arange(2.0, 8.0, 0.05):
        beyond = largest > limit
        alarms = beyond[0].sum() + np.count_nonzero(beyond[1:] & ~beyond[:-1])
        if alarms / _DRAWS <= a_year:
            return float(limit)
    return 8.0
