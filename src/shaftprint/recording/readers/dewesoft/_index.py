"""What the program that unpacks Dewesoft files tells of each channel."""

from dataclasses import asdict, dataclass

INDEX = "index.json"


@dataclass(frozen=True, kw_only=True, slots=True)
class UnpackedChannel:
    """One channel of a Dewesoft file."""

    name: str
    """Name of the channel."""
    unit: str
    """Unit of its values."""
    description: str = ""
    """What it is, in words."""
    number: int = -1
    """Number of its files in the folder."""
    count: int = 0
    """Number of samples."""
    rate_hz: float = 0.0
    """Sample rate [Hz]; 0 where every sample has its own time."""
    start_s: float = 0.0
    """Time of the first sample [s]."""
    reason: str = ""
    """Why it cannot be used; empty where it can."""

    def as_dict(self) -> dict[str, object]:
        """Return all of it under the names of its fields."""
        return asdict(self)
