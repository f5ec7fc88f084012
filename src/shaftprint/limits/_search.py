"""Which limits act: one after the other they join the governor, as long as chance does not explain the gain."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.limits._candidates import CANDIDATES, Kind, LimitCandidate, idle_values, starts_of
from shaftprint.limits._governor_fit import GOVERNOR, NEGLIGIBLE_FALL, Fitted, fitted, schwarz, values_without_limits
from shaftprint.limits._moves import LARGEST_OFFSET, SAME_OFFSET, calm_part, delay_moves, rest_moves
from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._held_set_point import Messages, messages_of
from shaftprint.limits.prediction._reach import Reach
from shaftprint.limits.prediction._recent_simulations import RecentSimulations
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.models._structure import Structure

# Gain of twice the log-likelihood over what Schwarz' criterion asks that a limit must bring to be named.
LEAST_GAIN = 25.0
FAST = (
    GovernorSymbol.LOOP_DELAY,
    GovernorSymbol.ACTUATOR_FREQUENCY,
    GovernorSymbol.ACTUATOR_DAMPING,
    GovernorSymbol.SET_POINT_LATENCY,
)
"""What slow sines tell too little of."""
ENGINE_LIMITS = ((Kind.TORQUE, Kind.MOTORING), (Kind.SMOKE, Kind.MOTORING))
"""What every engine has: a highest torque, with boost or at once, and one below which it cannot brake."""
RATES = (Kind.RAMP, Kind.RATE)
MOST_LIMITS, MOST_ROUNDS = 4, 16
# Candidates of a round that are fitted, and pushes.
POLISHED, POLISHED_CALM, PUSHED = 2, 5, 3
# Most iterations of a fit that is compared with others, and the fall of minus twice the log-likelihood that is not
# worth one: limits are told apart by falls of tens.
ROUGH, ROUGH_FALL = 16, 0.2
# Most pushed fits come back to where they were: they end sooner, and go on only where they came lower.
LEAST_FALL, PUSH_FALL = 0.5, 1.0
# A line whose calibration does not tell offsets apart is first fitted with that of its slow parts, known to this:
# between it and another one the likelihood has a fold, which a search that is free passes by chance (2 log L 420 worse,
# torque without boost 0.37 for 0.455).
AT_REST_STD = 1e-4
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
    reach: Reach
    """What the test reached: limits that it passed are impossible."""
    offset: float
    """Offset of the set point where it hardly moves: beside limits the likelihood has several optima over it."""
    recent: RecentSimulations = field(default_factory=RecentSimulations, repr=False)
    """What was simulated last."""
    optima: dict[frozenset[Kind], Fitted] = field(default_factory=dict, repr=False)
    """The best governor that was found with each choice of limits."""
    done: dict[tuple[object, ...], Fitted] = field(default_factory=dict, repr=False)
    """Fits by where they began: ways that lead to one place ask for the same fit again."""
    lesser: dict[tuple[frozenset[Kind], Kind], float] = field(default_factory=dict, repr=False)
    """For limits of which one was taken away, the criterion of the governor that still had it."""

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
        offset = float(np.clip(test.settled_offset(), -LARGEST_OFFSET, LARGEST_OFFSET))
        start = {**values_without_limits(whole), GovernorSymbol.SET_POINT_OFFSET: offset}
        record = test.record(drive_hz=drive_hz)
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
            reach=Reach.of(test),
            offset=offset,
        )

    def linear(self) -> Fitted:
        """Return the best governor without limits."""
        here = self.fit({**values_without_limits(self.whole), **self.calm}, (), at_rest=True)
        return self._pushed(here, delay_moves(here))

    def run(self) -> tuple[Fitted, list[Scanned]]:
        """Let limits join the governor until chance explains what the next one would gain.

        Returns the governor with its limits, and the levels of those that did not join, tried at the end.
        """
        here = linear = self.linear()
        engines_tried = False
        for _ in range(MOST_ROUNDS):
            scans = self.scanned(here)
            tries = [self._joined(here, scans), self.held(here)] if len(here.kinds) < MOST_LIMITS else []
            better = min((one for one in tries if one is not None), key=schwarz, default=here)
            if schwarz(here) - schwarz(better) > LEAST_GAIN:
                here = self._without_idle(better)
                continue
            other = self._pushed(here, self._rest_moves(here))
            if other is here and not engines_tried:
                engines_tried, other = True, self._engine_limits_or(here, linear)
            if other is here:
                other = self._of_all_optima(here)
            if other is here:
                break
            here = other
        return self.fit(here.values, here.kinds, here.messages, negligible=NEGLIGIBLE_FALL, near=here), scans

    def scanned(self, here: Fitted) -> list[Scanned]:
        """Return what each level of each limit that is not present would gain over a governor."""
        return self._scan_from(here, here.values)

    def _scan_from(
        self, here: Fitted, base: Mapping[str, float], among: Collection[Kind] | None = None
    ) -> list[Scanned]:
        """Return the gains, the governor following to first order from some values; of some kinds or of all."""
        gain_of = self._followed(here, base)
        simulated = here.term.predicted(np.array([base[name] for name in self.whole.names]))
        speed = here.term.record.decimator.thinned(here.term.record.drive["n"][:, None])[:, 0]
        load = np.maximum(1.0 + speed, LEAST_SPEED) ** 2
        scans = []
        for candidate in CANDIDATES:
            if candidate.kind in here.kinds or (among is not None and candidate.kind not in among):
                continue
            for start in starts_of(candidate, base, (1.0 + simulated) * load, self.full):
                values = {**base, **start}
                # what the test passed is not worth a simulation
                gain = -np.inf if self.reach.passes(candidate.kind, values) else gain_of(values)
                scans.append(Scanned(candidate=candidate, start=values, gain=gain))
        return scans

    def _followed(self, here: Fitted, base: Mapping[str, float]) -> Callable[[Mapping[str, float]], float]:
        """Return what parameters near some values gain over a governor, which follows to first order."""
        term, names = here.term, self.whole.names
        base_values = np.array([base[name] for name in names])
        rows, now, best = term.rows(base_values), term.innovations(base_values), term.innovations(here.own)
        if rows is None or now is None or best is None:
            raise IdentificationError(f"{term.name}: the simulation runs away where it was fitted.")
        basis, _ = np.linalg.qr(rows[1:].T)
        simulated = term.predicted(base_values)

        def gain(values: Mapping[str, float]) -> float:
            there = term.predicted(np.array([values[name] for name in names]))
            moved = now.values + now.filtered((simulated - there)[None])[0]
            moved = moved - basis @ (basis.T @ moved)
            squares = max(float(moved @ moved), SMALLEST)
            return best.count * float(np.log(best.squares / squares)) if np.isfinite(squares) else -np.inf

        return gain

    def _joined(self, here: Fitted, scanned: Sequence[Scanned]) -> Fitted | None:
        """Return the governor with the one more limit that gains most; None where there is none to try."""
        starts = _strongest(scanned, POLISHED)
        if not here.kinds:
            starts = _strongest([*scanned, *self._scan_from(here, {**here.values, **self.calm})], POLISHED_CALM)
        starts = [one for one in starts if np.isfinite(one.gain)]
        tries = [
            self._tried(one.start, (*here.kinds, one.candidate.kind), here.messages, at_rest=not here.kinds)
            for one in starts
        ]
        best = min((one for one in tries if one is not None), key=schwarz, default=None)
        if best is None:
            return None
        if Kind.SMOKE in best.kinds and Kind.SMOKE not in here.kinds:
            best = self._torque_limit_or(best, scanned)
        return self._pushed(best, delay_moves(best))

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
        return self.optima.get(frozenset(kinds), here)

    def messages(self, here: Fitted) -> Messages | None:
        """Return what the jumps tell of messages, to first order; None where they are too few."""
        return here.messages or messages_of(here.term, here.own, self.test, here.known)

    def without(self, here: Fitted, gone: Kind) -> Fitted:
        """Return the best governor without one of its limits, of a fit from it on and of those found before."""
        kinds, tried = tuple(kind for kind in here.kinds if kind is not gone), (frozenset(here.kinds), gone)
        if schwarz(here) < self.lesser.get(tried, np.inf) - LEAST_FALL:
            self.lesser[tried] = schwarz(here)
            idle = idle_values(gone, kinds, self.full)
            self._tried({**here.values, **idle}, kinds, here.messages if Kind.HELD in kinds else None)
        return self.optima.get(frozenset(kinds), self.optima[frozenset()])

    def _without_idle(self, here: Fitted) -> Fitted:
        """Return the governor without those of its limits that the others have made idle."""
        for kind in here.kinds:
            without = self.without(here, kind)
            if schwarz(without) - schwarz(here) < LEAST_GAIN:
                return self._without_idle(without)
        return here

    def _of_all_optima(self, here: Fitted) -> Fitted:
        """Return a better optimum that was found on the way, or the governor without limits that chance explains."""
        best = min(self.optima.values(), key=schwarz)
        return self._without_idle(best if schwarz(best) < schwarz(here) - LEAST_FALL else here)

    def _engine_limits_or(self, here: Fitted, linear: Fitted) -> Fitted:
        """Return the governor with the limits that every engine has and no others, where it explains more.

        Limits that join one after the other may hold each other: a slow set point and late messages were named beside
        a torque limit, none of them could go alone, and the two limits of the engine explained the test far better.
        """
        best = here
        for kinds in ENGINE_LIMITS:
            start = self._engine_start(linear, {**linear.values, **self.calm}, kinds)
            engine = None if start is None else self._tried(start, kinds, None, at_rest=True)
            if engine is not None and schwarz(engine) < schwarz(best) - LEAST_FALL:
                best = engine
        return best if best is here else self._without_idle(best)

    def _engine_start(
        self, linear: Fitted, base: Mapping[str, float], kinds: Sequence[Kind]
    ) -> Mapping[str, float] | None:
        """Return all parameters at levels of some limits that gain together; None where there are none to try."""
        gain, values = -np.inf, base
        for kind in kinds:
            best = max(self._scan_from(linear, values, (kind,)), key=lambda one: one.gain, default=None)
            if best is not None and best.gain > gain:
                gain, values = best.gain, best.start
        return values if np.isfinite(gain) else None

    def _pushed(self, here: Fitted, moves: Sequence[Mapping[str, float]]) -> Fitted:
        """Return the best of a governor and of fits that begin where the most promising moves put its parameters."""
        starts = [{**here.values, **move} for move in moves]
        if len(starts) > PUSHED:
            starts = sorted(starts, key=self._followed(here, here.values), reverse=True)[:PUSHED]
        best = here
        for start in starts:
            moved = self._tried(start, here.kinds, here.messages, negligible=PUSH_FALL)
            if moved is not None and moved.log_squares < best.log_squares - LEAST_FALL:
                best = self.fit(moved.values, moved.kinds, moved.messages, near=moved)
        return best

    def _rest_moves(self, here: Fitted) -> list[dict[str, float]]:
        return rest_moves(here, calm=self.calm, offset=self.offset, priors=self.priors)

    def _tried(
        self,
        values: Mapping[str, float],
        kinds: Sequence[Kind],
        messages: Messages | None,
        *,
        negligible: float = ROUGH_FALL,
        at_rest: bool = False,
    ) -> Fitted | None:
        """Return the best governor from given values on; None where it runs away, or has a rate that was passed."""
        try:
            best = self.fit(values, kinds, messages, negligible=negligible, at_rest=at_rest)
        except IdentificationError:
            return None
        return None if self._passes_a_rate(best) else best

    def fit(
        self,
        values: Mapping[str, float],
        kinds: Sequence[Kind],
        messages: Messages | None = None,
        *,
        negligible: float = ROUGH_FALL,
        at_rest: bool = False,
        near: Fitted | None = None,
    ) -> Fitted:
        """Return the best governor with some limits, from given values on.

        ``near``: one with the same limits whose derivatives do to begin with. ``at_rest``: whether the offset of the
        set point is first held where its slow parts have it, if it is not known.
        """
        at_rest = at_rest and self.priors[GovernorSymbol.SET_POINT_OFFSET].std > SAME_OFFSET
        place = (tuple(kinds), tuple(values.values()), id(messages), negligible, at_rest)
        if place in self.done:
            return self.done[place]
        rough = partial(fitted, self.whole, kinds=kinds, iterations=ROUGH, recent=self.recent)
        if at_rest:
            known = {GovernorSymbol.SET_POINT_OFFSET: Prior(self.offset, AT_REST_STD)}
            values = {**values, GovernorSymbol.SET_POINT_OFFSET: self.offset}
            values = rough(self.record, values, priors={**self.priors, **known}, negligible=PUSH_FALL).values
        self.say(" and ".join(kind.value for kind in kinds) or "a governor without limits")
        record = self.record
        if messages is not None:
            record = with_messages(self.test, messages).record(drive_hz=self.drive_hz)
        best = rough(record, values, priors=self.priors, negligible=negligible, messages=messages, near=near)
        before = self.optima.get(frozenset(kinds))
        if not self._passes_a_rate(best) and (before is None or schwarz(best) < schwarz(before)):
            self.optima[frozenset(kinds)] = best
        self.done[place] = best
        return best

    def _passes_a_rate(self, one: Fitted) -> bool:
        """Return whether the test passed a rate that a governor has.

        A limit of the torque may be too low for what the test reached until another one has joined it.
        """
        return any(kind in one.kinds and self.reach.passes(kind, one.values) for kind in RATES)


def with_messages(test: GovernorTest, messages: Messages | None) -> GovernorTest:
    """Return a test with the set point held between messages, if there are any."""
    return test if messages is None else test.held(messages.best_cycle_s, messages.late_s)


def _strongest(scanned: Sequence[Scanned], count: int) -> list[Scanned]:
    """Return the best level of each limit, of the limits that gain most."""
    best = {one.candidate.kind: one for one in sorted(scanned, key=lambda one: one.gain)}
    return sorted(best.values(), key=lambda one: one.gain, reverse=True)[:count]
