"""Numbers of limits in the units of the ship, and whether they may be trusted."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.digits import after_number
from shaftprint.distributions import NORMAL_95
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.limits._candidates import CANDIDATES, Kind, LimitCandidate
from shaftprint.limits._governor_fit import GOVERNOR, Fitted
from shaftprint.limits._level_profile import profile_interval
from shaftprint.limits._set_point_quantum import Quantum
from shaftprint.limits._uncertainty import LevelScatter
from shaftprint.limits.prediction._held_set_point import Messages
from shaftprint.limits.prediction._reach import Reach
from shaftprint.models._parameter import Parameter
from shaftprint.signals._signals import Signals
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel

# A number whose interval is wider than this share of it is hardly known.
HARDLY_KNOWN = 0.6
# Deviation of the set point's line at the working point, over its speed, up to which the search tells a line that rests
# at its torque limit from one that does not: of five recordings beyond it the level of three was wrong.
LARGEST_LINE_STD = 0.003
# A limit that gains less of twice the log-likelihood, and whose level is hardly known, may be noise that is not normal.
# Of twelve recordings without a limit two had such a one (gains of 36 and 61, intervals wider than three quarters of
# the level); of twenty-one with one none gained less than 445.
WEAK_GAIN = 100.0
# Share of its range by which a parameter of the governor may come near an end of it.
AT_END = 1e-3
# Torque limits below this share of the full-load curve are rather a lack of air than of fuel.
LEAST_SHARE = 0.8
# Of 17 simulated set points with a limited rate the rate came out 0.6 % high, 0.8 % in the root mean square, with
# noise of 0.4 %: between two samples of 12.5 Hz a governor already answers what disturbs the speed.
RAMP_STD = 7e-3


@dataclass(frozen=True, slots=True)
class Scale:
    """One way to print a parameter."""

    name: str
    """GovernorSymbol."""
    unit: str
    """Unit."""
    meaning: str
    """What it is."""
    factor: float = 1.0
    """Its value over that of the parameter."""
    share_std: float = 0.0
    """Standard deviation of the factor, as a share of it."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Units:
    """What turns normalised numbers into those of a ship."""

    brake_nm: float
    """Brake torque of the working point [N m]."""
    full: float
    """Full-load torque of the vessel file over it [-]."""
    speed_rpm: float
    """Engine speed of the working point [rpm]."""
    gauge_std: float
    """Standard deviation of the torque gauge's scale [-]."""

    @classmethod
    def of(cls, signals: Signals, vessel: Vessel) -> "Units":
        """Return the units of a test."""
        point = signals.working_point
        brake = point.shaft_torque_nm / vessel.gearbox.shaft_over_brake
        speed = rpm_from_rev_s(point.engine_speed_rev_s)
        curve = vessel.machine.full_load
        return cls(
            brake_nm=brake,
            full=float(np.interp(speed, *curve)) / brake,
            speed_rpm=speed,
            gauge_std=vessel.sensors.shaft_torque.scale_std_fraction or 0.0,
        )

    def scales(self, name: str) -> tuple[Scale, ...]:
        """Return the ways in which a parameter is printed, the clearest first."""
        gauge, brake, rpm = self.gauge_std, self.brake_nm, self.speed_rpm
        match name:
            case GovernorSymbol.TORQUE_LIMIT:
                return (
                    Scale(
                        "share",
                        "-",
                        "highest torque over the full-load curve of the vessel file",
                        1.0 / self.full,
                        gauge,
                    ),
                    Scale(name, "-", "the same over the brake torque of the working point"),
                    Scale("M_max", "N m", "the same at the working-point speed", brake, gauge),
                )
            case GovernorSymbol.MOTORING_LIMIT:
                return (
                    Scale(name, "-", "lowest brake torque over that of the working point"),
                    Scale("M_min", "N m", "torque of the motored engine", brake, gauge),
                )
            case GovernorSymbol.RACK_RATE:
                return (
                    Scale(name, "1/s", "fastest change of the rack over that of the working point"),
                    Scale("R_x", "N m/s", "the same as brake torque", brake, gauge),
                )
            case GovernorSymbol.SET_POINT_RATE:
                return (
                    Scale("r_s_rpm", "rpm/s", "fastest change of the set point", rpm, RAMP_STD),
                    Scale(name, "1/s", "the same over the speed of the working point", share_std=RAMP_STD),
                )
            case GovernorSymbol.DEADBAND:
                return (
                    Scale(
                        "d_e_rpm", "rpm", "speed error within which the governor does nothing, half of the band", rpm
                    ),
                    Scale(name, "-", "the same over the speed of the working point"),
                )
            case GovernorSymbol.UNBOOSTED_TORQUE:
                return (Scale(name, "-", "torque without boost over full-load torque"),)
            case GovernorSymbol.TURBOCHARGER_LAG:
                return (Scale(name, "s", "time in which the boost follows the torque"),)
            case _:
                return (Scale(name, "s", "time in which the integrator is led back at a limit"),)


