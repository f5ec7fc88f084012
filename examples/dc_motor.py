"""A DC motor: which of its five constants a test of voltage, current and speed finds, and how well.

The test is simulated here with known constants, so that the result can be judged; with a real motor the arrays come
from its logger. The motor as an engineer draws it::

    voltage -> (+) -> 1 / (L s + R) -> current -> K -> torque -> 1 / (J s + b) -> speed
               (-)                                                                  |
                ^------------------------------- K <--------------------------------'
"""

import numpy as np
from scipy.linalg import expm

from shaftprint.identify import identifiability, identify, profile_intervals
from shaftprint.models import Gain, Held, Parameter, RationalBlock, Sensitivity, Structure
from shaftprint.spectra import Periodic, response_from_arrays

TRUE = {"R": 1.7, "L": 0.004, "K": 0.08, "J": 2.5e-4, "b": 3e-4}
STEP_S, PERIOD_S, PERIODS = 1e-3, 4.0, 12


def simulate(voltage, rng):
    """Return measured current [A] and speed [rad/s]: exact between samples, for a voltage that is held there."""
    r, l, k, j, b = TRUE.values()  # noqa: E741
    matrix = np.zeros((3, 3))
    matrix[:2] = [[-r / l, -k / l, 1.0 / l], [k / j, -b / j, 0.0]]
    onward = expm(matrix * STEP_S)
    states = np.zeros((voltage.size, 2))
    for i in range(voltage.size - 1):
        states[i + 1] = onward[:2, :2] @ states[i] + onward[:2, 2] * voltage[i]
    noise = rng.standard_normal((2, voltage.size))
    return states[:, 0] + 0.1 * noise[0], states[:, 1] + 2.0 * noise[1]


# A voltage of 24 sines from 0.25 to 100 Hz that repeats itself, with random phases.
rng = np.random.default_rng(1)
time = STEP_S * np.arange(round(PERIODS * PERIOD_S / STEP_S))
lines_hz = np.unique(np.round(np.geomspace(0.25, 100.0, 24) * PERIOD_S)) / PERIOD_S
voltage = 0.6 * np.sin(2.0 * np.pi * (lines_hz * time[:, None] + rng.random(lines_hz.size))).sum(axis=1)
current, speed = simulate(voltage, rng)

response = response_from_arrays(
    {"voltage": voltage},
    {"current": current, "speed": speed},
    1.0 / STEP_S,
    excitation=Periodic(period_s=PERIOD_S),
)

# Name, unit, lower and upper bound, a typical value, meaning. Bounds of a factor of ten to both sides are wide enough
# for most data sheets.
R = Parameter("R", "ohm", 0.1, 10.0, 1.0, "resistance of the winding")
L = Parameter("L", "H", 0.0005, 0.05, 0.005, "inductance of the winding")
K = Parameter("K", "N m/A", 0.01, 1.0, 0.1, "torque constant; the same number is the back voltage in V s/rad")
J = Parameter("J", "kg m2", 1e-5, 1e-3, 1e-4, "inertia of the rotor")
B = Parameter("b", "N m s", 1e-5, 1e-2, 1e-3, "viscous friction")

winding = RationalBlock(lambda R, L: ([1.0], [L, R]), (R, L))
rotor = RationalBlock(lambda J, b: ([1.0], [J, b]), (J, B))
constant = Gain(K)

to_speed = winding * constant * rotor
left_of_voltage = Sensitivity(to_speed * constant)
motor = Structure(
    name="MOTOR",
    title="DC motor, from voltage to current and speed",
    input="voltage",
    # The computer holds each voltage until the next sample, which belongs into the model of sampled data.
    outputs={
        "current": Held(winding * left_of_voltage, STEP_S),
        "speed": Held(to_speed * left_of_voltage, STEP_S),
    },
)

# What can be found at all? This needs no data.
print(identifiability(motor, rng=rng).text)
print(identifiability(motor, outputs=["speed"], rng=rng).text)

fit = identify(motor, response, rng=rng)
intervals = profile_intervals(fit)
print(f"\nchi-square {fit.chi_square:.1f} for {fit.degrees_of_freedom} degrees of freedom, p = {fit.p_value:.2f}")
print("\nconstant  estimate +/- std        95 % interval           truth")
for number in fit.parameters:
    interval = intervals[number.name]
    print(
        f"{number.name:8}{number.value:11.4g} +/- {number.std:<9.2g}{interval.lower:10.4g} to {interval.upper:<10.4g}"
        f"{TRUE[number.name]:9.4g} {number.unit}"
    )
