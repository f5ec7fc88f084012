"""Do inertias and stiffnesses of a vessel file belong together? They give the first torsional mode of the line."""

from collections.abc import Iterator

import numpy as np

from shaftprint.card._disagreement import Disagreement
from shaftprint.torsion._line import torsional_line
from shaftprint.torsion._modes import modes
from shaftprint.vessel._vessel import Vessel

# Couplings of ships are tuned to 3 Hz and more, below the working orders of the engine and above what the governor
# does; below 1 Hz the governor could not hold the speed.
_LOWEST_HZ = 1.0


def first_mode(vessel: Vessel) -> Iterator[Disagreement]:
    """Yield a mode that no line of a ship has, with the link that twists most in it."""
    if not vessel.links:
        return
    # without damping: the slope of the propeller torque lets no line swing that is as soft
    mode = modes(torsional_line(vessel).without_damping)
    if not mode.frequency_hz.size or mode.frequency_hz[0] >= _LOWEST_HZ:
        return
    elastic = [number for number, link in enumerate(vessel.links, start=1) if not link.is_rigid]
    number = elastic[int(np.argmax(mode.elastic_share[0]))]
    link = vessel.links[number - 1]
    yield Disagreement(
        field=f"links[{number}].stiffness_nm_rad",
        expected=f"a stiffness with which the line swings at {_LOWEST_HZ:g} Hz or above, as a rule 3 to 30 Hz",
        found=f"{link.stiffness_nm_rad:g} N m/rad between {link.between[0]} and {link.between[1]}, with which its "
        f"first mode is at {mode.frequency_hz[0]:.2g} Hz",
        advice="correct it (N m/rad, not kN m/rad, on the link's own shaft) or the inertias",
        is_contradiction=True,
    )
