#!/usr/bin/env bash
# About: shipmmg 0.0.11, simulate_mmg_3dof, the KVLCC2 model of 7 m, propeller at +10 and at -10 turns a second
# Guess: turned the other way, the propeller pushes astern: the ship slows down and goes backwards.
# What happens: thrust is rho n^2 D^4 K_T(J) with the same K_T: n^2 has lost the sign, and the negative advance ratio makes K_T larger. After 60 s the ship does
#   +1.26 m/s with -10 turns, +1.00 with +10: astern is the faster way ahead.
. "$(dirname "$0")/_setup.sh"
packages shipmmg==0.0.11
run <<'PY'
import numpy as np
from find import seen
from shipmmg.mmg_3dof import Mmg3DofBasicParams, Mmg3DofManeuveringParams, simulate_mmg_3dof

rho, L, d, D = 1025.0, 7.0, 0.46, 0.216
mass = 3.27 * rho
hull = {"L_pp": L, "B": 1.27, "d": d, "x_G": 0.25, "D_p": D, "m": mass, "I_zG": mass * (0.25 * L) ** 2, "A_R": 0.0539, "η": 0.626}
hull |= {"m_x": 0.011 * rho * L**2 * d, "m_y": 0.1115 * rho * L**2 * d, "J_z": 0.0055 * rho * L**4 * d, "f_α": 2.747, "ε": 1.09}
hull |= {"t_R": 0.387, "x_R": -0.5 * L, "a_H": 0.312, "x_H": -0.464 * L, "γ_R_minus": 0.395, "γ_R_plus": 0.64, "l_R": -0.71}
hull |= {"κ": 0.5, "t_P": 0.22, "w_P0": 0.4, "x_P": -0.48}
names = "k_0 k_1 k_2 R_0 X_vv X_vr X_rr X_vvvv Y_v Y_r Y_vvv Y_vvr Y_vrr Y_rrr N_v N_r N_vvv N_vvr N_vrr N_rrr".split()
numbers = [0.2931, -0.2753, -0.1385, 0.022, -0.04, 0.002, 0.011, 0.771, -0.315, 0.083, -1.607, 0.379, -0.391, 0.008]
numbers += [-0.137, -0.049, -0.03, -0.294, 0.055, -0.013]
derivatives = {name if name[0] == "k" else f"{name}_dash": number for name, number in zip(names, numbers, strict=True)}
t = np.linspace(0, 60, 601)


def speed_after_a_minute(turns):
    found = simulate_mmg_3dof(
        Mmg3DofBasicParams(**hull), Mmg3DofManeuveringParams(**derivatives), t, np.zeros(601), np.full(601, turns), u0=1.0
    )
    return float(found.sol(60.0)[0])


ahead, astern = speed_after_a_minute(10.0), speed_after_a_minute(-10.0)
seen(f"from 1 m/s, +10 turns a second: {ahead:.2f} m/s after 60 s", ahead > 0.9)
seen(f"from 1 m/s, -10 turns a second: {astern:.2f} m/s after 60 s", astern > ahead)
PY
