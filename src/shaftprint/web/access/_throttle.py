"""How often somebody may try to sign in: after a few wrong passwords he waits, longer each time.

They are counted by where they come from, and by name and where they come from: by name alone anybody could lock out
whom he likes. A browser from which somebody signed in before counts for itself.
"""

from dataclasses import dataclass, field
from ipaddress import IPv6Address, ip_address, ip_network
from typing import Final

FREE: Final = 5
"""Wrong passwords without waiting."""
LONGEST_S: Final = 900.0
"""The longest wait [s]."""
_FORGOTTEN_S: Final = 3600.0
_MOST: Final = 10_000


@dataclass(slots=True)
class Throttle:
    """Wrong passwords, by what they are counted by."""

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

    def succeeded(self, *keys: str, now: float) -> None:
        """Take back the last wrong password of these: others of the same address stay, whoever signs in between."""
        for key in keys:
            count, _ = self._tries.pop(key, (0, now))
            if count > 1:
                self._tries[key] = (count - 1, now)

    def _wait(self, key: str, now: float) -> float:
        count, last = self._tries.get(key, (0, now))
        if count < FREE:
            return 0.0
        return max(0.0, last + min(LONGEST_S, 2.0 ** (count - FREE)) - now)


def network_of(address: str) -> str:
    """Return what an address is counted by: itself, or for IPv6 the network that one customer gets."""
    try:
        known = ip_address(address)
    except ValueError:
        return address
    if not isinstance(known, IPv6Address):
        return address
    return str(known.ipv4_mapped or ip_network((known, 64), strict=False))
