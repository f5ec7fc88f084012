"""Natural frequencies, damping and shapes of a line."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.torsion._line import TorsionalLine

TOLERANCE = 1e-12
MOST_STEPS = 60
# An eigenvalue whose imaginary part is a smaller share of the largest is a rigid body or an aperiodic motion.
APERIODIC = 1e-7


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Modes:
    """Vibrations of a line, slowest first; turning as a whole and what does not oscillate are left out."""

    line: TorsionalLine
    """The line."""
    frequency_hz: FloatArray
    """Natural frequency [Hz], ``|lambda| / (2 pi)``, shape (modes,)."""
    frequency_std_hz: FloatArray
    """Standard deviation [Hz] from those of inertias and stiffnesses, taken as independent, shape (modes,)."""
    damping_ratio: FloatArray
    """``-Re lambda / |lambda|``, shape (modes,)."""
    shape: ComplexArray
    """Amplitude of each body, 1 where it is largest, shape (modes, bodies)."""
    kinetic_share: FloatArray
    """Share of each body in the kinetic energy, shape (modes, bodies)."""
    elastic_share: FloatArray
    """Share of each link in the elastic energy, shape (modes, links)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("frequency_hz", "frequency_std_hz", "damping_ratio", "kinetic_share", "elastic_share"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))
        object.__setattr__(self, "shape", frozen_complex(self.shape))

    def moves(self, mode: int) -> str:
        """Return the body that has most of the kinetic energy in a mode."""
        return self.line.bodies[int(np.argmax(self.kinetic_share[mode]))]

    def twists(self, mode: int) -> str:
        """Return the link that has most of the elastic energy in a mode."""
        return self.line.link_name(int(np.argmax(self.elastic_share[mode])))


def modes(line: TorsionalLine) -> Modes:
    """Return the modes of a line with its damping.

    ``(lambda^2 J + lambda C + K) phi = 0``. The loss of each link counts as the viscous damping that is as large at the
    natural frequency of the mode itself, ``k psi / (2 pi |lambda|)``, found by iteration. Changes of ``lambda`` follow
    from ``d lambda = -phi^T (lambda^2 dJ + lambda dC + dK) phi / (phi^T (2 lambda J + C) phi)`` (Fox and Kapoor, Rates
    of change of eigenvalues and eigenvectors, AIAA Journal 6, 1968, for symmetric matrices).
    """
    system = state_space(line, np.array([link.damping_nm_s_rad for link in line.links]))
    values = np.linalg.eigvals(system.matrix)
    least = APERIODIC * np.max(np.abs(values))
    starts = values[values.imag > least]
    pairs = sorted((_settled(line, complex(start)) for start in starts), key=lambda pair: abs(pair[0]))
    roots = np.array([root for root, _ in pairs])
    shapes = np.array([shape for _, shape in pairs]).reshape(-1, len(line.bodies))
    kinetic = line.inertia_kg_m2 * np.abs(shapes) ** 2
    elastic = line.stiffness_nm_rad * np.abs(shapes @ line.incidence.T) ** 2
    return Modes(
        line=line,
        frequency_hz=np.abs(roots) / (2.0 * np.pi),
        frequency_std_hz=np.array([_std_hz(line, root, shape) for root, shape in pairs]),
        damping_ratio=-roots.real / np.abs(roots),
        shape=shapes,
        kinetic_share=kinetic / kinetic.sum(axis=1, keepdims=True),
        elastic_share=elastic / elastic.sum(axis=1, keepdims=True),
    )


def _settled(line: TorsionalLine, start: complex) -> tuple[complex, ComplexArray]:
    """Return the eigenvalue near a start with the damping that belongs to its own frequency, and its shape."""
    root = start
    for _ in range(MOST_STEPS):
        system = state_space(line, line.viscous_nm_s_rad(abs(root)))
        values, vectors = np.linalg.eig(system.matrix)
        nearest = int(np.argmin(np.abs(values - root)))
        before, root = root, complex(values[nearest])
        if abs(root - before) <= TOLERANCE * abs(root):
            break
    shape = vectors[system.springs :, nearest]
    return root, shape / shape[int(np.argmax(np.abs(shape)))]


def _std_hz(line: TorsionalLine, root: complex, shape: ComplexArray) -> float:
    """Return the standard deviation of the natural frequency, each inertia and stiffness a separate source."""
    twist = line.incidence @ shape
    damping = line.viscous_nm_s_rad(abs(root))
    scale = 2.0 * root * np.sum(line.inertia_kg_m2 * shape**2)
    scale += np.sum(damping * twist**2) + np.sum(line.load_nm_s_rad * shape**2)
    loss = np.array([link.relative_damping for link in line.links]) / (2.0 * np.pi * abs(root))
    by_inertia = -(root**2) * shape**2 / scale * line.inertia_std_kg_m2
    by_stiffness = -(1.0 + root * loss) * twist**2 / scale
    by_stiffness = by_stiffness * np.array([link.stiffness_std_nm_rad for link in line.links])
    slopes = np.concatenate([by_inertia, by_stiffness])
    return float(np.linalg.norm((slopes * np.conj(root)).real) / abs(root) / (2.0 * np.pi))


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
