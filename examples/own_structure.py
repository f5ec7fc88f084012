"""A structure of one's own: does the propeller of this ship show dynamic inflow? Run `shaftprint demo` first.

When the speed of a propeller changes, the water through it follows a moment later, and until then the torque is larger
than the quadratic law says. Linearised, with the time ``tau_i`` that the water needs and the strength ``kappa``::

    M_s / n = tau_dn s + k_q + kappa tau_i s / (tau_i s + 1)

The block below is all that shaftprint does not have. Nothing in the package is touched.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint import campaign, identify, models, recording, signals, spectra, vessel
from shaftprint.models import Block, Inverse, Parameter, Structure, TorqueBalance


@dataclass(frozen=True, slots=True, eq=False)
class DynamicInflow(Block):
    """``kappa tau_i s / (tau_i s + 1)``, after Blanke, Lindegaard and Fossen, Dynamic model for thrust, 2000."""

    strength: Parameter
    time: Parameter

    @property
    def parameters(self):
        return (self.strength, self.time)

    def transfer(self, s, kappa, tau_i):
        return kappa * tau_i * s / (tau_i * s + 1.0)

    def derivatives(self, s, response, kappa, tau_i):
        lag = tau_i * s + 1.0
        return tau_i * s / lag, kappa * s / lag**2

    def ratio(self, kappa, tau_i):
        return np.array([kappa * tau_i, 0.0]), np.array([tau_i, 1.0])


TAU_DN = Parameter("tau_dn", "s", 0.0, 2.0, 0.3, "inertia time downstream of the torque gauge")
K_Q = Parameter("k_q", "-", 1.0, 3.0, 2.0, "slope of the propeller torque")
KAPPA = Parameter("kappa", "-", -1.0, 3.0, 0.5, "strength of the dynamic inflow")
TAU_I = Parameter("tau_i", "s", 0.02, 0.5, 0.1, "time that the water needs to follow", held=True)

inflow = Structure(
    name="INFLOW",
    title="core propulsion with dynamic inflow",
    input="M_s",
    outputs={"n": Inverse(TorqueBalance(TAU_DN, K_Q) + DynamicInflow(KAPPA, TAU_I))},
)

tug, test = vessel.load_vessel("demo/vessel.toml"), campaign.load_campaign("demo/campaign.toml")
with recording.read_recording("demo/recording.nc") as raw:
    prepared = signals.prepare_signals(raw, tug, test)
_, core = spectra.open_loop(spectra.estimate_response(prepared, test))

for structure in (models.structure("GAUGE-CORE"), inflow):
    found = identify.identify(structure, core, rng=np.random.default_rng(1))
    numbers = ", ".join(f"{number.name} = {number.value:.4f} +/- {number.std:.4f}" for number in found.parameters)
    print(f"{structure.name}: {numbers}; chi-square {2.0 * found.cost:.1f} for {found.degrees_of_freedom}")