def numbers_of(
    fit: Fitted, spread: LevelScatter, units: Units, reach: Reach, *, say: Callable[[str], None]
) -> tuple[Estimate, ...]:
    """Return the numbers of all limits, with profile intervals; ``say`` is told which."""
    of_governor = doubt_of_governor(fit)
    by_kind = {candidate.kind: candidate for candidate in CANDIDATES}
    done = set[str]()
    rows: list[Estimate] = []
    for kind in fit.kinds:
        if kind is Kind.HELD and fit.messages is not None:
            rows.append(_doubted(_cycle(fit.messages), of_governor))
            continue
        passed = doubt_of_passed(kind, fit, reach)
        for name in (by_kind[kind].level, *by_kind[kind].companions):
            if name not in done:
                done.add(name)
                say(f"{kind.value}, {name}")
                rows += [_doubted(one, of_governor or passed) for one in _printed(fit, spread, units, kind, name)]
    return tuple(rows)


def hardly_seen(numbers: Sequence[Estimate], gains: Mapping[Kind, float]) -> Mapping[Kind, str]:
    """Return the limits that gain too little for a level that is hardly known, in words: they are not named.

    Messages are not among them: of those few jumps tell, and noise that is not normal makes none.
    """
    words: dict[Kind, str] = {}
    for number in reversed(numbers):
        kind = Kind(number.limit)
        lower, upper = number.interval_95 or (-math.inf, math.inf)
        # the first number of a limit is its level
        words.pop(kind, None)
        if kind is not Kind.HELD and gains[kind] < WEAK_GAIN and not upper - lower <= HARDLY_KNOWN * abs(number.value):
            words[kind] = (
                f"{kind.value}: perhaps, but noise may look alike ({number.name} = {number.value:.3g}, hardly known); "
                "a test with larger moves tells"
            )
    return words


def _doubted(number: Estimate, doubt: str) -> Estimate:
    """Return a number with a doubt that goes before its own; as it is where there is none."""
    return replace(number, doubt=doubt) if doubt else number


def doubt_of_line(fit: Fitted) -> str:
    """Return why numbers that hang on the line of the set point are not trusted; nothing where they are."""
    line_std = fit.priors[GovernorSymbol.SET_POINT_OFFSET].std
    if line_std > LARGEST_LINE_STD:
        return (
            "the speed fell behind the set point so often that their line is known to "
            f"{100.0 * line_std:.2g} % only, and the likelihood may have a second optimum at another line: test again "
            "with smaller sines"
        )
    offset = fit.values[GovernorSymbol.SET_POINT_OFFSET]
    if abs(offset) > LARGEST_LINE_STD:
        return (
            f"the fit moves the line of the set point by {100.0 * offset:+.2g} % of the speed, as where the speed "
            "falls behind it at a limit: test again with smaller sines"
        )
    return ""


def doubt_of_governor(fit: Fitted) -> str:
    """Return why no number beside a governor is trusted; nothing where they may be."""
    at_bounds = [p.name for p in fit.term.structure.free if p.name in GOVERNOR and _is_at_bound(p, fit.values[p.name])]
    if not at_bounds:
        return ""
    return (
        f"the governor beside it stands at the end of its range ({', '.join(at_bounds)}): it makes up for a limit of "
        "another kind"
    )


def _is_at_bound(parameter: Parameter, value: float) -> bool:
    """Return whether a parameter is within a thousandth of its range of an end of it."""
    near = AT_END * (parameter.upper - parameter.lower)
    return value <= parameter.lower + near or value >= parameter.upper - near


def doubt_of_passed(kind: Kind, fit: Fitted, reach: Reach) -> str:
    """Return that a test itself passed a limit; nothing where it did not."""
    if not reach.passes(kind, fit.values):
        return ""
    return "the test itself passed it: what was measured there contradicts the level"


def _below_the_curve(kind: Kind, values: Mapping[str, float], units: Units) -> str:
    """Return that a torque limit is far below the full-load curve; nothing where it is not."""
    share = values[GovernorSymbol.TORQUE_LIMIT] / units.full
    if kind is not Kind.TORQUE or share >= LEAST_SHARE:
        return ""
    return (
        f"it is {100.0 * (1.0 - share):.0f} % below the full-load curve of the vessel file: a smoke limit that acts "
        "for seconds looks alike, where the curve is right"
    )


