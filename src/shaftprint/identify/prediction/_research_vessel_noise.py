"""Noise of a line with a controllable pitch at the quay, under the set point of the speed.

Frequency [Hz], densities of n and M_s [1/Hz] over their values at the working point, and their coherence: means over
ten simulated recordings of the research vessel, seeds 600 to 609, with weak lines of speed and pitch
(``python -m benchmarks.stored_noise_beside --of speed-beside-pitch``). Its shaft has twice the inertia time behind the
gauge that the Stan Tug has, so that more of the torque near the resonance of its loop is not told by the speed.
"""

from shaftprint.identify.prediction._noise_levels import NoiseLevels, tabulated_noise

_LEVELS: tuple[tuple[float, float, float, complex], ...] = (
    (0.02083, 5.32e-06, 0.00109, 0.1649 - 0.3986j),
    (0.1042, 6.18e-06, 0.000106, 0.1978 - 0.3750j),
    (0.1458, 6.88e-06, 4.97e-05, 0.5849 - 0.3198j),
    (0.2292, 8.57e-06, 4.87e-05, 0.7907 - 0.3146j),
    (0.2708, 9.41e-06, 5.79e-05, 0.8141 - 0.3779j),
    (0.3542, 9.58e-06, 6.19e-05, 0.8090 - 0.4509j),
    (0.3958, 9.43e-06, 6.46e-05, 0.7910 - 0.5048j),
    (0.4792, 1.12e-05, 7.81e-05, 0.7345 - 0.6001j),
    (0.5208, 1.15e-05, 8.56e-05, 0.7146 - 0.6318j),
    (0.6042, 1.27e-05, 0.000108, 0.6915 - 0.6758j),
    (0.7292, 1.58e-05, 0.000158, 0.6148 - 0.7592j),
    (0.8542, 1.95e-05, 0.000245, 0.5702 - 0.8019j),
    (1.021, 3.03e-05, 0.00048, 0.5101 - 0.8461j),
    (1.146, 3.71e-05, 0.0007, 0.4592 - 0.8725j),
    (1.229, 4.39e-05, 0.000914, 0.4359 - 0.8863j),
    (1.354, 3.97e-05, 0.000978, 0.4007 - 0.9040j),
    (1.479, 3.76e-05, 0.00106, 0.3767 - 0.9184j),
    (1.604, 3.68e-05, 0.00119, 0.3476 - 0.9335j),
    (1.729, 2.02e-05, 0.000754, 0.3294 - 0.9370j),
    (1.896, 5.76e-06, 0.00026, 0.3029 - 0.9400j),
    (2.271, 2.37e-06, 0.000151, 0.2517 - 0.9404j),
    (2.479, 2.37e-06, 0.000172, 0.2268 - 0.9524j),
    (3.229, 1.51e-06, 0.000187, 0.1770 - 0.9642j),
    (3.521, 7.22e-07, 0.000104, 0.1684 - 0.9381j),
)

RESEARCH_VESSEL_NOISE: NoiseLevels = tabulated_noise(
    _LEVELS,
    set_point_per_v=0.2120,
    orders_hz=(2.557, 4.999),
)
"""Noise levels of the simulated research vessel up to 3.5 Hz; one volt of set point is 127 rpm of 600 rpm."""
