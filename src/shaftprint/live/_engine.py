"""The way of a live test: arm, play, judge, give the set point back, or abort."""

import math
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._leg import Leg
from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.live._arming import ALIVE_S, expect_revert, seen_at_rest, taken_over
from shaftprint.live._block import DeviceMode
from shaftprint.live._counterpart import ABORT_RAMP_S, REVERT_S
from shaftprint.live._following import FollowedWatch, OscillationWatch, PutOutWatch
from shaftprint.live._judgement import LineJudgement
from shaftprint.live._lines import LineJudge
from shaftprint.live._loop import AbortingError, Loop
from shaftprint.live._outcome import Outcome
from shaftprint.live._replay import judged_channels
from shaftprint.live._state import State
from shaftprint.live._timetable import (
    ended_early,
    expect_playable,
    expect_slow,
    played_until,
    rendered,
    shifted,
    state_at,
    test_at,
)
from shaftprint.live._watch import (
    MISSING_S,
    AbortRule,
    BarredWatch,
    Breach,
    DataWatch,
    DeviceWatch,
    HeartbeatWatch,
    LimitWatch,
    Rest,
    Watch,
)

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.live._envelope import Envelope
    from shaftprint.live._play import Play

_LEAD_S = 1.0
# After an abort: the ramp, and what may pass until a block shows that the lever rules [s].
_RELEASED_S = 1.0


