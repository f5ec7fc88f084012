"""An output that counts the other way round than its structure: told before more starts look for what is nowhere."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.errors import IdentificationError
from shaftprint.time_domain._record import Record
from shaftprint.units import PERCENT

# The first starts leave more than this share of the outputs unexplained where one of them is turned, and with that
# turned back less than this share of it.
_LEFT, _OF_THAT = 0.25, 0.2


def expect_no_turned_output(
    one: EquippedDrive, records: Sequence[Record], left: float, left_of: Callable[[Sequence[Record]], float]
) -> None:
    """Check that no output, turned round, is explained far better than it is.

    ``left``: share of the outputs that the first starts leave unexplained. ``left_of``: the same of other records.
    Raises IdentificationError with the channel that is turned.
    """
    if left < _LEFT:
        return
    for output in one.drive.outputs:
        turned = [
            replace(record, outputs={**record.outputs, output.name: -record.outputs[output.name]}) for record in records
        ]
        then = left_of(turned)
        if then < _OF_THAT * left:
            raise IdentificationError(
                f'channel "{output.channel}": {one.structure.name} explains {PERCENT * (1.0 - then):.0f} % of the '
                f"records where it counts the other way round, and {PERCENT * (1.0 - left):.0f} % as it is; turn the "
                f"sensor, or state reversed = {'false' if output.reversed else 'true'} for {output.name} in the drive "
                "file."
            )
