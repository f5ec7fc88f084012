"""Equations of motion of a line, with viscous damping: states are the twists of the springs and the speeds."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.torsion._line import TorsionalLine


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StateSpace:
    """``dx/dt = A x + B u`` with the twists ``q`` [rad] of the springs and the speeds ``w`` [rad/s] of the bodies.

    ``dq/dt = D_q w`` and ``J dw/dt = -D_q^T k q - (D^T c D + d) w + u``, ``D`` the incidence of the links and ``D_q``
    its rows with a stiffness. Twists instead of angles: a free line has no angle that would run away.
    """

    matrix: FloatArray
    """``A``, shape (states, states)."""
    input: FloatArray
    """``B``, torques on the bodies [N m], shape (states, bodies)."""
    link_torque: FloatArray
    """Torque of each link from the states [N m], shape (links, states)."""
    springs: int
    """Number of twists, the first states."""


def state_space(line: TorsionalLine, damping_nm_s_rad: FloatArray) -> StateSpace:
    """Return the equations of motion of a line.

    ``damping_nm_s_rad``: viscous damping of each link [N m s/rad], shape (links,).
    """
    incidence, stiffness = line.incidence, line.stiffness_nm_rad
    elastic = stiffness > 0.0
    springs, bodies = int(elastic.sum()), len(line.bodies)
    link_torque = np.zeros((len(line.links), springs + bodies))
    link_torque[elastic, :springs] = np.diag(stiffness[elastic])
    link_torque[:, springs:] = damping_nm_s_rad[:, None] * incidence
    inverse = 1.0 / line.inertia_kg_m2[:, None]
    matrix = np.zeros((springs + bodies, springs + bodies))
    matrix[:springs, springs:] = incidence[elastic]
    matrix[springs:] = -inverse * (incidence.T @ link_torque)
    matrix[springs:, springs:] -= inverse * np.diag(line.load_nm_s_rad)
    to_speed = np.zeros((springs + bodies, bodies))
    to_speed[springs:] = inverse * np.eye(bodies)
    return StateSpace(matrix=matrix, input=to_speed, link_torque=link_torque, springs=springs)