@dataclass(kw_only=True)
class LiveTest(Loop):
    """One test: what is played through which counterpart within which envelope."""

    campaign: "Campaign"
    """What is to be played."""
    envelope: "Envelope"
    """What must not be passed."""
    slope_rpm_per_v: float | None = None
    """What one volt asks for [rpm/V]; None: the speed is not held against the set point."""
    is_enough: "Callable[[LiveTest, str, int], Awaitable[bool]] | None" = None
    """Asked at the end of each period of a leg, with its name and whole periods, whether the rest is not needed."""
    dry: bool = False
    """Whether nothing is written: channels are looked at, and the test ends before heartbeat and arming."""
    alive_s: float = ALIVE_S
    """Time for which all channels are looked at before anything is taken over [s]."""
    waits: bool = False
    """Whether the ship waits for what is worked out, as a simulated one does that is not tied to a clock."""
    fewest_periods: int = 3
    """Periods of a leg that are played at least."""
    judgements: dict[str, tuple[LineJudgement, ...]] = field(default_factory=dict)
    """What is known of each test's lines so far, by the name of the test."""

    def __post_init__(self) -> None:
        """Begin at rest."""
        super().__post_init__()
        self._judge: tuple[str, LineJudge] | None = None
        self._ended: set[str] = set()
        self.revert_s = math.nan
        """How long the counterpart took to give the set point back in the arming test [s]."""

    # ---- the way of a test ----

    async def run(self) -> Outcome:
        """Arm, play, and give the set point back, whatever happens; never raises for what happens on board."""
        breach: Breach | None = None
        try:
            expect_playable(self.campaign)
            await self._arm()
            if self.dry:
                return self._outcome("refused", "Nothing was written: a dry run ends before arming.", None, back=True)
            await self._begin()
            await self._played()
            await self._give_back()
            return self._outcome("played", "", None, back=True)
        except AbortingError as aborting:
            breach = aborting.breach
        except SilentLinkError as error:
            breach = self._silent(str(error))
        except LiveError as refusal:
            if not self.is_ruling:
                self._tell("refused", str(refusal))
                return self._outcome("refused", str(refusal), None, back=await self._let_go())
            breach = Breach(
                rule=AbortRule.DEVICE,
                channel="counterpart",
                value=math.nan,
                limit=math.nan,
                unit="",
                persistence_s=0.0,
                time_s=math.nan if self._last is None else self._last.stop_s,
                why=str(refusal),
            )
        except BaseException:
            # an interrupt or a fault of the program: no heartbeat any more, so that the lever rules within a second
            self.beats = False
            raise
        is_back = await self._abort(breach)
        word = "aborted" if not math.isnan(self._zero_s) else "refused"
        return self._outcome(word, breach.sentence, breach, back=is_back)

    async def _arm(self) -> None:
        """Look at the channels at rest, and prove heartbeat and revert."""
        if self._observer.missing:
            raise LiveError(
                f"{self.counterpart.name}: expected the channels {', '.join(self._observer.missing)} of the vessel "
                f"file, found none; it sends {', '.join(one.name for one in self.counterpart.channels)}."
            )
        abilities = self.counterpart.abilities
        if not self.dry and not abilities.can_be_armed:
            raise LiveError(
                f"{self.counterpart.name}: expected a counterpart that reverts, ramps and plays, found one "
                "that can only be listened to; use --dry."
            )
        if not abilities.plays_waveform:
            expect_slow(self.campaign)
        rest = await seen_at_rest(self, self.counterpart, offset_v=self.campaign.offset_v, alive_s=self.alive_s)
        self._tell("alive", "All channels are alive, the lever stands where the campaign begins.")
        if self.dry:
            return
        self.revert_s = await expect_revert(self, self.counterpart)
        self._tell(
            "revert",
            f"Without heartbeat the lever ruled again after {self.revert_s:.2f} s.",
            facts={"took_s": self.revert_s},
        )
        self._sent.clear()
        self._watches = self._rules(rest)
        sight = await taken_over(self, self.counterpart, self.operator.confirm)
        self._since_s, self._held_v = sight.time_s, sight.block.device.set_point_v
        self._enter(State.ARMED)

    def _rules(self, rest: Rest) -> list[Watch]:
        sensors, span_s = self.vessel.sensors, self._last.span_s if self._last is not None else 0.05
        speed = self._observer.speed_channel
        rules: list[Watch] = [
            DataWatch((sensors.set_point.channel, sensors.shaft_torque.channel, speed)),
            HeartbeatWatch(),
            DeviceWatch(self.envelope.longest_s),
            *(LimitWatch(bound) for bound in self.envelope.bounds),
            BarredWatch(self.envelope),
            PutOutWatch(rest),
            OscillationWatch(rest, span_s),
        ]
        if self.slope_rpm_per_v is None:
            self._tell("unwatched", "No slope_rpm_per_v is known: the speed is not held against the set point.")
            return rules
        return [*rules, FollowedWatch(rest, self.slope_rpm_per_v, span_s)]

    async def _begin(self) -> None:
        if self._last is None:
            raise LiveError("live test: expected a block before anything is played, found none.")
        self._zero_s = self._last.stop_s + _LEAD_S
        await self._put_out(rendered(self.campaign, zero_s=self._zero_s))

    async def _put_out(self, play: "Play") -> None:
        if self.counterpart.abilities.plays_waveform:
            await self.counterpart.play(play)
        else:
            self._written = play
        self.record.campaign(self._as_played(self.campaign))
        while self._last is not None and self._last.stop_s < play.start_s:
            await self.next()
            await self._look_at_lines()
        self._play = play

    async def _played(self) -> None:
        """Follow the campaign to its end, and judge its lines as they come."""
        while self.campaign_s < self.campaign.duration_s:
            await self.next()
            self._enter(state_at(self.campaign, min(self.campaign_s, self.campaign.duration_s)))
            await self._look_at_lines()

    async def _look_at_lines(self) -> None:
        block = self._last
        if block is None or math.isnan(self._zero_s):
            return
        test = test_at(self.campaign, block.source_s - self._zero_s)
        if not isinstance(test, Sine | Leg):
            return
        if self._judge is None or self._judge[0] != test.name:
            self._judge = test.name, self._judge_of(test)
        name, judge = self._judge
        if not judge.take(block):
            return
        self.judgements[name] = judge.judgements()
        self._tell("judged", f"{name}: {judge.periods} of {judge.most_periods} periods.", facts={"of": name})
        if judge.spoilt:
            self._tell("spoilt", f"{name}: {judge.spoilt} periods are left out, as samples of them were lost.")
        await self._perhaps_end(test, judge)

    def _judge_of(self, test: Sine | Leg) -> LineJudge:
        """Return what judges a test: over the set point, of what its blocks hold as evenly."""
        even = judged_channels(self.counterpart.channels, self.vessel)
        return LineJudge(test, zero_s=self._zero_s, channels=even, set_point=self.vessel.sensors.set_point.channel)

    async def _perhaps_end(self, test: Sine | Leg, judge: LineJudge) -> None:
        """End a test early where the rest of it is not needed."""
        if self.is_enough is None or test.name in self._ended or not isinstance(test, Leg):
            return
        if not self.fewest_periods <= judge.periods < judge.most_periods:
            return
        if not await self.is_enough(self, test.name, judge.periods):
            return
        length_s = test.length_of_period_s
        # a change needs time to reach the device: the end of a period that is at least that far away
        periods = math.ceil((self.campaign_s + _LEAD_S - test.settled_s) / length_s)
        stop_s = test.settled_s + periods * length_s
        if stop_s >= test.stop_s - length_s / 2.0:
            return
        self._ended.add(test.name)
        self.campaign = ended_early(self.campaign, test.name, stop_s)
        self._tell("enough", f"{test.name} ends after {periods} periods: what is known is enough.")
        await self._put_out(rendered(self.campaign, zero_s=self._zero_s, from_s=stop_s))

    async def _give_back(self) -> None:
        self._written = None
        await self.counterpart.release()
        self._since_s = math.nan
        sight = await self.next()
        while sight.block.device.mode is not DeviceMode.LEVER:
            sight = await self.next()
            if sight.time_s - self._zero_s > self.campaign.duration_s + _LEAD_S + REVERT_S:
                raise LiveError(f"{self.counterpart.name}: expected the lever to rule after the test, found otherwise.")
        self.beats = False
        self._enter(State.IDLE)
        self._tell("released", "All was played; the lever rules.")

    # ---- the way out ----

    async def _abort(self, breach: Breach) -> bool:
        """Go back by the device's ramp, and see that the lever rules; return whether it was seen."""
        self._enter(State.ABORT)
        self._tell(
            "abort",
            breach.sentence,
            facts={"rule": breach.rule, "channel": breach.channel, "persistence_s": breach.persistence_s},
        )
        self._watches, self._since_s, self._written = [], math.nan, None
        try:
            await self.counterpart.abort(ABORT_RAMP_S)
        except LiveError as error:
            self._tell("unheard", f"The abort was not heard ({error}); without heartbeat the counterpart reverts.")
            self.beats = False
        is_back = await self._sees_lever(ABORT_RAMP_S + _RELEASED_S)
        if not is_back:
            # whatever it does, without heartbeat it must revert
            self.beats = False
            is_back = await self._sees_lever(2.0 * REVERT_S + _RELEASED_S)
        self.beats = False
        if is_back:
            self._enter(State.IDLE)
            self._tell("released", "The lever rules again.")
        else:
            self._tell("alarm", "NOTHING SHOWS THAT THE LEVER RULES: take the engine to local control.")
        return is_back

    async def _sees_lever(self, within_s: float) -> bool:
        begun_s = self.counterpart.clock()
        while self.counterpart.clock() - begun_s < within_s:
            try:
                sight = await self.next()
            except SilentLinkError:
                self.beats = False
                continue
            if sight.block.device.mode is DeviceMode.LEVER:
                return True
        return False

    async def _let_go(self) -> bool:
        """Stop heartbeats after a refusal; return whether the lever rules."""
        self.beats = False
        if self._last is not None and self._last.device.mode is DeviceMode.LEVER:
            return True
        self.state = State.ABORT
        is_back = await self._sees_lever(2.0 * REVERT_S)
        self.state = State.IDLE
        return is_back

    def _silent(self, sentence: str) -> Breach:
        return Breach(
            rule=AbortRule.DATA,
            channel="link",
            value=MISSING_S,
            limit=MISSING_S,
            unit="s",
            persistence_s=MISSING_S,
            time_s=math.nan if self._last is None else self._last.stop_s,
            why=sentence,
        )

    # ---- what comes out ----

    def recorded_s(self, campaign_s: float) -> float:
        """Return a time of the campaign by the time of the recording [s]."""
        return campaign_s + self._zero_s - (self.record.first_s or 0.0)

    def _as_played(self, campaign: "Campaign") -> "Campaign":
        return shifted(campaign, self.recorded_s(0.0))

    def _outcome(self, word: str, reason: str, breach: Breach | None, *, back: bool) -> Outcome:
        played = None
        if not math.isnan(self._zero_s):
            until_s = breach.time_s - self._zero_s if breach is not None else math.inf
            played = self.campaign if math.isinf(until_s) else played_until(self.campaign, until_s)
        return Outcome(
            word=word,
            reason=reason,
            breach=breach,
            campaign=None if played is None else self._as_played(played),
            judgements=tuple(one for lines in self.judgements.values() for one in lines),
            is_back=back,
        )
