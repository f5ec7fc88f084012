"""How often somebody may try to sign in: after a few wrong passwords he waits, longer each time."""

from dataclasses import dataclass, field
from typing import Final

FREE: Final = 5
"""Wrong passwords without waiting."""
LONGEST_S: Final = 900.0
"""The longest wait [s]."""
_FORGOTTEN_S: Final = 3600.0
_MOST: Final = 10_000


@dataclass(slots=True)
class Throttle:
    """Wrong passwords of each name and of each address."""

    _tries: dict[str, tuple[int, float]] = field(default_factory=dict)

    def wait_s(self, *keys: str, now: float) -> float:
        """Return how long these have to wait before they may try again [s]."""
        return max((self._wait(key, now) for key in keys), default=0.0)

    def failed(self, *keys: str, now: float) -> None:
        """Note a wrong password of these."""
        for key in keys:
            count, last = self._tries.pop(key, (0, now))
            self._tries[key] = (1 if now - last > _FORGOTTEN_S else count + 1, now)
        while len(self._tries) > _MOST:
            self._tries.pop(next(iter(self._tries)))

    def succeeded(self, *keys: str) -> None:
        """Forget the wrong passwords of these."""
        for key in keys:
            self._tries.pop(key, None)

    def _wait(self, key: str, now: float) -> float:
        count, last = self._tries.get(key, (0, now))
        if count < FREE:
            return 0.0
        return max(0.0, last + min(LONGEST_S, 2.0 ** (count - FREE)) - now)
