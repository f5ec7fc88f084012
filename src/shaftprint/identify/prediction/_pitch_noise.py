"""Noise of a line with a controllable pitch at the quay, under the set point of the pitch.

Frequency [Hz], densities of n, M_s and theta [1/Hz] over their values at the working point, and the coherences of n
with M_s, n with theta and M_s with theta: means over ten simulated recordings of the research vessel, seeds 600 to
609, with weak lines of both inputs (``python -m benchmarks.stored_noise_beside --of pitch``). The feedback has noise of
its own, a slow wander most of all.
"""

from shaftprint.identify.prediction._noise_levels import NoiseLevels, tabulated_noise

_LEVELS: tuple[tuple[float, float, float, float, complex, complex, complex], ...] = (
    (0.0625, 4.25e-06, 0.000162, 2.11e-06, 0.0870 - 0.3863j, -0.0344 - 0.0140j, -0.0135 + 0.0242j),
    (0.1875, 8.19e-06, 4.68e-05, 7.6e-07, 0.7336 - 0.3121j, -0.0135 + 0.0288j, -0.0007 + 0.0606j),
    (0.3125, 9.64e-06, 5.86e-05, 3.32e-07, 0.8086 - 0.4270j, -0.0124 + 0.0322j, -0.0169 + 0.0250j),
    (0.4375, 9.48e-06, 6.35e-05, 1.87e-07, 0.7473 - 0.5628j, -0.0734 - 0.0387j, -0.0452 - 0.0769j),
    (0.5625, 1.24e-05, 9.88e-05, 1.27e-07, 0.7009 - 0.6564j, -0.0227 + 0.0229j, -0.0321 - 0.0170j),
    (0.6875, 1.52e-05, 0.000144, 9.93e-08, 0.6298 - 0.7451j, -0.0023 + 0.0046j, -0.0214 + 0.0004j),
    (0.8125, 1.77e-05, 0.000207, 6e-08, 0.5874 - 0.7870j, -0.0129 - 0.0388j, 0.0154 - 0.0233j),
    (1.062, 3.8e-05, 0.000634, 3.86e-08, 0.4974 - 0.8605j, -0.0173 - 0.0054j, -0.0039 - 0.0191j),
    (1.312, 4.08e-05, 0.000935, 2.68e-08, 0.4167 - 0.9033j, 0.0025 + 0.0170j, -0.0106 + 0.0068j),
    (1.562, 4.09e-05, 0.00127, 1.82e-08, 0.3549 - 0.9304j, -0.0459 + 0.0562j, -0.0756 - 0.0232j),
    (2.062, 3.41e-06, 0.000179, 1e-08, 0.2848 - 0.9286j, 0.0297 - 0.0241j, 0.0226 + 0.0277j),
    (2.562, 2.41e-06, 0.000188, 7.14e-09, 0.2223 - 0.9268j, -0.0810 - 0.0249j, 0.0223 - 0.0921j),
)

PITCH_NOISE: NoiseLevels = tabulated_noise(
    _LEVELS,
    set_point_per_v=0.175,
    orders_hz=(2.557, 4.999),
    outputs=("n", "M_s", "theta"),
)
"""Noise levels of the simulated research vessel up to 2.6 Hz; one volt is 0.14 of the pitch ratio of 0.80."""
