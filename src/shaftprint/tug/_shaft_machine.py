"""The electric machine on the gearbox of a simulated ship."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class ShaftMachineTruth:
    """A motor or a shaft generator whose converter controls its torque; the governor of the engine keeps the speed."""

    share: float
    """Torque of the machine over the shaft torque at the working point, negative where it is taken out."""
    torque_time_s: float = 0.0531
    """Time constant in which its torque follows what is asked for [s]."""
    delay_s: float = 0.0107
    """Time after which its torque begins to follow [s]."""
    shown: float = 1.0
    """Torque that the converter shows over the torque."""
    shown_rms: float = 0.002
    """Standard deviation of the noise of what it shows, over the shaft torque of the working point."""
