"""Noise of the Stan Tug 1205 in the backward bollard push, for plans without a recording of the ship itself."""

from shaftprint.identify.prediction._noise_levels import NoiseLevels, tabulated_noise

# Frequency [Hz], densities of n and M_s [1/Hz], their coherence: means over twelve simulated recordings of the thesis
# campaign. The simulated tug's noise is set to the local signal-to-noise ratios of table 3.7 of the thesis, which these
# levels meet within 6 dB from S5 to S12. They hold the uncertainty of the set-point scale and of the noise estimate.
_LEVELS: tuple[tuple[float, float, float, complex], ...] = (
    (0.0044, 7.39e-6, 1.77e-2, 0.127 - 0.269j),
    (0.0092, 5.61e-6, 5.02e-3, -0.089 - 0.351j),
    (0.0193, 5.31e-6, 1.45e-3, 0.006 - 0.370j),
    (0.0275, 4.16e-6, 7.28e-4, 0.028 - 0.475j),
    (0.0405, 3.29e-6, 3.62e-4, -0.022 - 0.374j),
    (0.06, 5.11e-6, 2.62e-4, -0.027 - 0.401j),
    (0.0848, 6.02e-6, 1.77e-4, -0.035 - 0.387j),
    (0.11, 6.98e-6, 7.73e-5, 0.272 - 0.259j),
    (0.1778, 7.57e-6, 5.34e-5, 0.766 - 0.157j),
    (0.3728, 9.55e-6, 5.20e-5, 0.846 - 0.307j),
    (0.7814, 2.39e-5, 1.47e-4, 0.772 - 0.594j),
    (1.637, 5.85e-5, 8.79e-4, 0.518 - 0.851j),
    (3.433, 1.14e-6, 5.69e-5, 0.243 - 0.878j),
    (7.19, 3.27e-7, 9.62e-6, 0.049 - 0.018j),
)

SLOW_LEVELS = _LEVELS[:2]
"""Levels below a hundredth of a hertz, which no leg shows."""

ORDERS_HZ = (5.165, 9.865)
"""First order of the shaft, and half an order of the engine, at 1183.8 rpm [Hz]."""

STAN_TUG_NOISE: NoiseLevels = tabulated_noise(
    _LEVELS,
    set_point_per_v=0.2120,
    orders_hz=ORDERS_HZ,
)
"""Noise levels of the Stan Tug 1205 up to 7.2 Hz; one volt of set point is 251 rpm of 1183.8 rpm."""
