"""Records that were read otherwise than they were meant: told before more starts look for what is nowhere.

An output may count the other way round than its structure, and a title may name A over values in mA, or s over ms.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.errors import IdentificationError
from shaftprint.time_domain._record import Record
from shaftprint.units import PERCENT

# The first starts leave more than this share of the outputs unexplained where one of them is turned, and with that
# turned back less than this share of it.
_LEFT, _OF_THAT = 0.25, 0.2
# Factors by which units are mistaken for each other.
_FACTORS = (1e-3, 1e3)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Other:
    """Another way to read the records."""

    records: Sequence[Record]
    """The records, read so."""
    what: str
    """What is read otherwise: a channel, or the times."""
    way: str
    """How it is read, in words that stand behind where."""
    advice: str
    """What to do where that explains the records."""


def expect_as_meant(
    one: EquippedDrive, records: Sequence[Record], left: float, left_of: Callable[[Sequence[Record]], float]
) -> None:
    """Check that no output that is turned round, and no factor of 1000, explains far more than the records as read.

    ``left``: share of the outputs that the first starts leave unexplained; infinite where no simulation stays within
    bounds. ``left_of``: the same of other records. Raises IdentificationError with the channel that is meant otherwise.
    """
    if left < _LEFT:
        return
    for kind in (_turned, _scaled):
        # a thousandth of the input may be a thousand of the output
        explaining = [
            (then, one_way) for one_way in kind(one, records) if (then := left_of(one_way.records)) < _OF_THAT * left
        ]
        if not explaining:
            continue
        (then, first), others = explaining[0], [other for _, other in explaining[1:]]
        as_it_is = f"{PERCENT * (1.0 - left):.0f} % as it is" if left <= 1.0 else "nothing as it is"
        ways = "".join(f", or where of {other.what} {other.way}" for other in others)
        raise IdentificationError(
            f"{first.what}: {one.structure.name} explains {PERCENT * (1.0 - then):.0f} % of the records where "
            f"{first.way}{ways}, and {as_it_is}; {first.advice}."
        )


def _turned(one: EquippedDrive, records: Sequence[Record]) -> Iterator[_Other]:
    for output in one.drive.outputs:
        yield _Other(
            records=[_times(record, output.name, -1.0) for record in records],
            what=f'channel "{output.channel}"',
            way="it counts the other way round",
            advice=f"turn the sensor, or state reversed = {'false' if output.reversed else 'true'} for {output.name} "
            "in the drive file",
        )


def _scaled(one: EquippedDrive, records: Sequence[Record]) -> Iterator[_Other]:
    for factor in _FACTORS:
        for signal in one.drive.signals:
            yield _Other(
                records=[_times(record, signal.name, factor) for record in records],
                what=f'channel "{signal.channel}"',
                way=f"the values are {factor:g} {signal.unit} each",
                advice="correct the unit in the title of the recording and in the row of the drive file",
            )
        yield _Other(
            records=[
                replace(record, rate_hz=record.rate_hz / factor, start_s=record.start_s * factor) for record in records
            ],
            what="times",
            way=f"they count {factor:g} s each",
            advice="correct the unit in the title of the column of times, such as [ms], or read it with --sample-rate "
            f"{records[0].rate_hz / factor:.6g}",
        )


def _times(record: Record, name: str, factor: float) -> Record:
    """Return a record with a signal times a factor."""
    if name in record.inputs:
        inputs, drive = ({**signals, name: factor * signals[name]} for signals in (record.inputs, record.drive))
        return replace(record, inputs=inputs, drive=drive)
    return replace(record, outputs={**record.outputs, name: factor * record.outputs[name]})
