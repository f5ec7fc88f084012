"""Lines of a DBC file that cannot be read, and what is lost with them."""

import re
from collections.abc import Sequence
from collections.abc import Set as AbstractSet

from shaftprint.escape import printable
from shaftprint.recording.readers.can._frames import EXTENDED

_MESSAGE = re.compile(rb"\s*BO_ +(\d+) +(\S+?) *: *(\d+) +\S+")
_SIGNAL = re.compile(rb"\s*SG_\s+([^:]+?)\s*:")
_OF_SIGNAL = re.compile(rb"\s*(?:BA_|CM_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_)\D*?\b(\d+)\s+(\w+)")
_OF_OTHERS = re.compile(rb"\s*(?:BA_|CM_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_|BO_TX_BU_|SIG_GROUP_|EV_)")
# where CANdb++ keeps signals of no message
_NO_MESSAGE = b"VECTOR__INDEPENDENT_SIG_MSG"
_SHORT_BITS = 11


def whole_messages(name: str, content: bytes) -> tuple[bytes, dict[str, str]]:
    """Return a DBC file without the messages whose own line is wrong, and why each is missing.

    The library would give their signals to the message before them. Lines keep their numbers.

    ``name``: name of the file. ``content``: what it holds.
    """
    left_out: dict[str, str] = {}
    lines = content.splitlines()
    is_lost = False
    for row, line in enumerate(lines):
        begins = line.lstrip()
        if begins.startswith(b"BO_ "):
            message = _MESSAGE.match(line)
            is_lost = (
                message is None or 1 << _SHORT_BITS <= int(message[1]) < EXTENDED or int(message[1]) >= 2 * EXTENDED
            )
            if message is None:
                left_out[f"line {row + 1} of {name}"] = "the message cannot be read."
            elif message[2] == _NO_MESSAGE:
                is_lost = True
            elif is_lost:
                number = int(message[1])
                left_out[printable(message[2].decode("latin-1"))] = (
                    f"identifier {number} has more than {_SHORT_BITS} bits and lacks bit 31; write {number | EXTENDED} "
                    f"in line {row + 1} of {name}."
                )
        elif not begins.startswith(b"SG_ "):
            # signals follow their message without other lines between, but for empty ones
            is_lost = is_lost and not begins
        if is_lost:
            lines[row] = b""
    return b"\n".join(lines), left_out


def lost_lines(
    name: str, content: bytes, numbers: Sequence[int], signals: AbstractSet[tuple[int, str]]
) -> dict[str, str]:
    """Return why each line is left out that the library could not read.

    What is said of a message or signal that is missing is no loss of its own.

    ``name``, ``content``: the file. ``numbers``: which lines, counted from 1. ``signals``: identifier, as the file has
    it, and name of the signals that were read.
    """
    lines = content.splitlines()
    lost: dict[str, str] = {}
    for number in dict.fromkeys(numbers):
        line = lines[number - 1] if 0 < number <= len(lines) else b""
        signal, of_signal = _SIGNAL.match(line), _OF_SIGNAL.match(line)
        if signal is not None:
            lost[f"line {number} of {name}"] = f"{printable(signal[1].decode('latin-1'))} cannot be read."
        elif of_signal is not None and (int(of_signal[1]), of_signal[2].decode("latin-1")) in signals:
            lost[f"line {number} of {name}"] = f"what it says of {of_signal[2].decode('latin-1')} cannot be read."
        elif _OF_OTHERS.match(line) is None:
            lost[f"line {number} of {name}"] = "it cannot be read."
    return lost
