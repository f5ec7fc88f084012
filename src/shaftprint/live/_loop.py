"""The loop of a live test: read a block, record it, judge it, and only then send the heartbeat."""

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.live._block import Block, Event
from shaftprint.live._counterpart import Counterpart
from shaftprint.live._outcome import Operator
from shaftprint.live._sight import Observer, Sight
from shaftprint.live._state import State, following
from shaftprint.live._watch import MISSING_S, AbortRule, Breach, Expected, Watch

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.live._play import Play
    from shaftprint.live._record import LiveRecord
    from shaftprint.vessel._vessel import Vessel

HEARTBEAT_S = 0.2
"""Time from one heartbeat to the next [s]."""


class AbortingError(Exception):
    """The way out of the loop when a rule is broken."""

    def __init__(self, breach: Breach) -> None:
        super().__init__(breach.sentence)
        self.breach = breach
        """The rule."""


@dataclass(kw_only=True)
class Loop:
    """What every part of a test stands on."""

    counterpart: Counterpart
    """The device on board."""
    vessel: "Vessel"
    """The installation."""
    record: "LiveRecord"
    """Where everything is kept."""
    operator: Operator = field(default_factory=Operator)
    """Who watches."""
    told: Callable[[Event], None] = lambda event: None
    """Is told of everything that happens."""
    shown: "Callable[[Loop, Sight], None]" = lambda test, sight: None
    """Is told of every block."""
    state: State = State.IDLE
    """What is done now."""
    beats: bool = False
    """Whether heartbeats are sent."""

    def __post_init__(self) -> None:
        """Begin at rest."""
        self._observer = Observer(self.vessel, self.counterpart.channels)
        self._watches: list[Watch] = []
        self._play: Play | None = None
        self._written: Play | None = None
        self._held_v = math.nan
        self._zero_s = math.nan
        self._since_s = math.nan
        self._sent: deque[tuple[int, float]] = deque()
        self._count = 0
        self._beaten_s = -math.inf
        self._last: Block | None = None

    @property
    def unanswered_s(self) -> float:
        """For how long the oldest heartbeat has not been answered [s]."""
        return self._last.stop_s - self._sent[0][1] if self._sent and self._last is not None else 0.0

    @property
    def is_ruling(self) -> bool:
        """Whether the program rules the set point."""
        return not math.isnan(self._since_s)

    @property
    def campaign_s(self) -> float:
        """Time of the campaign at the end of the last block [s]; not a number before it is played."""
        return math.nan if self._last is None else self._last.stop_s - self._zero_s

    async def next(self) -> Sight:
        """Read, record and judge the next block, then send the heartbeat; return what the block shows."""
        sight = self._observer.see(await self._new_block())
        expected = self._expected(sight)
        broken = (one.look(sight, expected) for one in self._watches)
        breach = next((one for one in broken if one is not None), None)
        self.shown(self, sight)
        if breach is None and self.operator.stops:
            breach = self._operator_breach(sight.time_s)
        if breach is not None and self.state is not State.ABORT:
            raise AbortingError(breach)
        if self.beats and sight.time_s - self._beaten_s >= HEARTBEAT_S - 1e-6:
            await self._beat(sight.time_s)
        if self._written is not None and self.is_ruling:
            await self.counterpart.write(self._value_now(self._written, sight))
        return sight

    def _value_now(self, play: "Play", sight: Sight) -> float:
        """Return the set point of the time until the next block, for a device that plays no table [V]."""
        middle_s = sight.time_s + 0.5 * sight.block.span_s
        if self._play is not None and middle_s < play.start_s:
            # until a change begins, what it follows on is put out
            play = self._play
        return float(play.value_at(np.array([middle_s]))[0])

    async def _new_block(self) -> Block:
        """Return the next block that has not been there, recorded; what the link says of it is kept too."""
        while True:
            block = await self.counterpart.read(MISSING_S)
            before = self._last
            self.record.block(block) if before is None or block.counter > before.counter else None
            for finding in block.findings:
                self._tell("link", finding, block.source_s)
            if before is None:
                self._last = block
                return block
            missing = block.counter - before.counter - 1
            if missing > 0:
                self._tell("lost", f"{missing} blocks before number {block.counter} were lost.", block.source_s)
            if missing < 0:
                self._tell("doubled", f"Block {block.counter} came again and is left out.", block.source_s)
                continue
            step_s = block.source_s - before.stop_s - missing * block.span_s
            if abs(step_s) > 0.5 * block.span_s:
                self._tell("clock", f"The clock of the counterpart has jumped by {step_s:.4g} s.", block.source_s)
            self._last = block
            while self._sent and self._sent[0][0] <= block.device.heartbeat:
                self._sent.popleft()
            return block

    async def _beat(self, time_s: float) -> None:
        self._count += 1
        self._beaten_s = time_s
        self._sent.append((self._count, time_s))
        await self.counterpart.beat(self._count)

    def _expected(self, sight: Sight) -> Expected:
        block = sight.block
        middle: FloatArray = np.linspace(block.source_s, block.stop_s, 5)
        # before the program rules, what the lever asks for
        held_v = self._held_v if self.is_ruling else block.device.set_point_v
        volts = held_v if self._play is None else float(self._play.value_at(middle).mean())
        if self._written is not None:
            # written late by the way to the device: what it says that it puts out is what was asked
            volts = block.device.set_point_v
        return Expected(
            set_point_v=volts,
            is_ruling=self.is_ruling,
            since_s=self._since_s,
            unanswered_s=self.unanswered_s if self.beats else 0.0,
        )

    def _operator_breach(self, time_s: float) -> Breach:
        return Breach(
            rule=AbortRule.OPERATOR,
            channel="operator",
            value=1.0,
            limit=0.0,
            unit="",
            persistence_s=0.0,
            time_s=time_s,
            why=self.operator.stops,
        )

    # ---- what is told ----

    def _enter(self, state: State) -> None:
        if state is not self.state:
            self.state = following(self.state, state)
            self._tell("state", str(state))

    def _tell(
        self, kind: str, sentence: str, time_s: float | None = None, facts: dict[str, str | float] | None = None
    ) -> None:
        now_s = time_s if time_s is not None else 0.0 if self._last is None else self._last.stop_s
        event = Event(time_s=now_s, kind=kind, sentence=sentence, facts=facts or {})
        self.record.event(event)
        self.told(event)
