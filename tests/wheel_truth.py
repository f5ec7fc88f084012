"""Truth of a toothed wheel: when its teeth pass a pick-up while the shaft turns at a known, swinging speed.

Written from geometry alone: a tooth that begins at an angle passes when the shaft has turned by it. Nothing of the
product is used.
"""

from dataclasses import dataclass, field

import numpy as np

# Places of a wheel at which there is a tooth, in shares of a turn; the gaps of 36-2-1 are not opposite each other.
TEETH = {
    "60": np.arange(60) / 60,
    "60-2": np.arange(58) / 60,
    "36-1": np.arange(35) / 36,
    "36-2-1": np.array([place for place in range(36) if place not in (16, 34, 35)]) / 36,
    "12+1": np.append(np.arange(12), 4.45) / 12,
    "24": np.arange(24) / 24,
}
CLOSEST = {"60": 60, "60-2": 60, "36-1": 36, "36-2-1": 36, "12+1": 24, "24": 24}
"""Teeth all around if they stood as close as the closest two."""


@dataclass(kw_only=True)
class Turning:
    """A shaft that starts from rest or not, then turns at a speed that swings slowly and with each turn."""

    speed_rev_s: float = 5.0
    run_up_s: float = 0.0
    swing: float = 0.05
    swing_hz: float = 0.3
    ripple: float = 0.01
    orders: float = 3.2
    duration_s: float = 40.0
    start_rev: float = 0.37
    rest_s: float = 0.0

    def __post_init__(self):
        # fine enough that a straight line between two instants is right to 1e-9 of a turn
        self.fine_s = np.linspace(0.0, self.duration_s, round(self.duration_s * 20_000) + 1)
        time = self.fine_s - self.rest_s
        up = np.clip(time / self.run_up_s, 0.0, 1.0) if self.run_up_s else np.ones(time.size)
        base = self.speed_rev_s * up * (2.0 - up)
        base *= 1.0 + up * self.swing * np.sin(2 * np.pi * self.swing_hz * time)
        ripple_hz = self.orders * self.speed_rev_s
        self.fine_rev_s = base * (1.0 + up * self.ripple * np.sin(2 * np.pi * ripple_hz * time))
        step = self.fine_s[1]
        turned = np.concatenate([[0.0], np.cumsum(0.5 * (self.fine_rev_s[1:] + self.fine_rev_s[:-1]) * step)])
        self.fine_rev = turned + self.start_rev

    def speed_at(self, time_s):
        """True speed [rev/s]."""
        return np.interp(time_s, self.fine_s, self.fine_rev_s)

    def mean_speed(self, first_s, last_s):
        """Turns over time between two instants [rev/s]."""
        turned = np.interp([first_s, last_s], self.fine_s, self.fine_rev)
        return float((turned[1] - turned[0]) / (last_s - first_s))

    def passing(self, places_rev):
        """When the places of the wheel pass, in order, and which of them each is."""
        turns = np.arange(np.floor(self.fine_rev[0]), np.ceil(self.fine_rev[-1]) + 1)
        every = (turns[:, np.newaxis] + places_rev).ravel()
        which = np.tile(np.arange(places_rev.size), turns.size)
        inside = (every > self.fine_rev[0]) & (every < self.fine_rev[-1])
        order = np.argsort(every[inside])
        moving = np.flatnonzero(np.diff(self.fine_rev, prepend=self.fine_rev[0] - 1.0) > 0.0)
        time = np.interp(every[inside][order], self.fine_rev[moving], self.fine_s[moving])
        return time, which[inside][order]


@dataclass(kw_only=True)
class Pulses:
    """Rising and falling edges of a wheel [s], with what is wrong with them."""

    rising_s: np.ndarray
    falling_s: np.ndarray
    missing_s: list = field(default_factory=list)
    doubled_s: list = field(default_factory=list)

    def voltage(self, rate_hz, duration_s, *, noise_v=0.02, seed=0):
        """Samples of a pick-up with a pulse former: 0.3 V and 4.7 V, shape (samples,)."""
        time = np.arange(round(duration_s * rate_hz)) / rate_hz
        high = np.searchsorted(self.rising_s, time) - np.searchsorted(self.falling_s, time)
        rng = np.random.default_rng(seed)
        return 0.3 + 4.4 * (high > 0) + noise_v * rng.standard_normal(time.size)


def wheel_pulses(
    turning, wheel, *, duty=0.5, jitter_s=0.0, errors_rev=None, missing=(), doubled=(), bounce_s=1e-6, seed=0
):
    """Pulses of a wheel: teeth of a share of the distance of the closest, shifted by errors of their pitch.

    ``missing`` and ``doubled`` are numbers of teeth that pass; a doubled one comes twice, ``bounce_s`` apart.
    """
    places = TEETH[wheel].copy()
    errors = np.zeros(places.size) if errors_rev is None else errors_rev
    rng = np.random.default_rng(seed)
    rising, _ = turning.passing(places + errors)
    falling, _ = turning.passing(places + errors + duty / CLOSEST[wheel])
    falling = falling[falling > rising[0]][: rising.size]
    rising = rising[: falling.size]
    rising = rising + jitter_s * rng.standard_normal(rising.size)
    falling = falling + jitter_s * rng.standard_normal(falling.size)
    missing, doubled = list(missing), list(doubled)
    gone = [float(rising[k]) for k in missing]
    twice = [float(rising[k]) for k in doubled]
    extra_up = rising[doubled] + bounce_s
    extra_down = rising[doubled] + 0.5 * bounce_s
    return Pulses(
        rising_s=np.sort(np.concatenate([np.delete(rising, missing), extra_up])),
        falling_s=np.sort(np.concatenate([np.delete(falling, missing), extra_down])),
        missing_s=gone,
        doubled_s=twice,
    )
