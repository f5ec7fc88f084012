"""The course of a live test: leg after leg is played and judged, and what is to come is changed on the way.

A change is made by what is known so far, or by the operator. But for a hold it is proved against the envelope before
it is sent to the device; what is refused is told, and the test goes on as it was.
"""

import asyncio
import math
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._leg import FEWEST_PERIODS, Leg, first_name
from shaftprint.errors import LiveError, ShaftprintError, SilentLinkError
from shaftprint.live._changes import Advice, Periodic, again, begun_until, by_information, followed_by
from shaftprint.live._judgement import LineJudgement
from shaftprint.live._lines import LineJudge
from shaftprint.live._loop import Loop
from shaftprint.live._outcome import Ask
from shaftprint.live._play import Play
from shaftprint.live._replay import judged_channels
from shaftprint.live._state import State
from shaftprint.live._timetable import PLAY_HZ, faster_than, played_until, rendered, shifted, state_at, test_at

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._excitation import Excitation
    from shaftprint.live._envelope import Envelope

LEAD_S = 1.0
"""Time that a change needs to reach the device [s]."""

# What is known is worked out again after this share of the periods that are missing.
_WAITED_SHARE = 0.25

# A campaign, when it begins to differ from the one that is played [s], and the test that is cut, left out or played
# again; None where it is too late for that.
_Change: TypeAlias = "tuple[Campaign, float, str] | None"
# Makes a change that begins at a time of the campaign, or soon after it [s].
_Maker: TypeAlias = Callable[[float], _Change]


