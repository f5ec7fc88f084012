"""What the two propellers of a simulated ship share: each other's wash, and the sea."""

from dataclasses import dataclass

from shaftprint.errors import SettingsError


@dataclass(frozen=True, kw_only=True, slots=True)
class SharedWater:
    """Truth of the water around two propellers at the quay.

    The wash of one propeller raises the inflow of the other, which takes less torque then: by the share ``c`` for a
    wash twice as fast, ``M_p = K n_s |n_s| (1 - c (u / u_0 - 1))``, as the other inflow that disturbs the simulated
    ship. The wash ``u`` follows the other shaft by a lag, and gets there after a time.
    """

    port_share: float = 0.01
    """``c`` of the port propeller in the wash of the starboard one."""
    starboard_share: float = 0.01
    """``c`` of the starboard propeller in the wash of the port one."""
    wash_delay_s: float = 0.25
    """Time in which the wash gets to the other propeller [s], rounded to whole steps; two steps at least."""
    wash_lag_s: float = 0.4
    """Time constant in which the wash follows its propeller [s]."""
    sea_share: float = 0.5
    """Share of the variance of inflow and surge that both propellers feel alike; 0: each has water of its own."""

    def __post_init__(self) -> None:
        """Refuse a wash that drives a propeller, comes before its cause, or a share of the sea that is none.

        Raises SettingsError if the truth is not physical.
        """
        for name, highest in (("port_share", 0.5), ("starboard_share", 0.5), ("sea_share", 1.0)):
            value = getattr(self, name)
            if not 0.0 <= value <= highest:
                raise SettingsError(f"shared water: expected {name} between 0 and {highest:g}, found {value:g}.")
        for name in ("wash_delay_s", "wash_lag_s"):
            value = getattr(self, name)
            if not value > 0.0:
                raise SettingsError(f"shared water: expected {name} above 0, found {value:g}; give a positive time.")
