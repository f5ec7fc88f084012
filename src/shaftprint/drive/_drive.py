"""The noun of the room: a drive as its file describes it."""

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from shaftprint.arguments import refusing_none
from shaftprint.drive._blocks import Block, FreeParameter
from shaftprint.drive._responses import EstimatedResponse, ResponseColumns
from shaftprint.drive._signals import KnownParameter, PerRecord, SearchedParameter, Signal, StartState, Stretch
from shaftprint.errors import SettingsError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.settings import Name, PositiveNumber, Settings, names_twice, read_settings
from shaftprint.spelling import listed


class FitWay(Settings):
    """How records are compared with the structure."""

    start: Literal["steady", "found", "known"] = "steady"
    """How a record begins: in steady running at its first inputs, in states that are found, in those of ``start``."""
    offset: Literal["none", "constant", "drift"] = "constant"
    """What the sensors of the outputs may add: nothing, a constant that is found, or a line in time."""
    inputs_hold: Annotated[bool, Field(strict=True)] | None = None
    """true if an input is a step between samples, as the output of a PLC, computer or drive (zero-order hold); false if
    it was sampled from an analogue signal, and is taken as a straight line from sample to sample. If not given, the
    records of an identification tell it, where an input jumps; elsewhere it is false."""
    longest_step_s: PositiveNumber | None = None
    """Longest step of the simulation [s]; a quarter of the time between samples where not given."""


class Drive(Shown, Settings):
    """A line that is no ship's: its signals, its structure, and what is known of it."""

    name: Name
    """Name of the drive."""
    structure: Name | None = None
    """Name of a shipped structure, such as ``MOTOR``; none where blocks are composed, or the command names one."""
    inputs: tuple[Signal, ...]
    """What drives it."""
    outputs: tuple[Signal, ...]
    """What was measured of its motion."""
    known: tuple[KnownParameter, ...] = ()
    """Parameters that are known, exactly or with a standard deviation."""
    searched: tuple[SearchedParameter, ...] = ()
    """Parameters that are free between other bounds than those of the structure, or free although usually held."""
    per_record: tuple[PerRecord, ...] = ()
    """Parameters that have a value of their own in each record."""
    start: tuple[StartState, ...] = ()
    """States at the start of every record; those that are not named are zero."""
    records: tuple[Stretch, ...] = ()
    """Parts of each recording that are records; the whole recording where none is named."""
    responses: tuple[ResponseColumns, ...] = ()
    """Columns of files that hold frequency responses in place of records."""
    frequency_response: EstimatedResponse | None = None
    """How records are turned into frequency responses, which are fitted in place of them."""
    blocks: tuple[Block, ...] = ()
    """Blocks that make the structure."""
    parameters: tuple[FreeParameter, ...] = ()
    """Parameters of these blocks."""
    fit: FitWay = FitWay()
    """How records are compared with the structure."""

    def summary(self) -> Summary:
        """Return structure, signals and what is known."""
        facts = {
            "structure": self.structure or ("composed of blocks" if self.blocks else "given with the command"),
            "inputs": shortened(map(_signal_words, self.inputs)),
            "outputs": shortened(map(_signal_words, self.outputs)),
            "known": shortened(f"{one.name} = {one.value:g} ± {one.std:g}" for one in self.known),
            "records": shortened(one.name for one in self.records),
        }
        return Summary(title=f"Drive {self.name}", facts=facts)

    @property
    def signals(self) -> tuple[Signal, ...]:
        """All signals, inputs first."""
        return (*self.inputs, *self.outputs)

    @model_validator(mode="after")
    def _belongs_together(self) -> Self:
        tables: dict[str, list[str]] = {
            "inputs and outputs": [one.name for one in self.signals],
            "known and searched": [*(one.name for one in self.known), *(one.name for one in self.searched)],
            "per_record": [one.name for one in self.per_record],
            "start": [one.name for one in self.start],
            "records": [one.name for one in self.records],
            "parameters": [one.name for one in self.parameters],
            "blocks (output)": [one.output for one in self.blocks],
        }
        errors = [
            f"expected every row of {table} to have its own name, found {', '.join(twice)} twice."
            for table, names in tables.items()
            if (twice := names_twice(names))
        ]
        # a row that cannot be used is not counted by pydantic, so that a least number would be told beside it
        errors += [
            f"expected one row of {name} or more, found none."
            for name in ("inputs", "outputs")
            if not getattr(self, name)
        ]
        if self.structure is not None and self.blocks:
            errors.append(f'expected structure or [[blocks]], found structure = "{self.structure}" and blocks.')
        begins = [one.value for one in self.start if isinstance(one.value, str)]
        unused = [one.name for one in self.parameters if not self.blocks and one.name not in begins]
        if unused:
            errors.append(
                "expected [[parameters]] beside [[blocks]], or named by [[start]]; of a structure write [[known]], "
                "[[searched]]."
            )
        unknown = [name for name in begins if name not in {one.name for one in self.parameters}]
        if unknown:
            errors.append(f"expected a number or one of [[parameters]] as value of [[start]], found {unknown[0]!r}.")
        if bool(self.start) != (self.fit.start == "known"):
            errors.append('expected [[start]] and fit.start = "known" together, found one of them alone.')
        errors += self._faults_of_responses() if self.responses else self._faults_of_channels()
        if errors:
            raise ValueError(" ".join(errors))
        return self

    def _faults_of_channels(self) -> list[str]:
        missing = [one.name for one in self.signals if one.channel is None]
        if missing:
            return [f"expected the channel of {missing[0]}, found none."]
        (twice, *_) = names_twice([str(one.channel) for one in self.signals]) or (None,)
        shared = [one.name for one in self.signals if one.channel == twice]
        return [] if twice is None else [f"expected every signal its own channel, found {twice} for {listed(shared)}."]

    def _faults_of_responses(self) -> list[str]:
        only = self.inputs[0].name if len(self.inputs) == 1 else None
        rows = [(one.output, one.input or only) for one in self.responses]
        wanted = [(out.name, into.name) for out in self.outputs for into in self.inputs]
        errors = [
            f"expected one row of [[responses]] from {into} to {out}, found {rows.count((out, into))}."
            for out, into in wanted
            if rows.count((out, into)) != 1
        ]
        foreign = [row for row in rows if row not in wanted]
        if foreign:
            errors.append(f"expected responses from inputs to outputs, found {foreign[0][1]} to {foreign[0][0]}.")
        if self.records or self.start or self.frequency_response is not None:
            errors.append("expected no [[records]], [[start]] or [frequency_response] beside [[responses]].")
        return errors


def _signal_words(signal: Signal) -> str:
    source = f" from {signal.channel}" if signal.channel is not None else ""
    return f"{signal.name}{source} [{signal.unit}]"


@refusing_none(SettingsError)
def load_drive(path: str | Path) -> Drive:
    """Read a drive file.

    Raises
    ------
    SettingsError
        If the file cannot be used; the message lists every field that is wrong.
    """
    return read_settings(path, Drive)