def _printed(fit: Fitted, spread: LevelScatter, units: Units, kind: Kind, name: str) -> Iterator[Estimate]:
    parameter = next(p for p in fit.term.structure.free if p.name == name)
    value = fit.values[name]
    at_bound = value in (parameter.lower, parameter.upper)
    interval = profile_interval(fit, spread, name)
    doubt = _doubt(value, interval, at_bound=at_bound)
    if kind in (Kind.TORQUE, Kind.SMOKE):
        doubt = doubt or doubt_of_line(fit) or _below_the_curve(kind, fit.values, units)
    for scale in units.scales(name):
        more = NORMAL_95 * scale.share_std * abs(value)
        lower, upper = (_widened(value, end, more) for end in (interval.lower, interval.upper))
        yield Estimate(
            limit=kind.value,
            name=scale.name,
            unit=scale.unit,
            value=scale.factor * value,
            std=scale.factor * float(np.hypot(spread.std(name), scale.share_std * value)),
            interval_95=(
                -math.inf if interval.lower_open else scale.factor * lower,
                math.inf if interval.upper_open else scale.factor * upper,
            ),
            interval_open=(interval.lower_open, interval.upper_open),
            meaning=scale.meaning,
            at_bound=at_bound,
            doubt=doubt,
        )


def _cycle(messages: Messages) -> Estimate:
    """Return the cycle of the messages between which the set point is held."""
    lower, value, upper = (messages.quantile(share) for share in (0.025, 0.5, 0.975))
    meaning = "time from one message with the set point to the next, the last one held between them"
    return _of_set_point(
        Kind.HELD, Scale("T_set", "s", meaning), (lower, value, upper), 0.5 * (upper - lower) / NORMAL_95
    )


def quantum_number(quantum: Quantum, units: Units, fit: Fitted) -> Estimate:
    """Return the step of a quantised set point, beside a governor."""
    value, std = units.speed_rpm * quantum.step, units.speed_rpm * quantum.std
    ends = (value - NORMAL_95 * std, value, value + NORMAL_95 * std)
    doubt = doubt_of_governor(fit) or ("" if quantum.is_only_one else "another step explains the test nearly as well")
    return _of_set_point(Kind.QUANTUM, Scale("q_rpm", "rpm", "step of the set point"), ends, std, doubt=doubt)


def _of_set_point(
    kind: Kind, scale: Scale, ends: tuple[float, float, float], std: float, *, doubt: str = ""
) -> Estimate:
    """Return a number of the set point, from lower end, value and upper end; it has no parameter of the governor."""
    lower, value, upper = ends
    interval = Interval(name=scale.name, lower=lower, upper=upper, lower_open=False, upper_open=False)
    return Estimate(
        limit=kind.value,
        name=scale.name,
        unit=scale.unit,
        value=value,
        std=std,
        interval_95=(lower, upper),
        meaning=scale.meaning,
        doubt=_doubt(value, interval, at_bound=False) or doubt,
    )


def _widened(value: float, end: float, more: float) -> float:
    """Return the end of an interval further out by another independent cause."""
    return value + float(np.sign(end - value) * np.hypot(end - value, more))


def _doubt(value: float, interval: Interval, *, at_bound: bool) -> str:
    """Return why a number is not trusted; nothing where it is."""
    if at_bound:
        return "at its bound: the search stopped there"
    if interval.lower_open or interval.upper_open:
        side = "lower" if interval.lower_open else "upper"
        return f"the data set no {side} end"
    if interval.upper - interval.lower > HARDLY_KNOWN * abs(value):
        return "hardly known: the interval is wider than 60 % of the value"
    return ""


def exclusion(candidate: LimitCandidate, level: float | None, units: Units) -> str:
    """Return up to which level the data exclude a limit, in words."""
    if level is None:
        return f"{candidate.kind.value}: not seen, and no level of it is excluded"
    scale = units.scales(candidate.level)[0]
    side = {
        Kind.TORQUE: "none below",
        Kind.MOTORING: "none above",
        Kind.RATE: "none slower than",
        Kind.RAMP: "none slower than",
        Kind.DEADBAND: "none wider than",
        Kind.SMOKE: "none below",
    }[candidate.kind]
    unit = after_number(scale.unit)
    return f"{candidate.kind.value}: not seen, {side} {scale.name} = {scale.factor * level:.3g}{unit}"


def reached(reach: Reach, units: Units) -> str:
    """Return what a test reached, in words."""
    return (
        f"It took the engine to {100.0 * reach.highest / units.full:.0f} % of the full-load curve and down to a torque "
        f"of {100.0 * reach.lowest:.0f} % of the working point's, half a second each, and the speed followed a set "
        f"point of at least {units.speed_rpm * reach.set_point_rate_per_s:.0f} rpm/s."
    )


def messages_exclusion(cycle_s: float | None) -> str:
    """Return up to which cycle of messages the jumps exclude a held set point, in words."""
    if cycle_s is None:
        return f"{Kind.HELD.value}: not seen, and no cycle of it is excluded"
    return f"{Kind.HELD.value}: not seen, none longer than T_set = {cycle_s:.3g} s"


def quantum_exclusion(quantum: Quantum | None, units: Units) -> str:
    """Return up to which step the sines exclude a quantised set point, in words."""
    if quantum is None or quantum.excluded_beyond is None:
        return f"{Kind.QUANTUM.value}: not seen, and no step of it is excluded"
    return (
        f"{Kind.QUANTUM.value}: not seen, none coarser than q_rpm = {units.speed_rpm * quantum.excluded_beyond:.3g} rpm"
    )
