"""A belt drive with two masses: fitted, profiled, judged, and asked how fast its controller may be made.

The computer sets the motor's torque, the belt is a spring with damping between motor and load, and both speeds are
measured. Torque commands arrive late by the computing time. With the speeds ``w_1`` and ``w_2``::

    J_1 dw_1/dt = T - b_1 w_1 - M_belt      M_belt = (c + k / s) (w_1 - w_2)
    J_2 dw_2/dt = M_belt - b_2 w_2

Nothing of this is in the package: the blocks are written here in the three ways there are.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from shaftprint.identify import assess, identifiability, identify, profile
from shaftprint.models import (
    Block,
    Combination,
    Delay,
    FunctionBlock,
    Parameter,
    PIGovernor,
    RationalBlock,
    Structure,
    check_structure,
    feedback,
    margins,
)
from shaftprint.spectra import Periodic, response_from_arrays

TRUE = {"J_1": 0.0040, "J_2": 0.0150, "k": 60.0, "c": 0.05, "b_1": 0.010, "b_2": 0.020, "t_d": 0.0024}
STEP_S, PERIOD_S, PERIODS = 0.2e-3, 4.0, 6


def simulate(torque, rng):
    """Return both measured speeds [rad/s]: exact between samples, for a torque that arrives late and is held."""
    j_1, j_2, k, c, b_1, b_2, delay = TRUE.values()
    matrix = np.zeros((5, 5))
    matrix[0] = [-(b_1 + c) / j_1, c / j_1, -k / j_1, 1.0 / j_1, 0.0]
    matrix[1] = [c / j_2, -(b_2 + c) / j_2, k / j_2, 0.0, -1.0 / j_2]
    matrix[2, :2] = [1.0, -1.0]
    onward = expm(matrix * STEP_S)
    late = np.concatenate([np.zeros(round(delay / STEP_S)), torque])
    # the load pulls unevenly, which disturbs both speeds at once: their noise is correlated
    pull = np.convolve(rng.standard_normal(torque.size), np.exp(-np.arange(2000) * STEP_S / 0.05), "same") * 0.02
    states = np.zeros((torque.size, 3))
    for i in range(torque.size - 1):
        states[i + 1] = onward[:3, :3] @ states[i] + onward[:3, 3] * late[i] + onward[:3, 4] * pull[i]
    return (states[:, :2] + 0.05 * rng.standard_normal((torque.size, 2))).T


@dataclass(frozen=True, slots=True, eq=False)
class Belt(Block):
    """Torque of the belt over the difference of the speeds: ``c + k / s``. A block with equations gets everything."""

    damping: Parameter
    stiffness: Parameter

    @property
    def parameters(self):
        return (self.damping, self.stiffness)

    def transfer(self, s, c, k):
        return c + k / s

    def derivatives(self, s, response, c, k):
        return np.ones_like(s), 1.0 / s

    def ratio(self, c, k):
        return np.array([c, k]), np.array([1.0, 0.0])


J_1 = Parameter("J_1", "kg m2", 1e-4, 0.1, 0.005, "inertia of motor and pulley")
J_2 = Parameter("J_2", "kg m2", 1e-4, 0.1, 0.005, "inertia of the load, at the motor")
STIFFNESS = Parameter("k", "N m/rad", 1.0, 1000.0, 100.0, "stiffness of the belt, at the motor")
DAMPING = Parameter("c", "N m s", 0.0, 1.0, 0.1, "damping of the belt, at the motor")
B_1 = Parameter("b_1", "N m s", 0.0, 0.2, 0.01, "friction of the motor")
B_2 = Parameter("b_2", "N m s", 0.0, 0.2, 0.01, "friction of the load, at the motor")
T_D = Parameter("t_d", "s", 0.0, 0.01, 0.001, "computing time")

belt = Belt(DAMPING, STIFFNESS)
motor = RationalBlock(lambda j, b: ([j, b], [1.0]), (J_1, B_1))
load = RationalBlock(lambda j, b: ([1.0], [j, b]), (J_2, B_2))
hold = FunctionBlock(lambda s: -np.expm1(-s * STEP_S) / (s * STEP_S), ())

# Belt and load behind each other carry the same torque; motor and what is behind it have the same speed.
behind = 1 / (1 / belt + load)
motor_speed = 1 / (motor + behind)
late = Delay(T_D) * hold
drive = Structure(
    name="BELT-DRIVE",
    title="two masses and a belt, from torque to both speeds",
    input="torque",
    outputs={"w_1": late * motor_speed, "w_2": late * motor_speed * behind * load},
    combinations=(
        Combination(name="b_1 + b_2", unit="N m s", of=lambda p: p["b_1"] + p["b_2"], meaning="friction of all"),
        Combination(
            name="sqrt(k / J_2)", unit="rad/s", of=lambda p: np.sqrt(p["k"] / p["J_2"]), meaning="antiresonance"
        ),
    ),
)
check_structure(drive)
print(identifiability(drive, rng=np.random.default_rng(0)).text)

rng = np.random.default_rng(5)
time = STEP_S * np.arange(round(PERIODS * PERIOD_S / STEP_S))
lines_hz = np.unique(np.round(np.geomspace(0.25, 80.0, 32) * PERIOD_S)) / PERIOD_S
torque = 0.1 * np.sin(2.0 * np.pi * (lines_hz * time[:, None] + rng.random(lines_hz.size))).sum(axis=1)
w_1, w_2 = simulate(torque, rng)
response = response_from_arrays(
    {"torque": torque}, {"w_1": w_1, "w_2": w_2}, 1.0 / STEP_S, excitation=Periodic(period_s=PERIOD_S)
)

fit = identify(drive, response, rng=rng)
profiled = profile(fit)
intervals = profiled.intervals
print()
for number in (*fit.parameters, *fit.combinations):
    interval = intervals[number.name]
    print(
        f"{number.name:14}{number.value:10.5g} +/- {number.std:<9.2g}"
        f"95 %: {interval.lower:.5g} to {interval.upper:.5g} {number.unit}"
    )

verdict = assess(fit, profile=profiled)
print(*verdict.sentences, sep="\n")

# The same for a structure that is wrong: a belt that does not stretch.
J = Parameter("J", "kg m2", 1e-4, 0.1, 0.01, "inertia of all")
body = late * RationalBlock(lambda j, b: ([1.0], [j, b]), (J, B_1))
stiff = Structure(name="STIFF-DRIVE", title="one mass", input="torque", outputs={"w_1": body, "w_2": body})
stiff_verdict = assess(identify(stiff, response, rng=rng))
print(*stiff_verdict.sentences, sep="\n")

# The same blocks in a loop that was never tested: a speed controller on the motor's side.
K_P = Parameter("K_p", "N m s", 0.0, 10.0, 1.0, "proportional gain", held=True)
K_I = Parameter("K_i", "N m", 0.0, 100.0, 5.0, "integral gain", held=True)
controlled = Structure(
    name="CONTROLLED",
    title="speed control of the motor",
    input="reference",
    outputs={"w_1": feedback(PIGovernor(K_P, K_I) * late * motor_speed)},
)


def gain_margin(named):
    """Return the factor by which the controller may be made stronger, for constants of the drive by name."""
    return margins(controlled, controlled.vector({name: named[name] for name in drive.names})).gain_margin


margin = fit.derived("gain margin", "-", gain_margin)
print(f"gain margin of the controller: {margin.value:.3f} +/- {margin.std:.3f}")