@dataclass(kw_only=True)
class Course(Loop):
    """What is played, and what of it is known."""

    campaign: "Campaign"
    """What is to be played."""
    envelope: "Envelope"
    """What must not be passed."""
    advises: "Callable[[Course], Awaitable[Advice | None]] | None" = None
    """Asked at the end of each period of a leg, what is still to be played; None: nothing is known yet."""
    proves: "Callable[[Campaign], Sequence[str]] | None" = None
    """Says why a changed campaign may not be played; without it nothing is changed but that it is held."""
    most_s: float | None = None
    """Longest time that is played by what is known [s], holds apart; as long as the campaign where not given."""
    waits: bool = False
    """Whether the ship waits for what is worked out, as a simulated one does that is not tied to a clock."""
    fewest_periods: int = 3
    """Periods of a leg that are played at least."""
    judgements: dict[str, tuple[LineJudgement, ...]] = field(default_factory=dict)
    """What is known of each test's lines so far, by the name of the test."""

    def __post_init__(self) -> None:
        """Begin at rest."""
        super().__post_init__()
        self._asked = self.campaign
        self._most_s = self.campaign.duration_s if self.most_s is None else self.most_s
        self._judge: tuple[str, LineJudge] | None = None
        self._proving: tuple[asyncio.Task[Sequence[str]], _Maker, str, str] | None = None
        self._held: tuple[Excitation, ...] | None = None
        self._held_s = math.nan
        self._wait_periods = 0

    @property
    def left_s(self) -> float:
        """Time that the campaign takes from now on [s]; not a number before it is played, and while it is held."""
        return math.nan if self._held is not None else self.campaign.duration_s - self.campaign_s

    def recorded_s(self, campaign_s: float) -> float:
        """Return a time of the campaign by the time of the recording [s]."""
        return campaign_s + self._zero_s - (self.record.first_s or 0.0)

    def as_played(self, until_s: float = math.inf) -> "Campaign | None":
        """Return what is played until a time [s], by the time of the recording; None where that is no whole test."""
        played = played_until(self.campaign, until_s)
        return None if played is None else shifted(played, self.recorded_s(0.0))

    async def _put_out(self, play: Play, campaign: "Campaign") -> bool:
        """Send a change to the device and follow it; return whether it took it: it plays on what it has where not."""
        try:
            await self._send(play)
        except SilentLinkError:
            raise
        except LiveError as refusal:
            self._tell("not done", str(refusal))
            return False
        await self._follow(play, campaign)
        return True

    async def _send(self, play: Play) -> None:
        if self.counterpart.abilities.plays_waveform:
            await self.counterpart.play(play)
        else:
            self._written = play

    async def _follow(self, play: Play, campaign: "Campaign") -> None:
        """Take a campaign as the one that is played, once its first value is put out."""
        self.campaign = campaign
        played = self.as_played()
        if played is not None:
            self.record.campaign(played)
        while self._last is not None and self._last.stop_s < play.start_s:
            await self.next()
            await self._judge_lines()
        self._play = play

    async def _played(self) -> None:
        """Follow the campaign to its end, and judge its lines as they come."""
        while self._held is not None or self.campaign_s < self.campaign.duration_s:
            await self.next()
            is_held = self._held is not None and self.campaign_s >= self._held_s
            now_s = min(self.campaign_s, self.campaign.duration_s)
            self._enter(State.HOLD if is_held else state_at(self.campaign, now_s))
            ended = await self._judge_lines()
            if self._proving is not None:
                await self._proved()
            elif self.operator.asks:
                await self._obey(self.operator.asks.popleft())
            elif ended is not None and self._held is None:
                await self._take_advice(*ended)
        # a change may have ended it where a test was
        self._enter(State.RAMP_OUT)

    async def _judge_lines(self) -> tuple[Periodic, LineJudge] | None:
        """Judge the last block; return the leg of which it has ended a period."""
        block = self._last
        if block is None or math.isnan(self._zero_s):
            return None
        test = test_at(self.campaign, block.source_s - self._zero_s)
        if not isinstance(test, Sine | Leg):
            return None
        if self._judge is None or self._judge[0] != test.name:
            even = judged_channels(self.counterpart.channels, self.vessel)
            set_point = self.vessel.sensors.set_point.channel
            self._judge = test.name, LineJudge(test, zero_s=self._zero_s, channels=even, set_point=set_point)
        name, judge = self._judge
        # a change has made it longer or shorter
        judge.most_periods = test.periods
        if not judge.take(block):
            return None
        self.judgements[name] = judge.judgements()
        self._tell("judged", f"{name}: {judge.periods} of {judge.most_periods} periods.", facts={"of": name})
        if judge.spoilt:
            self._tell("spoilt", f"{name}: {judge.spoilt} periods are left out, as samples of them were lost.")
        return (test, judge) if isinstance(test, Periodic) else None

    # ---- by what is known ----

    async def _take_advice(self, leg: Periodic, judge: LineJudge) -> None:
        """Change what is to come where that is known to tell more, or enough is known."""
        if self.advises is None or not self.fewest_periods <= judge.periods < leg.periods:
            return
        self._wait_periods -= 1
        # where much is missing the next period does not bring it; before a leg ends it must be known
        if self._wait_periods > 0 and judge.periods < leg.periods - 1:
            return
        advice = await self.advises(self)
        if advice is None:
            return
        self._wait_periods = math.ceil(sum(advice.more.values()) * _WAITED_SHARE)

        def make(at_s: float) -> _Change:
            now = test_at(self.campaign, self.campaign_s)
            if not isinstance(now, Leg) or now.name != leg.name:
                return None
            length_s = leg.length_of_period_s
            changed = by_information(
                self.campaign,
                leg,
                advice,
                played=math.floor((self.campaign_s - leg.settled_s) / length_s + 1e-6),
                soonest=math.ceil((at_s - leg.settled_s) / length_s),
                fewest=self.fewest_periods,
                most_s=self._most_s,
                like=self._asked,
            )
            if changed is None or changed == self.campaign:
                return None
            (ends,) = (one for one in changed.legs if one.name == leg.name)
            return changed, min(ends.stop_s, leg.stop_s), leg.name

        if advice.sentence:
            self._tell("known", advice.sentence)
        await self._propose(make, "enough" if advice.is_enough else "changed")

    # ---- by the operator ----

    async def _obey(self, ask: Ask) -> None:
        """Do what the operator has asked for, or say why not."""
        match ask:
            case Ask.HOLD if self._held is None:
                await self._hold()
            case Ask.GO_ON if self._held is not None:
                await self._offer(self._going_on(self._held), "going on")
            case Ask.SKIP if self._held is not None:
                self._held = self._held[1:]
                self._tell("changed", f"Skipped; then {self._named(self._held)}.")
            case Ask.SKIP:
                await self._offer(self._skipping, "changed")
            case Ask.REPEAT if self._held is None:
                await self._offer(self._repeating, "changed")
            case _:
                now = "is played" if self._held is None else "holds"
                self._tell("not done", f'"{ask}" has no meaning while the test {now}.')

    def _forget_early_asks(self) -> None:
        """Leave out what was asked before anything was played, but a hold: there was no test that it could mean."""
        asks = self.operator.asks
        for ask in [asks.popleft() for _ in range(len(asks))]:
            if ask is Ask.HOLD:
                asks.append(ask)
            else:
                self._tell("not done", f'"{ask}" has no meaning before the test is played.')

    async def _hold(self) -> None:
        """Stay where the set point is: a test that runs ends there, and what is missing of it comes after the hold."""
        begun, to_come = begun_until(self.campaign, self.campaign_s + LEAD_S)
        stop_s = begun[-1].stop_s if begun else 0.0
        ran = next((one for one in self.campaign.excitations if begun and one.name == begun[-1].name), None)
        if ran is not None and ran.stop_s > stop_s:
            to_come = (*self._missing_of(ran, begun[-1]), *to_come)
        held_s = max(stop_s, self.campaign_s + LEAD_S)
        volts = np.array([self._stands_v(held_s)])
        play = Play(name="hold", start_s=self._zero_s + held_s, rate_hz=PLAY_HZ, volts=volts)
        campaign = followed_by(self.campaign, begun, (), from_s=held_s, like=self._asked)
        if await self._put_out(play, campaign):
            self._held, self._held_s = to_come, held_s
            lasts_s = self.envelope.longest_s - (self._zero_s + held_s - self._since_s)
            self._tell("hold", f"Holds at {volts[0]:.4g} V, {lasts_s:.0f} s at most; then {self._named(to_come)}.")

    def _missing_of(self, whole: "Excitation", cut: "Excitation") -> tuple["Excitation", ...]:
        """Return what is to be played again of a test that was cut."""
        if not isinstance(whole, Leg) or not isinstance(cut, Leg) or cut.periods < FEWEST_PERIODS:
            return (again(whole, self.campaign),)
        missing = whole.periods - cut.periods
        return (again(whole, self.campaign, periods=missing),) if missing >= FEWEST_PERIODS else ()

    def _stands_v(self, at_s: float) -> float:
        """Return the set point at a time of the campaign [s] by what is played now [V]."""
        play = self._play or rendered(self.campaign, zero_s=self._zero_s)
        return float(play.value_at(np.array([self._zero_s + at_s]))[0])

    def _then(
        self, begun: "Sequence[Excitation]", follow: "Sequence[Excitation]", *, from_s: float, of: str
    ) -> _Change:
        """Return the change to tests that follow on those that have begun."""
        is_between = not begun or begun[-1].stop_s < from_s
        from_v = self._stands_v(from_s) if is_between else None
        return followed_by(self.campaign, begun, follow, from_s=from_s, from_v=from_v, like=self._asked), from_s, of

    def _going_on(self, held: "tuple[Excitation, ...]") -> _Maker:
        def make(at_s: float) -> _Change:
            return self._then(self.campaign.excitations, held, from_s=max(at_s, self._held_s), of="")

        return make

    def _skipping(self, at_s: float) -> _Change:
        begun, to_come = begun_until(self.campaign, at_s)
        is_cut = bool(begun) and begun[-1].stop_s >= at_s
        if not is_cut and not to_come:
            return None
        if is_cut:
            return self._then(begun, to_come, from_s=begun[-1].stop_s, of=begun[-1].name)
        return self._then(begun, to_come[1:], from_s=at_s, of=to_come[0].name)

    def _repeating(self, at_s: float) -> _Change:
        begun, to_come = begun_until(self.campaign, at_s)
        if not begun or begun[-1].start_s > at_s:
            return None
        ran = next(one for one in self.campaign.excitations if one.name == begun[-1].name)
        asked = next(one for one in self._asked.excitations if one.name == first_name(ran.name))
        follow = (again(asked, self.campaign), *to_come)
        return self._then((*begun[:-1], ran), follow, from_s=max(ran.stop_s, at_s), of=ran.name)

    async def _offer(self, make: _Maker, word: str) -> None:
        if not await self._propose(make, word):
            self._tell("not done", "Nothing is changed: it is too late, or nothing is there that could be.")

    # ---- proved, then put out ----

    async def _propose(self, make: _Maker, word: str) -> bool:
        """Have a change proved beside the loop, which goes on with its blocks; return whether there is one."""
        change = make(self.campaign_s + LEAD_S)
        if change is None or self.proves is None:
            return False
        task = asyncio.create_task(asyncio.to_thread(self.proves, change[0]))
        self._proving = task, make, word, change[2]
        if self.waits:
            await asyncio.wait([task])
            await self._proved()
        return True

    async def _proved(self) -> None:
        """Put a change out that was proved; the same as was proved, but for when it begins."""
        if self._proving is None or not self._proving[0].done():
            return None
        (task, make, word, of), self._proving = self._proving, None
        try:
            refusals = task.result()
        except ShaftprintError as error:
            refusals = (str(error),)
        if refusals:
            return self._tell("not done", f"Nothing is changed; it may not be played: {' '.join(refusals)}")
        change = make(self.campaign_s + LEAD_S)
        if change is None or change[2] != of:
            return self._tell("not done", "Nothing is changed: it is too late.")
        campaign, from_s, _ = change
        play = rendered(campaign, zero_s=self._zero_s, from_s=from_s, from_v=self._stands_v(from_s))
        if too_fast := faster_than(play.volts, self.envelope.highest_slew_v_per_s):
            return self._tell("not done", f"Nothing is changed; it may not be played: {too_fast}")
        if not await self._put_out(play, campaign):
            return None
        if self._held is not None:
            self._most_s += from_s - self._held_s
            self._held = None
        # what the operator wants to be played has the time that it takes
        self._most_s = max(self._most_s, campaign.duration_s)
        to_come = [one for one in campaign.excitations if one.stop_s > self.campaign_s]
        return self._tell(word, f"Next: {self._named(to_come)}; {self.left_s:.0f} s are left.")

    def _named(self, tests: "Sequence[Excitation]") -> str:
        """Return tests in words."""
        words = [f"{one.name} ({one.periods} periods)" if isinstance(one, Leg) else one.name for one in tests]
        return ", ".join(words) or "the ramp out"
