"""A simulated ship behind a counterpart that keeps the contract, or breaks it where it is told to."""

import asyncio
import math
from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import Abilities
from shaftprint.live._play import Play
from shaftprint.live.counterparts._faults import LinkFaults

if TYPE_CHECKING:
    from shaftprint.tug._stepped import SteppedTug
    from shaftprint.tug._truth import Truth

# A revert is a short cosine, so that a lever that was moved meanwhile does not come as a jump [s].
_REVERT_RAMP_S = 0.2
# A play that begins farther from what is put out is refused: nothing may jump at a change [V].
_LARGEST_BUMP_V = 0.02
_ROUNDING_S = 1e-9


class SimulatedDevice:
    """The device on board, without its link: who rules the set point, and what it puts out.

    It is what a program of a PLC is to do: revert without heartbeat, refuse what would jump, ramp back on an abort.
    """

    def __init__(self, *, lever_v: float, faults: LinkFaults) -> None:
        self.lever_v = lever_v
        """What the lever asks for [V]."""
        self.mode = DeviceMode.LEVER
        """Who rules the set point."""
        self.heartbeat = 0
        """The last heartbeat that it has heard."""
        self._faults = faults
        self._heard_s = -math.inf
        self._held_v = lever_v
        self._play: Play | None = None
        self._next: Play | None = None
        self._ramp: tuple[float, float, float] = (0.0, 1.0, lever_v)
        self._stuck_v: float | None = None

    def hear(self, count: int, time_s: float) -> None:
        """Take a heartbeat."""
        if count != self.heartbeat:
            self.heartbeat, self._heard_s = count, time_s

    def take(self, time_s: float) -> None:
        """Take the set point over at the lever's value. Raises LiveError without a heartbeat."""
        if time_s - self._heard_s > self._faults.revert_s:
            raise LiveError("the counterpart does not take the set point over: expected a heartbeat, found none.")
        self.mode, self._held_v, self._play, self._next = DeviceMode.HELD, self.lever_v, None, None

    def write(self, volts: float) -> None:
        """Hold a set point [V]. Raises LiveError while the lever rules."""
        self._expect_ruling()
        self.mode, self._held_v, self._play, self._next = DeviceMode.HELD, volts, None, None

    def play(self, play: Play, time_s: float) -> None:
        """Take a waveform that begins later. Raises LiveError if it would jump, or is late."""
        self._expect_ruling()
        if not np.isfinite(play.volts).all() or play.volts.size < 1:
            raise LiveError(f"{play.name}: expected set points that are numbers, found others.")
        if play.start_s < time_s - _ROUNDING_S:
            raise LiveError(
                f"{play.name}: expected a start after {time_s:.3f} s, found {play.start_s:.3f} s; it came too late."
            )
        bump_v = abs(float(play.volts[0]) - float(self._asked(np.array([play.start_s]))[0]))
        if bump_v > _LARGEST_BUMP_V:
            raise LiveError(
                f"{play.name}: expected a start within {_LARGEST_BUMP_V:g} V of what is put out then, found "
                f"{bump_v:.3g} V; nothing may jump."
            )
        self._next = play

    def abort(self, ramp_s: float, time_s: float) -> None:
        """Go back to the lever's value on a cosine of this length [s]."""
        if self.mode in (DeviceMode.HELD, DeviceMode.PLAYING) and not self._faults.ignores_abort:
            self._begin_ramp(time_s, ramp_s)

    def release(self) -> None:
        """Give the set point back to the lever."""
        self.mode, self._play, self._next = DeviceMode.LEVER, None, None

    def advance(self, time_s: float) -> None:
        """Look at the clock before the next block."""
        start_s, length_s, _ = self._ramp
        if self.mode is DeviceMode.RAMPING and time_s >= start_s + length_s - _ROUNDING_S:
            self.release()
        if self.mode in (DeviceMode.HELD, DeviceMode.PLAYING) and time_s - self._heard_s > self._faults.revert_s:
            self._begin_ramp(time_s, _REVERT_RAMP_S)
        if self.mode in (DeviceMode.HELD, DeviceMode.PLAYING) and self._next is not None:
            self.mode = DeviceMode.PLAYING

    def volts(self, time_s: FloatArray) -> FloatArray:
        """Return what it puts out over times until the next look at the clock [V]."""
        if self._faults.stuck_set_point.holds(float(time_s[0])):
            if self._stuck_v is None:
                self._stuck_v = float(self._asked(time_s[:1])[0])
            return np.full(time_s.shape, self._stuck_v)
        return self._asked(time_s)

    def pass_on(self, time_s: float) -> None:
        """Forget a waveform in whose place another has come."""
        if self._next is not None and time_s >= self._next.start_s:
            self._play, self._next = self._next, None

    def _asked(self, time_s: FloatArray) -> FloatArray:
        """Return what it means to put out [V]."""
        if self.mode is DeviceMode.LEVER:
            return np.full(time_s.shape, self.lever_v)
        if self.mode is DeviceMode.RAMPING:
            start_s, length_s, from_v = self._ramp
            share = np.clip((time_s - start_s) / length_s, 0.0, 1.0)
            ramp: FloatArray = self.lever_v + (from_v - self.lever_v) * 0.5 * (1.0 + np.cos(math.pi * share))
            return ramp
        now = np.full(time_s.shape, self._held_v) if self._play is None else self._play.value_at(time_s)
        if self._next is None:
            return now
        return np.where(time_s >= self._next.start_s - _ROUNDING_S, self._next.value_at(time_s), now)

    def _begin_ramp(self, time_s: float, length_s: float) -> None:
        self._ramp = (time_s, length_s, float(self._asked(np.array([time_s]))[0]))
        self.mode, self._play, self._next = DeviceMode.RAMPING, None, None

    def _expect_ruling(self) -> None:
        if self.mode not in (DeviceMode.HELD, DeviceMode.PLAYING):
            raise LiveError(
                f'the counterpart takes no set point: expected it to rule, found "{self.mode}"; take over first.'
            )


