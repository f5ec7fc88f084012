"""Two inputs and two outputs: the crossed stiffness of a machine's frame from two shakers and two displacements.

Two masses stand on the frame. Each is pushed by a shaker of its own, and both move under either force: four responses,
which share five constants. The damping of each spring is tied to its stiffness by one factor, as in rubber of one make.
"""

import numpy as np
from scipy.linalg import expm

from shaftprint.identify import identify, profile_intervals
from shaftprint.models import Parameter, RationalBlock, Structure, ZeroOrderHold
from shaftprint.spectra import Periodic, response_from_arrays

TRUE = {"m_1": 8.0, "m_2": 5.0, "k_g": 40e3, "k_c": 15e3, "beta": 1.5e-3}
STEP_S, PERIOD_S, PERIODS = 1e-3, 4.0, 5


def simulate(forces, rng):
    """Return both measured displacements [m]: exact between samples, for forces that are held there."""
    m_1, m_2, k_g, k_c, beta = TRUE.values()
    stiffness = np.array([[k_g + k_c, -k_c], [-k_c, k_g + k_c]])
    inverse_mass = np.diag([1.0 / m_1, 1.0 / m_2])
    matrix = np.zeros((6, 6))
    matrix[:2, 2:4] = np.eye(2)
    matrix[2:4, :2], matrix[2:4, 2:4] = -inverse_mass @ stiffness, -beta * inverse_mass @ stiffness
    matrix[2:4, 4:] = inverse_mass
    onward = expm(matrix * STEP_S)
    states = np.zeros((forces.shape[1], 4))
    for i in range(forces.shape[1] - 1):
        states[i + 1] = onward[:4, :4] @ states[i] + onward[:4, 4:] @ forces[:, i]
    return states[:, :2].T + 1e-4 * rng.standard_normal((2, forces.shape[1]))


# As many records as there are inputs, in which they move differently: the second shaker changes its sign.
rng = np.random.default_rng(2)
time = STEP_S * np.arange(round(PERIODS * PERIOD_S / STEP_S))
lines_hz = np.unique(np.round(np.geomspace(1.0, 40.0, 30) * PERIOD_S)) / PERIOD_S
sines = [np.sin(2.0 * np.pi * (lines_hz * time[:, None] + rng.random(lines_hz.size))).sum(axis=1) for _ in range(2)]
records = [10.0 * np.array([sines[0], sign * sines[1]]) for sign in (1.0, -1.0)]
moved = [simulate(forces, rng) for forces in records]
response = response_from_arrays(
    [{"F_1": forces[0], "F_2": forces[1]} for forces in records],
    [{"x_1": x[0], "x_2": x[1]} for x in moved],
    1.0 / STEP_S,
    excitation=Periodic(period_s=PERIOD_S),
)

M_1 = Parameter("m_1", "kg", 1.0, 50.0, 10.0, "first mass")
M_2 = Parameter("m_2", "kg", 1.0, 50.0, 10.0, "second mass")
K_G = Parameter("k_g", "N/m", 1e3, 1e6, 1e5, "spring to the ground")
K_C = Parameter("k_c", "N/m", 1e3, 1e6, 1e4, "spring between the masses")
D_G = Parameter("d_g", "N s/m", 0.0, 1e3, 50.0, "damper to the ground")
D_C = Parameter("d_c", "N s/m", 0.0, 1e3, 50.0, "damper between the masses")
BETA = Parameter("beta", "s", 0.0, 0.01, 0.001, "damping over stiffness")


# Force over displacement of either mass while the other stands still, and what couples them.
one = RationalBlock(lambda m, k, c, d_g, d_c: ([m, d_g + d_c, k + c], [1.0]), (M_1, K_G, K_C, D_G, D_C))
two = RationalBlock(lambda m, k, c, d_g, d_c: ([m, d_g + d_c, k + c], [1.0]), (M_2, K_G, K_C, D_G, D_C))
coupling = RationalBlock(lambda k, d: ([d, k], [1.0]), (K_C, D_C))
hold = ZeroOrderHold(STEP_S)

# The inverse of the two by two matrix, as on paper.
over = hold / (one * two - coupling * coupling)
frame = Structure(
    name="FRAME",
    title="two masses on a frame",
    inputs=("F_1", "F_2"),
    outputs={
        "x_1": {"F_1": two * over, "F_2": coupling * over},
        "x_2": {"F_1": coupling * over, "F_2": one * over},
    },
)
frame = frame.tied("d_g", lambda beta, k_g: beta * k_g, BETA).tied("d_c", lambda beta, k_c: beta * k_c)

fit = identify(frame, response, rng=rng)
intervals = profile_intervals(fit)
print(f"chi-square {fit.chi_square:.1f} for {fit.degrees_of_freedom} degrees of freedom, p = {fit.p_value:.2f}")
for number in (*fit.parameters, *fit.combinations):
    interval = intervals[number.name]
    true = f"truth {TRUE[number.name]:g}" if number.name in TRUE else "tied"
    print(
        f"{number.name:5}{number.value:11.5g} +/- {number.std:<8.2g} {number.unit:6}"
        f"95 %: {interval.lower:.5g} to {interval.upper:.5g}, {true}"
    )
