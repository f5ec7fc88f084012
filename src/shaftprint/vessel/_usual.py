"""Standard deviations that are usual in the trade, for what a vessel file does not state: unknown is not zero."""

GAUGE_SCALE_STD = 0.01
"""Relative standard deviation of the scale of strain gauges on a shaft, shunt-calibrated: modulus, diameter, bridge."""
BEND_STD = 0.015
"""Standard deviation of the share by which the line of a lever is steeper at twice the speed: with 250 rpm a volt and
1200 rpm it is 0.3 % a volt."""
BEND_OF_DEMAND_STD = 0.001
"""The same where the channel is the demand itself in rpm."""
GAUGE_ZERO_SHARE = 0.005
"""Standard deviation of the zero of a torque gauge over its full scale."""
LATENCY_STD_S = 0.002
"""Standard deviation of the latency of a torque telemetry [s]."""
INERTIA_STD = 0.05
"""Relative standard deviation of one row of an inertia table."""
LOG_SCALE_STD = 0.02
"""Relative standard deviation of the mean speed through the water by a calibrated log."""
LOG_LATENCY_SHARE = 0.5
"""Standard deviation of the latency of a log over the time between two of its values."""
PITCH_STD = 0.01
"""Relative standard deviation of the pitch of a propeller as built."""
WASH_SHARE_STD = 0.02
"""Standard deviation, about none, of the share of its torque that a propeller loses in a twice as fast wash of the
other one."""
MACHINE_SHARE_STD = 0.02
"""Standard deviation of the share of the torque that an electric machine on the gearbox gives."""
MACHINE_TORQUE_STD = 0.02
"""Relative standard deviation of the scale by which a converter shows the torque of its machine."""
MASS_STD = 0.03
"""Relative standard deviation of the displacement of a ship."""
COUPLING_STIFFNESS_STD = 0.1
"""Relative standard deviation of the stiffness of a link: makers of rubber couplings state 10 to 15 %, and it falls
with the temperature of the rubber."""
COUPLING_DAMPING_STD = 0.3
"""Relative standard deviation of the damping of a link: 0.8 to 1.2 of a rubber coupling's ``psi`` are usual, and it
changes with amplitude and temperature."""
PITCH_SENSOR_STD = 0.02
"""Relative standard deviation of a change of pitch that the feedback of a controllable pitch shows."""
PITCH_SLOPE_STD = 0.10
"""Relative standard deviation of the slope of torque over pitch that a propeller series gives a controllable pitch."""