class SimulatedShip:
    """A ship and its device on one clock; whoever asks for the next block lets it sail on."""

    def __init__(
        self, ship: "SteppedTug", *, lever_v: float, faults: LinkFaults | None = None, block_samples: int = 100
    ) -> None:
        self.faults = LinkFaults() if faults is None else faults
        """What is wrong."""
        self.device = SimulatedDevice(lever_v=lever_v, faults=self.faults)
        """Who rules the set point."""
        self.span_s = block_samples / ship.rate_hz
        """Length of a block [s]."""
        self.trace: list[tuple[float, float, float, float, str]] = []
        """Of each block its time [s], and at its end set point [V], engine speed [rpm], shaft torque [N m] and who
        rules: what really happened."""
        self._ship, self._samples, self._ratio = ship, block_samples, ship.gear_ratio
        self._count = 0
        self._last: dict[str, NDArray[Any]] = {}

    @property
    def time_s(self) -> float:
        """Present time of the device's clock, without its fault [s]."""
        return self._ship.time_s

    @property
    def truth(self) -> "Truth":
        """What was put into its samples so far."""
        return self._ship.truth

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """What it sends."""
        # counts have no way to say that there is no number
        as_values = math.isfinite(self.faults.not_a_number.start_s)
        return tuple(
            LiveChannel(
                name=one.name,
                unit=one.unit,
                rate_hz=one.rate_hz,
                scale=1.0 if as_values else one.scale,
                offset=0.0 if as_values else one.offset,
                dtype="float64" if as_values else "int16",
                long_name=one.long_name,
            )
            for one in self._ship.channels
        )

    @property
    def is_silent(self) -> bool:
        """Whether nothing goes over its link."""
        return self.faults.frozen.holds(self.time_s) or self.faults.silent.holds(self.time_s)

    def hear(self, count: int) -> None:
        """Take a heartbeat, where it is not deaf and its link not silent."""
        if not (self.is_silent or self.faults.deaf.holds(self.time_s)):
            self.device.hear(count, self.time_s)

    def obey(self, word: str, content: Mapping[str, Any]) -> None:
        """Do what a command says; raises LiveError with the reason where the device refuses it."""
        device, now_s = self.device, self.time_s
        match word:
            case "take":
                device.take(now_s)
            case "write":
                device.write(float(content["volts"]))
            case "play":
                start_s, rate_hz = float(content["start_s"]), float(content["rate_hz"])
                volts = np.asarray(content["volts"], dtype=np.float64)
                name = str(content.get("name", "what is played"))
                device.play(Play(name=name, start_s=start_s, rate_hz=rate_hz, volts=volts), now_s)
            case "abort":
                device.abort(float(content["ramp_s"]), now_s)
            case _:
                device.release()

    def sail(self) -> list[Block]:
        """Sail on by one block; return what is sent of it: nothing where it is lost, two where it is doubled."""
        device, faults, time_s = self.device, self.faults, self.time_s
        device.advance(time_s)
        stretch, counts = self._ship.step(self._samples, device.volts)
        self._count += 1
        stop_s = self.time_s
        put_out_v = float(device.volts(np.array([stop_s]))[0])
        device.pass_on(stop_s)
        self.trace.append(
            (
                stop_s,
                put_out_v,
                60.0 * self._ratio * float(stretch.engine_speed_rev_s[-1]),
                float(stretch.shaft_torque_nm[-1]),
                device.mode,
            )
        )
        samples = self._last if faults.stale.holds(time_s) and self._last else self._samples_of(counts, time_s)
        self._last = samples
        block = Block(
            counter=self._count,
            source_s=time_s + (faults.clock_step_s if time_s >= faults.clock_step_at_s else 0.0),
            span_s=self.span_s,
            samples=samples,
            device=DeviceStatus(mode=device.mode, heartbeat=device.heartbeat, set_point_v=put_out_v),
            received_s=stop_s,
        )
        if self._count in faults.lost:
            return []
        return [block, block] if self._count in faults.doubled else [block]

    def _samples_of(self, counts: dict[str, NDArray[np.int16]], time_s: float) -> dict[str, NDArray[Any]]:
        """Return what is sent of the counts: themselves, or values of which those of one channel are none."""
        if not math.isfinite(self.faults.not_a_number.start_s):
            return dict(counts)
        values: dict[str, NDArray[Any]] = {
            one.name: counts[one.name] * one.scale + one.offset for one in self._ship.channels if one.name in counts
        }
        if self.faults.not_a_number.holds(time_s):
            values[self.faults.channel] = np.full(values[self.faults.channel].shape, math.nan)
        return values


