"""The truth that a simulated tug is built from."""

from dataclasses import dataclass, field
from typing import Self

from shaftprint.tug._coupling import Coupling
from shaftprint.tug._noise import Noise
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug._sailing import Sailing
from shaftprint.tug._shaft_machine import ShaftMachineTruth

# Table 3.4 of the thesis, "Fingerprinting II": angles between the reflection strips [degree]; printed sum 360.02.
STRIP_ANGLES_DEG = (90.40, 87.24, 90.74, 91.64)

USUAL_MOTORING_NM = 300.0
"""Motoring torque at the working point [N m] where neither the truth nor the vessel file states one.

26 % of rated torque, on the high side for friction, compression and driven pumps: the sine S12 alone swings the brake
torque down to -197 N m, with noise to -253 N m, and the sines shall stay unclipped so that they show a linear line. The
chirps C11 and C23 still touch both limits where they pass the closed-loop peak near 1.2 Hz, and the staircases do.
"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Tug:
    """Truth of a simulated propulsion line: governor, engine, shaft, set-point chain and noise.

    Gains are given as in the thesis, normalised at the working point; ``build_plant`` converts them to physical
    ones. The defaults are the reference truth of the shipped Stan Tug 1205. No delay is a multiple of the
    logger's 0.5 ms, so that a method which rounds delays to samples is found out.
    """

    engine_speed_rpm: float | None = None
    """Engine speed of the working point ``n_0`` [rpm]; ``None``: the vessel's."""
    shaft_torque_nm: float | None = None
    """Driving shaft torque of the working point ``M_s0`` [N m], above 0 astern too, a point of the propeller law;
    ``None``: the vessel's, and underway what the propeller takes there."""
    inertia_upstream_kg_m2: float | None = None
    """Inertia upstream of the torque gauge, referred to the propeller shaft [kg m2]; ``None``: the vessel's."""
    inertia_downstream_kg_m2: float | None = None
    """Inertia downstream of the torque gauge, with entrained water [kg m2]; ``None``: the vessel's."""
    coupling: Coupling | None = None
    """An elastic coupling between engine and torque gauge; ``None``: a rigid line."""
    shaft_machine: ShaftMachineTruth | None = None
    """The electric machine on the gearbox, where the vessel file has one; ``None``: the engine drives alone."""
    entrained_water_kg_m2: float = 0.0
    """Entrained water beyond what the inertia downstream already contains [kg m2]; it moves with the propeller."""
    inflow_gain: float = 0.0
    """``kappa`` of the dynamic inflow: torque of the propeller over a lag of its slipstream, both normalised; 0: none.

    Ducted propellers at the quay: 0.5 to 2.
    """
    inflow_time_s: float = 0.1
    """Time ``tau_i`` in which the slipstream follows the propeller at the working point [s]; 0.09 to 0.21 s."""
    sailing: Sailing | None = None
    """What makes the ship sail free; ``None``: bollard pull, the ship stands still."""
    pitch: PitchActuation | None = None
    """A controllable pitch at the quay; ``None``: the pitch is fixed, or underway as ``sailing`` says."""
    g: float = 0.0
    """Slope of brake torque over engine speed at constant rack, normalised at the working point."""
    v: float = 1.0
    """Slope of brake torque over fuel rack at constant speed, normalised at the working point."""
    proportional_gain: float = 5.7
    """``K_p`` of the governor, normalised at the working point."""
    integral_gain_per_s: float = 4.27
    """``K_i`` of the governor, normalised at the working point [1/s]."""
    anti_windup_s: float = 0.5
    """Time constant of the back-calculation that empties the integrator at the limits [s]."""
    governor_delay_s: float = 0.0703
    """Transport delay ``t_d`` between governor output and fuel rack, inside the loop [s]; 0 or three time steps."""
    governor_gain_exponent: float = 0.0
    """Power of the engine speed, over that of the working point, with which ``K_p`` and ``K_i`` go: a governor that
    takes its gains from a table over the speed; 0: the same gains at all speeds."""
    governor_delay_exponent: float = 0.0
    """Power of the engine speed with which ``t_d`` goes; -1 where all of it is a part of a turn of the engine, 0: the
    same delay at all speeds."""
    governor_deadband_rpm: float = 0.0
    """Speed error within which the governor does nothing [rpm], half of the whole band; 0: none."""
    rack_rate_limit_per_s: float | None = None
    """Fastest change of the rack that the governor gives [1/s], rack as a fraction; ``None``: no limit."""
    natural_frequency_rad_s: float = 10.3
    """Natural frequency ``omega_n`` of the fuel actuation [rad/s]."""
    damping_ratio: float = 0.47
    """Damping ratio ``zeta`` of the fuel actuation."""
    torque_time_s: float = 0.05
    """Time constant in which the torque of an electric motor follows what its speed controller asks for [s], in place
    of the fuel actuation; 0.02 to 0.2 s with the current loop closed. It acts where the vessel file has a motor, whose
    converter then has the dead time ``governor_delay_s``."""
    set_point_latency_s: float = 0.0518
    """Time ``t_sp`` from the set-point voltage to the demand in the ECU, outside the loop [s]."""
    set_point_slope_rpm_per_v: float = -250.97
    """Slope of the line from voltage to speed demand [rpm/V]."""
    set_point_intercept_rpm: float = -83.467
    """Intercept of that line [rpm]."""
    set_point_offset_v: float = -0.04947603299199
    """What the potentiometer adds to the voltage of the campaign [V]: at -5 V the default line gives ``n_0``."""
    set_point_bend_per_v: float = 0.0
    """Share by which that slope grows per volt, from the voltage of the working point on [1/V]; 0: a straight line.

    Levers and their cards: up to 0.004.
    """
    set_point_hysteresis_v: float = 0.0
    """Play between the voltage that is logged and that which the ECU follows [V], from one direction to the other."""
    generator_step_v: float | None = None
    """Step of the voltage that the generator can put out [V], 4.9 mV of +/- 10 V in 12 bits; ``None``: any voltage."""
    generator_cycle_s: float | None = None
    """Time for which the generator holds a voltage [s], that of the campaign in the middle; ``None``: not held."""
    demand_resolution_rpm: float | None = None
    """Step of the demand on its way to the ECU [rpm]; ``None``: the vessel's, not quantised where it has none."""
    demand_cycle_s: float | None = None
    """Time from one message with the demand to the next, which the ECU holds [s]; ``None``: the vessel's, at once where
    it has none."""
    demand_rate_limit_rpm_per_s: float | None = None
    """Fastest change of the demand that the ECU follows [rpm/s]; ``None``: the vessel's, no limit where it has none.

    The shipped tug has none: a limit that high-speed engines have (100 to 600 rpm/s) would already bend the sine S10,
    and the thesis sees no sign of that.
    """
    motoring_torque_nm: float | None = None
    """Torque that the engine takes at the working point when no fuel is burnt [N m]: the lower torque limit. ``None``:
    the vessel's motoring curve, and 300 N m where it has none.

    The rack may go as far below zero-torque running, where no fuel is left.
    """
    unboosted_torque_share: float = 1.0
    """Torque that a smoke limiter gives without boost, over the full-load torque; 1: no smoke limiter.

    Turbocharged engines give about 0.45 to 0.6 of their torque before the boost arrives.
    """
    turbocharger_lag_s: float = 1.0
    """Time in which the boost follows the torque [s]; 0.5 to 2 s at this size. It acts with a smoke limiter alone."""
    torque_zero_offset_nm: float = 0.0
    """What the torque gauge shows beyond the zero that the vessel file knows of [N m], counted as it counts: positive
    ahead."""
    rack_latency_s: float | None = None
    """Time by which the percent torque on the CAN bus is late [s]; ``None``: the vessel's."""
    speed_cycle_s: float | None = None
    """Time from one message to the next with a speed in rpm [s], 0.125 rpm a bit; ``None``: instruments in rpm give a
    value for each sample of the logger."""
    set_point_cycle_s: float | None = None
    """Time from one message to the next with the set point as the control unit reports it [s]; ``None``: the logger
    samples the voltage."""
    set_point_resolution: float = 0.4
    """Step of the set point in those messages, in the unit of the channel; 0.4 % of a pedal in SAE J1939-71."""
    torque_cycle_s: float | None = None
    """Time from one message to the next with the shaft torque [s]; ``None``: the logger samples its telemetry."""
    torque_is_mean: bool = True
    """Whether each of those messages holds the mean since the one before, not the torque of one instant; a mean is no
    longer than twice the latency of the vessel file, of which its half is a part."""
    message_jitter: float = 0.0
    """Standard deviation of the time of a message on the CAN bus about its cycle, over the cycle; evenly spread, below
    0.28. Messages with jitter or losses are recorded with times of their own."""
    messages_wait: bool = False
    """Whether only the messages come early or late, while their values keep the cycle."""
    messages_lost: float = 0.0
    """Share of the messages on the CAN bus that the logger misses."""
    strip_angles_deg: tuple[float, ...] = STRIP_ANGLES_DEG
    """Angles between the reflection strips of a pick-up with as many pulses a revolution [degree], scaled to 360."""
    tooth_error_deg: float = 0.03
    """Standard deviation of the place of a tooth on a wheel with gaps or further teeth [degree]."""
    speed_meter_noise: float = 2e-4
    """Standard deviation of an instrument that gives a speed, over 1.3 times the rated speed."""
    encoder_error_deg: float = 0.01
    """Standard deviation of the angle that an encoder shows, beside the size of its counts [degree]."""
    noise: Noise = field(default_factory=Noise)
    """Disturbances, measurement noise and faults."""

    @classmethod
    def stan_tug_1205(cls) -> Self:
        """Return the reference truth of the shipped Stan Tug 1205."""
        return cls()
