"""Which components an imc file describes: where their samples lie, how they are scaled, when they were taken."""

from collections import Counter
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta

from shaftprint.recording.readers.imc._blocks import SAMPLES, Block, Parameters

# What imc writes where it knows no date.
_NO_DATE = datetime(1980, 1, 2)  # noqa: DTZ001 - the file says no zone
_OF_BUFFER, _OF_AXIS = 1, 2
_DEFAULT_ENCODING = "cp1252"
# Keys whose blocks say nothing of samples, their times or names.
_PASSED_OVER = ("NO", "Nv", "ND", "NU", "Np", "NE")


@dataclass(frozen=True, kw_only=True, slots=True)
class Axis:
    """The x axis of a component (CD)."""

    step: float
    """From one sample to the next, in its unit."""
    unit: str
    """Its unit; empty where it has none."""
    reduction: int
    """How samples were left out by the device; 0 where none were."""
    has_events: bool
    """Whether the recording was triggered several times."""
    start: float = 0.0
    """Place of the first sample, where the axis says it and not the buffer."""
    start_from: int = _OF_BUFFER
    """Who says that place."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Trigger:
    """The date of the trigger (NT)."""

    date: datetime
    """Date and time by the logger's clock."""
    zone_min: int = 0
    """What the file says of its zone [min]; 0 where it says nothing."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Packing:
    """How samples lie in their buffer (CP)."""

    buffer: int
    """Number of the buffer."""
    size: int
    """Length of a sample [bytes]."""
    kind: int
    """Type of its number."""
    mask: int
    """Bits that do not belong to it."""
    offset: int
    """Place of the first sample in the buffer [bytes]."""
    together: int
    """Samples that stand together."""
    apart: int
    """Bytes of others between them."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Buffer:
    """A stretch of samples (Cb)."""

    number: int
    """Its number, which a packing names."""
    block: int
    """Number of the block of samples that it lies in."""
    offset: int
    """Where it begins there [bytes]."""
    first: int
    """Where its first sample lies [bytes]; other than 0 in a ring."""
    filled: int
    """How much of it is filled [bytes]."""
    start: float
    """Place of its first sample on the x axis."""
    later_s: float
    """How much later than the trigger's date it was triggered [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Scale:
    """Unit and scale of a component (CR)."""

    unit: str = ""
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Name:
    """A channel that a component is shown as (CN)."""

    group: int
    bit: int
    """Number of its bit in digital words, from 1 on; 0 for whole numbers."""
    name: str
    comment: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Stored:
    """A block of samples (CS)."""

    begin: int
    """Where its samples begin in the file [bytes]."""
    length: int
    """Their length as the block states it [bytes]."""
    is_packed: bool
    """Whether they are compressed."""


@dataclass(kw_only=True, slots=True)
class Component:
    """A component of a field: values, or the x of values."""

    is_x: bool
    axis: Axis | None
    trigger: Trigger | None
    has_segments: bool
    has_events: bool = False
    packing: Packing | None = None
    buffers: list[Buffer] = field(default_factory=list)
    scale: Scale = field(default_factory=Scale)
    names: list[Name] = field(default_factory=list)

    @property
    def start(self) -> float:
        """Place of the first sample on the x axis, in its unit."""
        if self.axis is not None and self.axis.start_from != _OF_BUFFER:
            return self.axis.start if self.axis.start_from == _OF_AXIS else 0.0
        return self.buffers[0].start if self.buffers else 0.0

    @property
    def began(self) -> datetime | None:
        """Date of second 0 of the x axis; None where the file knows none."""
        later_s = self.buffers[0].later_s if self.buffers else 0.0
        date = None if self.trigger is None else self.trigger.date + timedelta(seconds=later_s)
        return date if date is not None and date >= _NO_DATE else None


@dataclass(kw_only=True, slots=True)
class Field:
    """Components that share an x axis (CG)."""

    kind: int
    """1 for values at even steps, 2 and 3 for values over an x of their own, others for complex numbers."""
    count: int
    """How many components it states."""
    components: list[Component] = field(default_factory=list)


@dataclass(kw_only=True, slots=True)
class Layout:
    """All that the blocks of a file say."""

    fields: list[Field] = field(default_factory=list)
    groups: dict[int, str] = field(default_factory=dict)
    stored: dict[int, Stored] = field(default_factory=dict)
    is_closed: bool = True
    single_values: list[str] = field(default_factory=list)
    """Names of single values and texts, which are no channels."""
    unknown: Counter[str] = field(default_factory=Counter)
    """Keys that were passed over though they may say something of samples."""
    _shared: list[Buffer] = field(default_factory=list)
    _component: Component | None = None
    _like: Component = field(default_factory=lambda: Component(is_x=False, axis=None, trigger=None, has_segments=False))
    """What holds for the components of a field that follow."""
    _encoding: str = _DEFAULT_ENCODING

    def learn(self, block: Block) -> None:
        """Take in one block; a ``ValueError`` where it is not what the format says."""
        said = Parameters(block.content)
        key = block.key
        if key in ("CG", "CB", "CT", "CI", SAMPLES):
            self._component = None
        if key == "CF":
            processor = said.whole()
            if (block.version, processor) != (2, 1):
                raise ValueError(f"it is of format {block.version}, processor {processor}; known are 2 and 1")
        elif key == "CK":
            said.whole()
            self.is_closed = said.whole() == 1
        elif key == "NL":
            self._encoding = f"cp{said.whole()}"
        elif key == "CB":
            number = said.whole()
            self.groups[number] = said.text(self._encoding)
        elif key == "CG":
            self._like = Component(is_x=False, axis=None, trigger=None, has_segments=False)
            count = said.whole()
            self.fields.append(Field(count=count, kind=said.whole()))
        elif key == "CC":
            if not self.fields:
                raise ValueError("a component stands before the first field")
            self._component = replace(
                self._like, is_x=said.whole() == 2, packing=None, buffers=[], scale=Scale(), names=[]
            )
            self.fields[-1].components.append(self._component)
        elif key in ("CT", "CI"):
            said.skip_words(2 if key == "CI" else 1)
            self.single_values.append(said.text(self._encoding))
        elif key == SAMPLES:
            self._learn_samples(block, said)
        elif key in ("CD", "NT", "CZ", "CV", "Cv", "Cb", "CP", "CR", "CN"):
            self._learn_component(block, said)
        elif key not in _PASSED_OVER:
            self.unknown[key] += 1

    def complete(self) -> None:
        """Give each component the buffers that its packing names; a ``ValueError`` where components are missing."""
        if any(len(each.components) != each.count for each in self.fields):
            raise ValueError("a field has other components than it states")
        for component in (one for each in self.fields for one in each.components):
            number = None if component.packing is None else component.packing.buffer
            own = [buffer for buffer in component.buffers if buffer.number == number]
            component.buffers = own or [buffer for buffer in self._shared if buffer.number == number]

    def _learn_samples(self, block: Block, said: Parameters) -> None:
        number = said.whole()
        is_packed, length = False, block.length - said.place
        if block.version == 2:
            is_packed, length = said.whole() != 0, said.whole()
            if length > block.length - said.place:
                raise ValueError(f"samples {number} are longer than their block")
        if number in self.stored:
            raise ValueError(f"samples {number} come twice")
        self.stored[number] = Stored(begin=block.begin + said.place, length=length, is_packed=is_packed)

    def _learn_component(self, block: Block, said: Parameters) -> None:
        """Take in a block that belongs to the component that is open, or else to all of its field."""
        component, key = self._component, block.key
        both = [self._like] if component is None else [self._like, component]
        if key == "Cb":
            count, noted = said.whole(), said.whole()
            buffers = [_buffer(said, noted) for _ in range(count)]
            (self._shared if component is None else component.buffers).extend(buffers)
        elif key == "CD":
            axis = _axis(block.version, said, self._encoding)
            for one in both:
                one.axis = axis
        elif key == "NT":
            trigger = _trigger(block.version, said)
            for one in both:
                one.trigger = trigger
        elif key == "CZ":
            for one in both:
                one.has_segments = True
        elif component is None:
            # events are listed behind the components that name them
            if key != "CV":
                raise ValueError(f"a block {key} belongs to no component")
        elif key in ("CV", "Cv"):
            component.has_events = True
        elif key == "CP":
            component.packing = _packing(said)
        elif key == "CR":
            is_scaled, factor, offset = said.whole() == 1, said.number(), said.number()
            said.whole()
            unit = said.text(self._encoding)
            component.scale = Scale(unit=unit, factor=factor, offset=offset) if is_scaled else Scale(unit=unit)
        else:
            group, _, bit = said.whole(), said.whole(), said.whole()
            name, comment = said.text(self._encoding), said.text(self._encoding)
            component.names.append(Name(group=group, bit=bit, name=name, comment=comment))


def _axis(version: int, said: Parameters, encoding: str) -> Axis:
    step, _ = said.number(), said.whole()
    unit = said.text(encoding)
    reduction, has_events, _ = said.whole(), said.whole() == 1, said.whole()
    if version == 1:
        return Axis(step=step, unit=unit, reduction=reduction, has_events=has_events)
    start, start_from = said.number(), said.whole()
    if start_from not in (0, _OF_BUFFER, _OF_AXIS):
        raise ValueError(f"the start of an axis is given in the way {start_from}, which is not known")
    return Axis(step=step, unit=unit, reduction=reduction, has_events=has_events, start=start, start_from=start_from)


def _trigger(version: int, said: Parameters) -> Trigger:
    day, month, year, hour, minute = (said.whole() for _ in range(5))
    date = datetime(year, month, day, hour, minute) + timedelta(seconds=said.number())  # noqa: DTZ001
    return Trigger(date=date, zone_min=said.whole() if version == 2 else 0)


def _packing(said: Parameters) -> Packing:
    buffer, size, kind, _, mask, offset, together, apart = (said.whole() for _ in range(8))
    if min(offset, apart) < 0:
        raise ValueError("samples begin before their buffer")
    return Packing(buffer=buffer, size=size, kind=kind, mask=mask, offset=offset, together=together, apart=apart)


def _buffer(said: Parameters, noted: int) -> Buffer:
    number, block, offset, length, first, filled, _ = (said.whole() for _ in range(7))
    start, later_s = said.number(), said.number()
    # what the writer noted for itself may hold commas
    said.skip(noted)
    if min(offset, first, filled) < 0 or filled > length:
        raise ValueError(f"buffer {number} is said to hold {filled} of {length} bytes")
    return Buffer(number=number, block=block, offset=offset, first=first, filled=filled, start=start, later_s=later_s)