class SimulatedCounterpart:
    """A simulated ship in the same program: as fast as it can be calculated, or in the time of a clock."""

    abilities = Abilities(plays_waveform=True, writes_set_point=True, reverts=True, ramps=True)
    """What it can do."""

    def __init__(
        self,
        ship: SimulatedShip,
        *,
        name: str = "simulated ship",
        pace: float | None = None,
        plays_waveform: bool = True,
    ) -> None:
        self.abilities = replace(self.abilities, plays_waveform=plays_waveform)
        self.name = name
        """What it is called."""
        self.ship = ship
        """What sails."""
        self._pace = pace
        self._began: tuple[float, float] | None = None
        self._waiting: deque[Block] = deque()

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels."""
        return self.ship.channels

    async def connect(self) -> None:
        """Begin to sail."""

    async def read(self, timeout_s: float) -> Block:
        """Return the next block; raise SilentLinkError if none comes in time, while the ship sails on."""
        begin_s = self.ship.time_s
        while not self._waiting or self.ship.is_silent:
            if self.ship.time_s - begin_s >= timeout_s - _ROUNDING_S:
                raise SilentLinkError(f"{self.name}: expected a block within {timeout_s:g} s, found none.")
            silent = self.ship.faults.silent.holds(self.ship.time_s)
            blocks = self.ship.sail()
            if not silent:
                self._waiting.extend(blocks)
            await self._keep_pace()
        return self._waiting.popleft()

    async def beat(self, count: int) -> None:
        """Send the heartbeat."""
        self._expect_link()
        self.ship.hear(count)

    async def take(self) -> None:
        """Take the set point over."""
        self._expect_link()
        self.ship.device.take(self.ship.time_s)

    async def write(self, volts: float) -> None:
        """Write a set point."""
        self._expect_link()
        self.ship.device.write(volts)

    async def play(self, play: Play) -> None:
        """Play a waveform."""
        self._expect_link()
        self.ship.device.play(play, self.ship.time_s)

    async def abort(self, ramp_s: float) -> None:
        """Go back to the lever on a cosine."""
        self._expect_link()
        self.ship.device.abort(ramp_s, self.ship.time_s)

    async def release(self) -> None:
        """Give the set point back to the lever now."""
        self._expect_link()
        self.ship.device.release()

    async def close(self) -> None:
        """Let go of it; the ship keeps its lever."""

    def clock(self) -> float:
        """Return the present time of the ship [s]."""
        return self.ship.time_s

    def _expect_link(self) -> None:
        if self.ship.is_silent:
            raise SilentLinkError(f"{self.name}: expected an answer, found none.")

    async def _keep_pace(self) -> None:
        """Let the others work, and wait until a clock has come as far as the ship."""
        if self._pace is None:
            await asyncio.sleep(0.0)
            return
        loop = asyncio.get_running_loop()
        if self._began is None:
            self._began = loop.time(), self.ship.time_s
        wall_s, ship_s = self._began
        await asyncio.sleep(max(0.0, wall_s + (self.ship.time_s - ship_s) / self._pace - loop.time()))
