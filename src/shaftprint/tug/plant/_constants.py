"""The physical constants of the propulsion line of a simulated ship."""

from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.tug._sailing import AT_THE_QUAY, Way


class Plant(NamedTuple):
    """Physical constants of the line; a named tuple because compiled code takes it as it is."""

    inertia_upstream_kg_m2: float
    inertia_downstream_kg_m2: float
    gear_ratio: float
    """Engine speed over shaft speed; negative where the gearbox reverses."""
    efficiency: float
    propeller_nm_s2: float
    """``K`` of the propeller law ``M_p = K n_s |n_s|`` [N m s2]."""
    inflow_gain: float
    """``kappa`` of the dynamic inflow; 0 where the slipstream follows at once."""
    inflow_per_rev: float
    """``1 / (2 n_s0 tau_i)`` of the dynamic inflow [1/rev]."""
    speed_slope_nm_s: float
    """``A_1`` [N m per rev/s]."""
    rack_slope_nm: float
    """``A_2`` [N m]: torque of the full rack."""
    rack_offset_nm: float
    """``A_3`` [N m]."""
    proportional_s: float
    """``K_p`` [rack per rev/s]."""
    integral: float
    """``K_i`` [rack per rev]."""
    anti_windup_s: float
    delay_s: float
    natural_frequency_rad_s: float
    damping_ratio: float
    point_speed_rev_s: float
    """Engine speed of the working point [rev/s], at which gains and delay are as stated."""
    gain_exponent: float
    """Power of the engine speed with which both gains go."""
    delay_exponent: float
    """Power of the engine speed with which the delay goes."""
    limit_speed_rev_s: FloatArray
    """Engine speeds of the full-load curve [rev/s], ascending."""
    limit_torque_nm: FloatArray
    """Full-load brake torque [N m]."""
    motoring_speed_rev_s: FloatArray
    """Engine speeds of the motoring curve [rev/s], ascending."""
    motoring_torque_nm: FloatArray
    """Brake torque without fuel at them, as positive numbers [N m]."""
    deadband_rev_s: float = 0.0
    """Speed error within which the governor does nothing [rev/s], half of the whole band."""
    rack_rate_limit_per_s: float = np.inf
    """Fastest change of the rack that the governor gives [1/s]."""
    air_share: float = 1.0
    """Full-load torque without boost, as a fraction of that with full boost; 1 without a smoke limiter."""
    turbocharger_lag_s: float = 1.0
    """Time in which the boost follows the torque [s]."""
    torque_per_s: float = 0.0
    """One over the time constant of the torque of a motor [1/s]; 0 for an engine."""
    coupling_nm_rev: float = 0.0
    """Stiffness of the coupling, at the propeller shaft [N m/rev]; 0 where the line is rigid."""
    coupling_nm_s_rev: float = 0.0
    """Damping of the coupling, at the propeller shaft [N m s/rev]."""
    inertia_driven_kg_m2: float = 0.0
    """Part of the inertia upstream of the gauge that lies behind the coupling [kg m2]."""
    machine_nm: float = 0.0
    """Torque of the electric machine on the gearbox at the working point, at the propeller shaft [N m]; negative where
    it is taken out, 0 where there is none."""
    sails: bool = False
    """Whether the ship has way on; if not, ``way`` plays no part."""
    way: Way = AT_THE_QUAY
    """The ship and what its propellers do underway."""
