"""A servo axis that cannot be tested without its controllers: mass and friction from a test in closed loop.

The axis would run into its stops if it were driven open. So its position controller stays on, and a small signal is
added to the position reference. Force and position are recorded::

    reference -> (+) -> K_x -> (+) -> K_p + K_i / s -> force -> delay -> 1 / (m s + d) -> velocity -> 1 / s -> position
                 (-)           (-)                                                        |                     |
                  |             '--------------------------------------------------------'                     |
                  '---------------------------------------------------------------------------------------------'

Position over force is no estimate of the axis: friction that pushes the axis also makes the controller act, so the
force holds the disturbance. What moves the loop from outside is the reference, and the model is that of the whole loop.
The gains are known, since they were typed in; mass, friction and the delay of drive and computer are not.
"""

import numpy as np

from shaftprint.identify import identify, profile_intervals
from shaftprint.models import (
    Delay,
    Gain,
    Integrator,
    Parameter,
    PIGovernor,
    RationalBlock,
    Sensitivity,
    Structure,
    ZeroOrderHold,
    margins,
)
from shaftprint.spectra import Periodic, plant_from_closed_loop, response_from_arrays

TRUE = {"m": 12.0, "d": 85.0, "t_d": 0.004}
GAINS = {"K_x": 25.0, "K_p": 1500.0, "K_i": 20000.0}
STEP_S, PERIOD_S, PERIODS = 0.5e-3, 4.0, 6


def simulate(reference, rng):
    """Return force [N] and measured position [m]: the controllers' program, and the axis exactly between its steps."""
    mass, friction, delay = TRUE.values()
    decay = np.exp(-friction / mass * STEP_S)
    late = round(delay / STEP_S)
    force, position = np.zeros(reference.size + late), np.zeros(reference.size)
    disturbance = rubbing(reference.size, rng)
    x = v = integral = error = 0.0
    for i in range(reference.size):
        position[i] = x + 2e-6 * rng.standard_normal()
        before, error = error, GAINS["K_x"] * (reference[i] - position[i]) - v
        integral += 0.5 * STEP_S * (before + error)
        force[i + late] = GAINS["K_p"] * error + GAINS["K_i"] * integral
        end = (force[i] + disturbance[i]) / friction
        x += end * STEP_S + (v - end) * (1.0 - decay) * mass / friction
        v = end + (v - end) * decay
    return force[late:], position


def rubbing(count, rng):
    """Return a force of friction that changes slowly along the way [N]."""
    return 40.0 * np.cumsum(rng.standard_normal(count)) * np.sqrt(STEP_S)


rng = np.random.default_rng(3)
time = STEP_S * np.arange(round(PERIODS * PERIOD_S / STEP_S))
lines_hz = np.unique(np.round(np.geomspace(0.25, 60.0, 24) * PERIOD_S)) / PERIOD_S
sines = np.sin(2.0 * np.pi * (lines_hz * time[:, None] + rng.random(lines_hz.size)))
reference = (0.002 / np.sqrt(1.0 + (lines_hz / 5.0) ** 2) * sines).sum(axis=1)
force, position = simulate(reference, rng)

response = response_from_arrays(
    {"reference": reference},
    {"force": force, "position": position},
    1.0 / STEP_S,
    excitation=Periodic(period_s=PERIOD_S),
)

MASS = Parameter("m", "kg", 1.0, 100.0, 10.0, "mass of the axis")
FRICTION = Parameter("d", "N s/m", 0.0, 1000.0, 50.0, "viscous friction")
DELAY = Parameter("t_d", "s", 0.0, 0.02, 0.002, "delay of drive and computer")
K_X = Parameter("K_x", "1/s", 0.0, 100.0, GAINS["K_x"], "gain of the position controller", held=True)
K_P = Parameter("K_p", "N s/m", 0.0, 1e4, GAINS["K_p"], "proportional gain of the velocity controller", held=True)
K_I = Parameter("K_i", "N/m", 0.0, 1e6, GAINS["K_i"], "integral gain of the velocity controller", held=True)

controller = PIGovernor(K_P, K_I)
hold = ZeroOrderHold(STEP_S)
axis = RationalBlock(lambda m, d: ([1.0], [m, d]), (MASS, FRICTION))

velocity_loop = controller * Delay(DELAY) * hold * axis
left_of_velocity = Sensitivity(velocity_loop)
position_loop = Gain(K_X) * velocity_loop * left_of_velocity * Integrator()
left_of_position = Sensitivity(position_loop)
servo = Structure(
    name="SERVO",
    title="servo axis under position and velocity control",
    input="reference",
    outputs={
        "force": Gain(K_X) * left_of_position * controller * left_of_velocity,
        "position": position_loop * left_of_position,
    },
)

# The axis alone, without a word on its controllers: from the responses of force and position to the reference.
axis_alone = Structure(
    name="AXIS",
    title="servo axis, from force to position",
    input="force",
    outputs={"position": Delay(DELAY) * hold * axis * Integrator()},
)
plant = plant_from_closed_loop(response, input="force", output="position")

# And as if there were no loop, which is wrong.
direct = response_from_arrays({"force": force}, {"position": position}, 1.0 / STEP_S, band_hz=(0.2, 61.0))

loop_fit = identify(servo, response, rng=rng)
print(f"margins of the position loop: gain {margins(servo, loop_fit.values).gain_margin:.1f}\n")
for title, fit in (
    ("whole loop, gains known", loop_fit),
    ("axis from the responses to the reference", identify(axis_alone, plant, rng=rng)),
    ("axis from force and position as they are: wrong", identify(axis_alone, direct, rng=rng)),
):
    print(f"{title}: chi-square {fit.chi_square:.0f} for {fit.degrees_of_freedom} degrees of freedom")
    for name, interval in profile_intervals(fit).items():
        ends = f"{interval.lower:.5f} to {interval.upper:.5f}"
        print(f"  {name:4}{fit.value(name):9.5f}   95 %: {ends}   truth {TRUE[name]:g}")
