"""Which register holds what: the file that the electrician fills in for a Modbus device.

All values that one question asks for are of one moment; so all of them must lie within the 125 registers of a question.
"""

from typing import Annotated, Final, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from shaftprint.settings import Name, Number, PositiveNumber, Settings, names_twice

REGISTERS: Final = {"int16": 1, "uint16": 1, "int32": 2, "uint32": 2, "float32": 2}
"""Registers of one value, by its kind."""
MOST_REGISTERS: Final = 125
"""Registers of one question."""
Address: TypeAlias = Annotated[int, Field(strict=True, ge=0, le=65535)]
"""Number of a holding register, counted from 0."""


class ModbusChannel(Settings):
    """A slow channel."""

    name: Name
    """Name, as in the vessel file."""
    unit: str = ""
    """Unit of its values."""
    address: Address
    """First of its holding registers."""
    kind: Literal["int16", "uint16", "int32", "uint32", "float32"]
    """What its registers are."""
    scale: Number = 1.0
    """Value of one count [unit]."""
    offset: Number = 0.0
    """Value at count zero [unit]."""


class ModbusDevice(Settings):
    """Registers by which the device is asked to do something, each a holding register counted from 0."""

    heartbeat: Address
    """Where the program writes its heartbeat, a number of 16 bits that goes round."""
    heartbeat_seen: Address
    """Where the device gives it back."""
    mode: Address
    """0 lever, 1 held, 2 playing, 3 ramping; 16 more where the key on the bridge is not turned."""
    set_point: Address
    """Where the program writes a set point, float32 [V of the campaign]: two registers."""
    set_point_out: Address
    """What the device puts out, float32 [V of the campaign]: two registers."""
    command: Address
    """Three registers that are written together: number, word (1 take, 2 write, 3 abort, 4 release), ramp [ms]."""
    answer: Address
    """Two registers: number of the last command, and 0, or why it is refused by the device's own list."""


class ModbusMap(Settings):
    """All registers of a link."""

    unit: int = Field(default=1, strict=True, ge=0, le=255)
    """Number of the device behind the address."""
    period_s: PositiveNumber = Field(default=0.1, ge=0.02, le=10.0)
    """Time from one question to the next [s]."""
    word_order: Literal["big", "little"] = "big"
    """Which of two registers has the high half; makers differ."""
    counter: Address
    """A number of 16 bits that the device's program counts up at least every second question: that it runs."""
    channel: tuple[ModbusChannel, ...] = Field(min_length=1, max_length=64)
    """Channels."""
    device: ModbusDevice | None = None
    """How the device is asked to do something; without it the link listens."""

    @model_validator(mode="after")
    def _fits_in_one_question(self) -> Self:
        names = [channel.name for channel in self.channel]
        twice = names_twice(names)
        if twice:
            raise ValueError(f"expected each channel once, found {', '.join(twice)} twice.")
        if self.count > MOST_REGISTERS:
            raise ValueError(
                f"expected all registers that are read within {MOST_REGISTERS}, so that their values are of one "
                f"moment, found {self.count} from {self.first} on."
            )
        return self

    def _read(self) -> list[tuple[int, int]]:
        """Return first register and number of registers of all that is read."""
        spans = [(channel.address, REGISTERS[channel.kind]) for channel in self.channel]
        spans.append((self.counter, 1))
        if self.device is not None:
            spans += [(self.device.heartbeat_seen, 1), (self.device.mode, 1)]
            spans += [(self.device.set_point_out, 2), (self.device.answer, 2)]
        return spans

    @property
    def first(self) -> int:
        """First register of the question."""
        return min(first for first, _ in self._read())

    @property
    def count(self) -> int:
        """Registers of the question."""
        return max(first + number for first, number in self._read()) - self.first
