"""The way of a live test: arm, play, judge, give the set point back, or abort."""

import math
from dataclasses import dataclass

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.live._arming import ALIVE_S, expect_revert, seen_at_rest, taken_over
from shaftprint.live._block import DeviceMode
from shaftprint.live._counterpart import ABORT_RAMP_S, REVERT_S
from shaftprint.live._course import LEAD_S, Course
from shaftprint.live._following import FollowedWatch, OscillationWatch, PutOutWatch
from shaftprint.live._loop import AbortingError
from shaftprint.live._outcome import Outcome
from shaftprint.live._state import State
from shaftprint.live._timetable import expect_playable, expect_slow, rendered
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

# After an abort: the ramp, and what may pass until a block shows that the lever rules [s].
_RELEASED_S = 1.0


@dataclass(kw_only=True)
class LiveTest(Course):
    """One test: what is played through which counterpart within which envelope."""

    slope_rpm_per_v: float | None = None
    """What one volt asks for [rpm/V]; None: the speed is not held against the set point."""
    dry: bool = False
    """Whether nothing is written: channels are looked at, and the test ends before heartbeat and arming."""
    alive_s: float = ALIVE_S
    """Time for which all channels are looked at before anything is taken over [s]."""

    def __post_init__(self) -> None:
        """Begin at rest."""
        super().__post_init__()
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
        if self.dry:
            # nothing was taken over, and nothing is written
            return self._outcome("refused", breach.sentence, breach, back=await self._let_go())
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
        self._zero_s = self._last.stop_s + LEAD_S
        play = rendered(self.campaign, zero_s=self._zero_s)
        await self._send(play)
        await self._follow(play, self.campaign)
        self._forget_early_asks()

    async def _give_back(self) -> None:
        self._written = None
        await self.counterpart.release()
        self._since_s = math.nan
        sight = await self.next()
        while sight.block.device.mode is not DeviceMode.LEVER:
            sight = await self.next()
            if sight.time_s - self._zero_s > self.campaign.duration_s + LEAD_S + REVERT_S:
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

    def _outcome(self, word: str, reason: str, breach: Breach | None, *, back: bool) -> Outcome:
        played = None
        if not math.isnan(self._zero_s):
            played = self.as_played(math.inf if breach is None else breach.time_s - self._zero_s)
        names = () if played is None else {one.name for one in played.excitations}
        return Outcome(
            word=word,
            reason=reason,
            breach=breach,
            campaign=played,
            judgements=tuple(one for name, lines in self.judgements.items() if name in names for one in lines),
            is_back=back,
        )
