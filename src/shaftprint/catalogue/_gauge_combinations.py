"""What a test of a closed loop finds better than the parameters, by the names that the gauge-aware structures share."""

from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._combination import Combination

TOTAL_DELAY = Combination(
    name="t_d + t_sp",
    unit="s",
    of=lambda p: p["t_d"] + p["t_sp"],
    meaning="total delay",
    role=ShipRole.TOTAL_DELAY,
)
RESET_TIME = Combination(
    name="K_p / K_i",
    unit="s",
    of=lambda p: p["K_p"] / p["K_i"],
    meaning="reset time of the governor",
    role=ShipRole.LOOP_GAIN,
)


def motor_combinations() -> tuple[Combination, ...]:
    """Return what a test of a motor's closed loop finds better than the parameters it is made of."""
    return (
        Combination(
            name="t_d + T_m",
            unit="s",
            of=lambda p: p["t_d"] + p["T_m"],
            meaning="lag of the torque behind the speed controller",
        ),
        Combination(
            name="t_d + T_m + t_sp",
            unit="s",
            of=lambda p: p["t_d"] + p["T_m"] + p["t_sp"],
            meaning="lag of the torque behind the set point",
            role=ShipRole.TOTAL_DELAY,
        ),
        Combination(
            name="K_p / K_i",
            unit="s",
            of=lambda p: p["K_p"] / p["K_i"],
            meaning="reset time of the speed controller",
            role=ShipRole.LOOP_GAIN,
        ),
        Combination(
            name="K_i / k_q",
            unit="1/s",
            of=lambda p: p["K_i"] / p["k_q"],
            meaning="integral gain over the slope of the load",
            role=ShipRole.LOOP_GAIN,
        ),
        Combination(
            name="K_p / (tau_up + tau_dn)",
            unit="1/s",
            of=lambda p: p["K_p"] / (p["tau_up"] + p["tau_dn"]),
            meaning="loop gain at high frequency",
            role=ShipRole.LOOP_GAIN,
        ),
    )


def gauge_combinations() -> tuple[Combination, ...]:
    """Return what a test of the closed loop finds better than the parameters it is made of."""
    return (
        TOTAL_DELAY,
        RESET_TIME,
        Combination(
            name="v K_i / (k_q - g)",
            unit="1/s",
            of=lambda p: p["v"] * p["K_i"] / (p["k_q"] - p["g"]),
            meaning="integral gain over the slope of load and engine",
            role=ShipRole.LOOP_GAIN,
        ),
        Combination(
            name="v K_p / (tau_up + tau_dn)",
            unit="1/s",
            of=lambda p: p["v"] * p["K_p"] / (p["tau_up"] + p["tau_dn"]),
            meaning="loop gain at high frequency",
            role=ShipRole.LOOP_GAIN,
        ),
    )
