"""Which limits act: one after the other they join the governor, as long as chance does not explain the gain."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations

import numpy as np

from shaftprint.arrays import BoolArray, frozen_bool
from shaftprint.campaign import Campaign
from shaftprint.catalogue import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior
from shaftprint.limits._candidates import CANDIDATES, IDLE, Kind, LimitCandidate, parameters_of, starts_of
from shaftprint.limits._governor_fit import GOVERNOR, NEGLIGIBLE_FALL, Fitted, fitted, schwarz, values_without_limits
from shaftprint.limits.prediction import OUTPUT, GovernorRecord, GovernorTest, Messages, messages_of
from shaftprint.models import Structure

# Gain of twice the log-likelihood over what Schwarz' criterion asks that a limit must bring to be named.
LEAST_GAIN = 25.0
FAST = (
    GovernorSymbol.LOOP_DELAY,
    GovernorSymbol.ACTUATOR_FREQUENCY,
    GovernorSymbol.ACTUATOR_DAMPING,
    GovernorSymbol.SET_POINT_LATENCY,
)
"""What slow sines tell too little of."""
ENGINE_LIMITS = (Kind.TORQUE, Kind.MOTORING)
"""What every engine has: a highest torque, and one below which it cannot brake."""
MOST_LIMITS = 4
# Candidates of a round that are fitted.
POLISHED, POLISHED_CALM = 2, 4
# Most iterations of a fit that is compared with others, and the fall of minus twice the log-likelihood that is not
# worth one: limits are told apart by falls of tens.
ROUGH, ROUGH_FALL = 12, 0.2
# Share of the tests, the calmest first, whose torque changes so little that no limit is near.
CALM = 0.5
# Most pushed fits come back to where they were: they end sooner, and go on only where they came lower.
PUSH_S, LEAST_FALL, PUSH_FALL = 0.03, 0.5, 1.0
# The push of the set point's offset, over its deviation, and of the level of a torque limit with it.
REST_PUSH, LEVEL_SHARES = 1.0, (0.8, 0.9, 1.0, 1.1, 1.2, 1.35)
# A torque limit above this, over the torque of the working point, is none that the line rests near.
NEAR_REST = 2.0
# Gain of held messages, to first order, from which on they are fitted; rounds in which delays and governor follow.
PROMISING, ROUNDS = 10.0, 3
LEAST_SPEED = 0.1
SMALLEST = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True)
class Scanned:
    """One level of a candidate, the governor following to first order."""

    candidate: LimitCandidate
    """The candidate."""
    start: Mapping[str, float]
    """Every parameter, with its level."""
    gain: float
    """Fall of minus twice the log-likelihood; negative where the level contradicts the data."""


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Search:
    """A search for limits, and what it always needs."""

    whole: Structure
    """The governor with all limits."""
    test: GovernorTest
    """The test."""
    record: GovernorRecord
    """Its record, the set point not held: most fits begin with it."""
    drive_hz: float
    """Samples of its drive a second [Hz]."""
    full: float
    """Full-load torque of the vessel file over the brake torque of the working point."""
    priors: Mapping[str, Prior]
    """What is known of the set point's scale and offset."""
    say: Callable[[str], None]
    """Is told what is being tried."""
    calm: Mapping[str, float]
    """Governor of the calm part of the test.

    A governor without limits that has to explain limited steps is too slow to reach the limit, and hides it.
    """

    @classmethod
    def of(
        cls,
        whole: Structure,
        test: GovernorTest,
        campaign: Campaign,
        *,
        drive_hz: float,
        full: float,
        priors: Mapping[str, Prior],
        say: Callable[[str], None],
    ) -> "Search":
        """Return a search, its calm governor found."""
        say("the calm part of the test")
        start, record = values_without_limits(whole), test.record(drive_hz=drive_hz)
        calm = fitted(
            whole,
            calm_part(record, campaign),
            start,
            (),
            priors=priors,
            iterations=ROUGH,
            negligible=ROUGH_FALL,
            held=FAST,
        )
        return cls(
            whole=whole,
            test=test,
            record=record,
            drive_hz=drive_hz,
            full=full,
            priors=priors,
            say=say,
            calm={name: calm.values[name] for name in GOVERNOR},
        )

    def linear(self) -> Fitted:
        """Return the best governor without limits."""
        here = self.fit({**values_without_limits(self.whole), **self.calm}, ())
        return self._pushed(here, _delay_moves(here))

    def run(self) -> tuple[Fitted, list[Scanned]]:
        """Let limits join the governor until chance explains what the next one would gain.

        Returns
        -------
        The governor with its limits, and the levels of those that did not join, tried at the end.
        """
        here = linear = self.linear()
        engine_alone = False
        while True:
            scans = self.scanned(here)
            tries = [self._joined(here, scans), self.held(here)] if len(here.kinds) < MOST_LIMITS else []
            better = min((one for one in tries if one is not None), key=schwarz, default=here)
            if schwarz(here) - schwarz(better) > LEAST_GAIN:
                here = self._without_idle(better, better.kinds[:-1])
                continue
            other = self._pushed(here, self._rest_moves(here))
            if other is here and not engine_alone:
                engine_alone, other = True, self._engine_limits_or(here, linear)
            if other is here:
                return self.fit(here.values, here.kinds, here.messages, negligible=NEGLIGIBLE_FALL), scans
            here = other

    def scanned(self, here: Fitted) -> list[Scanned]:
        """Return what each level of each limit that is not present would gain over a governor."""
        return self._scan_from(here, here.values)

    def _scan_from(self, here: Fitted, base: Mapping[str, float]) -> list[Scanned]:
        """Return the gains, the governor following to first order from some values."""
        term = here.term
        base_values = np.array([base[name] for name in self.whole.names])
        rows, now, best = term.rows(base_values), term.innovations(base_values), term.innovations(here.own)
        if rows is None or now is None or best is None:
            raise IdentificationError(f"{term.name}: the simulation runs away where it was fitted.")
        basis, _ = np.linalg.qr(rows[1:].T)
        simulated = term.predicted(base_values)
        speed = term.record.decimator.thinned(term.record.drive["n"][:, None])[:, 0]
        load = np.maximum(1.0 + speed, LEAST_SPEED) ** 2
        scans = []
        for candidate in CANDIDATES:
            if candidate.kind in here.kinds or (candidate.kind is Kind.TORQUE and Kind.SMOKE in here.kinds):
                continue
            for start in starts_of(candidate, base, (1.0 + simulated) * load, self.full):
                values = {**base, **start}
                there = term.predicted(np.array([values[name] for name in self.whole.names]))
                moved = now.values + now.filtered((simulated - there)[None])[0]
                moved = moved - basis @ (basis.T @ moved)
                squares = max(float(moved @ moved), SMALLEST)
                gain = best.count * float(np.log(best.squares / squares)) if np.isfinite(squares) else -np.inf
                scans.append(Scanned(candidate=candidate, start={**base, **start}, gain=gain))
        return scans

    def _joined(self, here: Fitted, scanned: Sequence[Scanned]) -> Fitted | None:
        """Return the governor with the one more limit that gains most; None where there is none to try."""
        starts = _strongest(scanned, POLISHED)
        if not here.kinds:
            calm = {**here.values, **self.calm}
            starts += _strongest(self._scan_from(here, calm), POLISHED_CALM)
        tries = [self._tried(one.start, (*here.kinds, one.candidate.kind), here.messages) for one in starts]
        best = min((one for one in tries if one is not None), key=schwarz, default=None)
        if best is None:
            return None
        if Kind.SMOKE in best.kinds and Kind.SMOKE not in here.kinds:
            best = self._torque_limit_or(best, scanned)
        return self._pushed(best, _delay_moves(best))

    def _torque_limit_or(self, smoke: Fitted, scanned: Sequence[Scanned]) -> Fitted:
        """Return a torque limit alone where a smoke limit gains hardly more than chance over it.

        Of a line that rests near its torque limit the wrong one of two optima is worse than any smoke limit.
        """
        starts = _strongest([one for one in scanned if one.candidate.kind is Kind.TORQUE], 1)
        kinds = tuple(Kind.TORQUE if kind is Kind.SMOKE else kind for kind in smoke.kinds)
        tries = [self._tried(one.start, kinds, smoke.messages) for one in starts]
        torque = next((self._pushed(one, self._rest_moves(one)) for one in tries if one is not None), smoke)
        return torque if schwarz(torque) - schwarz(smoke) < LEAST_GAIN else smoke

    def held(self, here: Fitted) -> Fitted | None:
        """Return the governor with a set point that is held between messages; None where the jumps speak against it."""
        test, kinds = self.test, (*here.kinds, Kind.HELD)
        if Kind.HELD in here.kinds:
            return None
        for _ in range(ROUNDS):
            messages = messages_of(here.term, here.own, test, here.known)
            if messages is None or messages.gain < PROMISING:
                return None
            test = with_messages(self.test, messages)
            here = self.fit(here.values, kinds, messages)
        return here

    def messages(self, here: Fitted) -> Messages | None:
        """Return what the jumps tell of messages, to first order; None where they are too few."""
        return here.messages or messages_of(here.term, here.own, self.test, here.known)

    def without(self, here: Fitted, gone: Sequence[Kind]) -> Fitted:
        """Return the best governor without some of its limits."""
        kinds = tuple(kind for kind in here.kinds if kind not in gone)
        idle = {name: IDLE[name] for name in set(parameters_of(gone)) - set(parameters_of(kinds))}
        return self.fit({**here.values, **idle}, kinds, here.messages if Kind.HELD in kinds else None)

    def _without_idle(self, here: Fitted, kinds: Sequence[Kind]) -> Fitted:
        """Return the governor without those of some limits that the others have made idle, alone or together."""
        for gone in chain.from_iterable(combinations(kinds, count + 1) for count in range(len(kinds))):
            without = self.without(here, gone)
            if schwarz(without) - schwarz(here) < LEAST_GAIN:
                return self._without_idle(without, [kind for kind in kinds if kind not in gone])
        return here

    def _engine_limits_or(self, here: Fitted, linear: Fitted) -> Fitted:
        """Return the governor with the torque limits that every engine has and no others, where it explains more.

        Limits that join one after the other may hold each other: a slow set point and late messages were named beside
        a torque limit, none of them could go alone, and the two limits of the engine explained the test far better.
        """
        if set(here.kinds) <= set(ENGINE_LIMITS):
            return here
        scans = self._scan_from(linear, {**linear.values, **self.calm})
        starts = {one.candidate.kind: one.start for one in sorted(scans, key=lambda one: one.gain)}
        kinds = [kind for kind in ENGINE_LIMITS if kind in starts]
        levels = {name: starts[kind][name] for kind in kinds for name in parameters_of([kind])}
        engine = self._tried({**linear.values, **self.calm, **levels}, kinds, None)
        if engine is None or schwarz(engine) > schwarz(here):
            return here
        return self._without_idle(engine, kinds)

    def _pushed(self, here: Fitted, moves: Sequence[Mapping[str, float]]) -> Fitted:
        """Return the best of a governor and of fits that begin where moves put some of its parameters."""
        best = here
        for move in moves:
            moved = self._tried({**here.values, **move}, here.kinds, here.messages, negligible=PUSH_FALL)
            if moved is not None and moved.log_squares < best.log_squares - LEAST_FALL:
                best = self.fit(moved.values, moved.kinds, moved.messages)
        return best

    def _rest_moves(self, here: Fitted) -> list[dict[str, float]]:
        """Return offsets of the set point to either side of its calibration, of a torque limit with other levels.

        A line that rests near its torque limit has an optimum with the limit acting at rest, a lower level, a lower set
        point and a slower governor, and one without.
        """
        scale, offset = self.priors[GovernorSymbol.SET_POINT_SCALE].mean, self.priors[GovernorSymbol.SET_POINT_OFFSET]
        levels: list[dict[str, float]] = [{}]
        limited = GovernorSymbol.TORQUE_LIMIT in parameters_of(here.kinds)
        if limited and here.values[GovernorSymbol.TORQUE_LIMIT] < NEAR_REST:
            gains = {name: self.calm[name] for name in (GovernorSymbol.PROPORTIONAL_GAIN, GovernorSymbol.INTEGRAL_GAIN)}
            levels = [
                {GovernorSymbol.TORQUE_LIMIT: share * here.values[GovernorSymbol.TORQUE_LIMIT], **gains}
                for share in LEVEL_SHARES
            ]
        offsets = [offset.mean + side * REST_PUSH * offset.std for side in (-1.0, 1.0)]
        return [
            {GovernorSymbol.SET_POINT_SCALE: scale, GovernorSymbol.SET_POINT_OFFSET: off, **level}
            for off in offsets
            for level in levels
        ]

    def _tried(
        self,
        values: Mapping[str, float],
        kinds: Sequence[Kind],
        messages: Messages | None,
        *,
        negligible: float = ROUGH_FALL,
    ) -> Fitted | None:
        """Return the best governor from given values on; None where the simulation runs away from them."""
        try:
            return self.fit(values, kinds, messages, negligible=negligible)
        except IdentificationError:
            return None

    def fit(
        self,
        values: Mapping[str, float],
        kinds: Sequence[Kind],
        messages: Messages | None = None,
        *,
        negligible: float = ROUGH_FALL,
    ) -> Fitted:
        """Return the best governor with some limits, from given values on."""
        self.say(" and ".join(kind.value for kind in kinds) or "a governor without limits")
        record = self.record
        if messages is not None:
            record = with_messages(self.test, messages).record(drive_hz=self.drive_hz)
        return fitted(
            self.whole,
            record,
            values,
            kinds,
            priors=self.priors,
            iterations=ROUGH,
            negligible=negligible,
            messages=messages,
        )


def with_messages(test: GovernorTest, messages: Messages | None) -> GovernorTest:
    """Return a test with the set point held between messages, if there are any."""
    return test if messages is None else test.held(messages.best_cycle_s, messages.late_s)


def _delay_moves(here: Fitted) -> list[dict[str, float]]:
    """Return the delays inside the loop and before it, moved from one to the other: they trade along a valley."""
    late, before = here.values[GovernorSymbol.LOOP_DELAY], here.values[GovernorSymbol.SET_POINT_LATENCY]
    return [
        {
            GovernorSymbol.LOOP_DELAY: max(late + by_s, 0.005),
            GovernorSymbol.SET_POINT_LATENCY: max(before - by_s, 0.005),
        }
        for by_s in (-PUSH_S, PUSH_S)
    ]


def _strongest(scanned: Sequence[Scanned], count: int) -> list[Scanned]:
    """Return the best level of each limit, of the limits that gain most."""
    best = {one.candidate.kind: one for one in sorted(scanned, key=lambda one: one.gain)}
    return sorted(best.values(), key=lambda one: one.gain, reverse=True)[:count]
