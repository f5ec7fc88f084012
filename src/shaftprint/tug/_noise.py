"""Sizes of everything that disturbs the simulated ship and its sensors."""

from dataclasses import dataclass, replace
from typing import Self

# how the names of amplitudes end
_SIZES = ("_rms", "_order", "_rms_v", "_jitter_s")


@dataclass(frozen=True, kw_only=True, slots=True)
class Noise:
    """Sizes of process disturbances, measurement noise and recording faults; zero switches one off.

    The defaults are set so that the local signal-to-noise ratios of Table 3.7 and the overall ratio of the shaft
    torque in Table 3.6 of the thesis ("Fingerprinting II") are met in order of magnitude. Fractions of torque are
    fractions of the momentary mean load, so that they grow with the square of the speed.
    """

    # process: acts in the loop, therefore speed and torque noise are correlated
    inflow_rms: float = 0.014
    """Recirculating inflow: rms of the propeller torque, as a fraction of it."""
    inflow_corner_hz: float = 0.0025
    """Below this frequency [Hz] the inflow disturbance is flat, above it falls with ``1/f^2``."""
    surge_rms: float = 0.0025
    """Surge against the mooring: rms of the propeller torque, as a fraction of it."""
    surge_hz: float = 0.09
    """Natural frequency of the surge [Hz]."""
    surge_damping: float = 0.15
    """Damping ratio of the surge."""
    combustion_rms: float = 0.055
    """Cycle-to-cycle variation of the engine torque: rms as a fraction of the load."""
    combustion_hz: float = 3.0
    """Up to this frequency [Hz] the variation is white, above it falls with ``1/f^4``."""
    combustion_damping: float = 0.18
    """Damping ratio of the hump at that frequency."""
    hunting_rms: float = 0.045
    """Hunting of the injection near the governor's crossover: rms of the engine torque as a fraction of the load."""
    hunting_hz: float = 1.65
    """Frequency of the hunting [Hz]."""
    hunting_damping: float = 0.1
    """Damping ratio of the hunting."""
    demand_rms: float = 0.0004
    """Wander of the speed demand inside the ECU, not seen by the logger: rms as a fraction of the working point."""
    demand_corner_hz: float = 0.02
    """Corner of the wander of the demand [Hz]."""

    # measurement
    half_order: float = 0.13
    """Amplitude of engine order 0.5 (unequal cylinders) in the shaft torque, as a fraction of the load."""
    shaft_order: float = 0.09
    """Amplitude of shaft order 1 (unbalance, bending cross-talk), as a fraction of the load."""
    blade_order: float = 0.035
    """Amplitude of the blade rate, as a fraction of the load."""
    twice_blade_order: float = 0.008
    """Amplitude of twice the blade rate, as a fraction of the load."""
    firing_order: float = 0.30
    """Amplitude of the firing order of the engine, as a fraction of the load."""
    torque_broadband_rms: float = 0.06
    """Broadband torque noise before the low-pass filter of the telemetry: rms as a fraction of the load."""
    set_point_rms_v: float = 0.0008
    """Noise of the set-point voltage at the logger [V]."""
    pulse_rms_v: float = 0.02
    """Noise of the pulse voltages at the logger [V]."""
    pulse_jitter_s: float = 40e-6
    """Standard deviation of the time of a pulse [s]."""

    # faults of the recording
    missing_pulse_interval_s: float = 900.0
    """Mean time between missing pulses of a pick-up [s]; 0 means never."""
    doubled_pulse_interval_s: float = 2300.0
    """Mean time between doubled pulses of a pick-up [s]; 0 means never."""
    torque_spike_interval_s: float = 180.0
    """Mean time between spikes of one sample in the torque [s]; 0 means never."""
    torque_dropout_interval_s: float = 2000.0
    """Mean time between dropouts of the torque telemetry [s]; 0 means never."""
    torque_dropout_longest_s: float = 0.2
    """Longest dropout [s]; the shortest is a fortieth of it."""
    set_point_spike_interval_s: float = 450.0
    """Mean time between spikes of one sample in the set point [s]; 0 means never."""

    def scaled(self, factor: float, *, but: tuple[str, ...] = ()) -> Self:
        """Return the same noise with every amplitude times a factor, those that are named as they are."""
        sizes = (name for name in self.__dataclass_fields__ if name.endswith(_SIZES) and name not in but)
        return replace(self, **{name: factor * getattr(self, name) for name in sizes})

    def without(self, *, process: bool = False, measurement: bool = False, faults: bool = False) -> Self:
        """Return the same noise with the named kinds set to zero."""
        names: tuple[str, ...] = ()
        if process:
            names += ("inflow_rms", "surge_rms", "combustion_rms", "hunting_rms", "demand_rms")
        if measurement:
            names += (
                "half_order",
                "shaft_order",
                "blade_order",
                "twice_blade_order",
                "firing_order",
                "torque_broadband_rms",
                "set_point_rms_v",
                "pulse_rms_v",
                "pulse_jitter_s",
            )
        if faults:
            names += (
                "missing_pulse_interval_s",
                "doubled_pulse_interval_s",
                "torque_spike_interval_s",
                "torque_dropout_interval_s",
                "set_point_spike_interval_s",
            )
        return replace(self, **dict.fromkeys(names, 0.0))
