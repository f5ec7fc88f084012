"""Names of states in drive files of earlier versions, which called them after the kind of their block."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from shaftprint.drive._blocks import BlockKind
from shaftprint.drive._drive import Drive

# What a state was called that now is called as the output of its block; others had what stands behind it now.
FORMER: Mapping[BlockKind, str] = MappingProxyType(
    {"integrator": "sum", "pi": "sum", "first-order-lag": "lag", "second-order-lag": "lag"}
)


def start_by_names_of_today(drive: Drive, names: Sequence[str]) -> dict[str, float]:
    """Return the states at the start of a drive, those with a name of earlier versions under that of today.

    What cannot be put under another name keeps its own: of a lag with a gain the state was what the gain was applied
    to, so that only zero means the same now.
    """
    today = _former_names(drive, names)
    gains = {block.output: block.parameters.get("gain", 1.0) for block in drive.blocks if "lag" in block.kind}
    start = {}
    for state in drive.start:
        name, output = today.get(state.name, (state.name, ""))
        # what begins at a parameter begins at zero beside it
        value = 0.0 if isinstance(state.value, str) else state.value
        is_same = value == 0.0 or gains.get(output, 1.0) == 1.0
        start[state.name if state.name in names or not is_same else name] = value
    return start


def _former_names(drive: Drive, names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Return states by their former names: the name of today and the output of the block."""
    blocks = {block.output: block for block in drive.blocks}
    former: dict[str, tuple[str, str]] = {}
    words: list[str] = []
    for name in names:
        output = max((block for block in blocks if f"{name} ".startswith(f"{block} ")), key=len, default="")
        if not output:
            continue
        kind = blocks[output].kind
        behind = name.removeprefix(output).strip()
        words.append(behind if behind not in ("", "integral") else FORMER.get(kind, name))
        count = words.count(words[-1])
        former[words[-1] if count == 1 else f"{words[-1]} {count}"] = (name, output)
    return former
