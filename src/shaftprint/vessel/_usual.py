"""Standard deviations that are usual in the trade, for what a vessel file does not state: unknown is not zero."""

GAUGE_SCALE_STD = 0.01
"""Relative standard deviation of the scale of strain gauges on a shaft, shunt-calibrated: modulus, diameter, bridge."""
GAUGE_ZERO_SHARE = 0.005
"""Standard deviation of the zero of a torque gauge over its full scale."""
LATENCY_STD_S = 0.002
"""Standard deviation of the latency of a torque telemetry [s]."""
INERTIA_STD = 0.05
"""Relative standard deviation of one row of an inertia table."""
