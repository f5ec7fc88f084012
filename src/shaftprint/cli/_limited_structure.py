"""The gauge-aware closed loop with limits by the names of these: ``GAUGE-QUADRATIC``, ``GAUGE-TORQUE-RATE``."""

from shaftprint.models import STRUCTURES, Structure, limited

_PREFIX, _NONE = "GAUGE-", "QUADRATIC"
_LIMITS = ("TORQUE", "RATE", "DEADBAND", "SMOKE")


def limited_structure(name: str) -> Structure | None:
    """Return the structure with the limits that stand in a name, in capitals or not; None if it names none.

    Raises
    ------
    StructureError
        If the limits do not go together.
    """
    upper = name.upper()
    if upper in STRUCTURES or not upper.startswith(_PREFIX):
        return None
    limits = upper.removeprefix(_PREFIX).split("-")
    if limits == [_NONE]:
        return limited()
    return limited(*(limit.lower() for limit in limits)) if set(limits) <= set(_LIMITS) else None
