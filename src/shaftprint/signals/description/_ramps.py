"""How the set point goes to legs and back: the one time or rate of all ramps."""

from collections.abc import Sequence

import numpy as np

from shaftprint.signals.description._pieces import Piece, Straight
from shaftprint.signals.description._plain import plainest

# Rates are alike within this share; times count where rates are not.
_ALIKE = 0.02
# Where no ramp was seen the set point jumped: a ramp that is none [s].
_JUMP_S = 0.01


def ramp_fields(ramps: Sequence[Straight]) -> dict[str, float]:
    """Return the time or rate of ramps, whichever they share; that of a jump where there are none."""
    if not ramps:
        return {"ramp_s": _JUMP_S}
    lengths = np.array([ramp.length_s for ramp in ramps])
    slopes = np.abs([ramp.slope_v_per_s for ramp in ramps])
    apart_s, apart_v = (float(np.ptp(values) / values.mean()) for values in (lengths, slopes))
    apart_v = 0.0 if apart_v <= _ALIKE else apart_v
    weights = lengths**3
    if apart_v <= apart_s:
        rate = float(slopes @ weights / weights.sum())
        return {"ramp_v_per_s": plainest(rate, 1e-3 * rate)}
    # the end of a ramp of few volts is seen badly
    volts = (slopes * lengths) ** 2
    time_s = float(lengths @ volts / volts.sum())
    return {"ramp_s": plainest(time_s, 0.005 * time_s)}


def ramps_beside(pieces: Sequence[Piece | object], legs: Sequence[int]) -> list[int]:
    """Return the places of the ramps that lead to legs or away from them, with a wait beside them at most."""
    found = set()
    for leg in legs:
        for step in (-1, 1):
            k = leg + step
            if step == 1 and _is_level(pieces, k):
                k += step
            if 0 <= k < len(pieces):
                piece = pieces[k]
                if isinstance(piece, Straight) and piece.slope_v_per_s != 0.0:
                    found.add(k)
    return sorted(found)


def _is_level(pieces: Sequence[Piece | object], place: int) -> bool:
    if not 0 <= place < len(pieces):
        return False
    piece = pieces[place]
    return isinstance(piece, Straight) and piece.slope_v_per_s == 0.0


def ramps_made_faster(fields: dict[str, float], times: float) -> dict[str, float]:
    """Return the time or rate of ramps that are so many times as fast."""
    return {name: value * times if name == "ramp_v_per_s" else value / times for name, value in fields.items()}
