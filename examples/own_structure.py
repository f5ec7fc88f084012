"""A structure of one's own for a ship: whether the shaft twists between the speed pick-up and the propeller.

This file is all that the command line needs; nothing in the package is touched. After `shaftprint demo`::

    shaftprint structures examples/own_structure.py:elastic_core
    shaftprint identify demo/recording.nc --vessel demo/vessel.toml --campaign demo/campaign.toml -o elastic
        --structure examples/own_structure.py:elastic_core        (all in one line)

A torque ``M_s`` twists the shaft, so while it changes the engine is faster than the propeller. Linearised, with the
compliance ``c`` of the shaft times ``M_s0 / (2 pi n_s0)``::

    n = n_propeller + c s M_s        n_propeller / M_s = 1 / (tau_dn s + k_q)

As a script it lets the recording of the demo decide between this structure and the shipped one of a stiff shaft.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint import campaign, catalogue, identify, recording, signals, spectra, vessel
from shaftprint.catalogue import ShipRole
from shaftprint.models import Block, Delay, Parameter, Shaft, Structure


@dataclass(frozen=True, slots=True, eq=False)
class Twist(Block):
    """Speed lost in the shaft over its torque: ``c s``."""

    compliance: Parameter

    @property
    def parameters(self):
        return (self.compliance,)

    def transfer(self, s, c):
        return c * s

    def derivatives(self, s, response, c):
        return (np.broadcast_to(s, response.shape),)

    def ratio(self, c):
        return np.array([c, 0.0]), np.array([1.0])


TAU_DN = Parameter(
    "tau_dn", "s", 0.0, 2.0, 0.3, "inertia time downstream of the torque gauge", role=ShipRole.INERTIA_DOWNSTREAM
)
K_Q = Parameter("k_q", "-", 1.0, 3.0, 2.0, "slope of the propeller torque", role=ShipRole.LOAD_SLOPE)
COMPLIANCE = Parameter("c", "s", -0.01, 0.01, 0.001, "compliance of the shaft")
T_GAUGE = Parameter(
    "t_gauge", "s", -0.02, 0.02, 0.0, "error of the known latency of the torque telemetry", role=ShipRole.TORQUE_LATENCY
)


def elastic_core():
    """Return the core propulsion behind an elastic shaft."""
    line = Shaft((TAU_DN,), K_Q) + Twist(COMPLIANCE)
    return Structure(
        name="ELASTIC-CORE",
        title="core propulsion behind an elastic shaft",
        input="M_s",
        outputs={"n": line / Delay(T_GAUGE)},
    )


if __name__ == "__main__":
    tug, test = vessel.load_vessel("demo/vessel.toml"), campaign.load_campaign("demo/campaign.toml")
    with recording.read_recording("demo/recording.nc") as raw:
        prepared = signals.prepare_signals(raw, tug, test)
    _, core = spectra.open_loop(spectra.estimate_response(prepared, test))

    stiff, elastic = catalogue.structure("GAUGE-CORE"), elastic_core()
    known = identify.Settings(priors=identify.priors_from_vessel(elastic, tug, prepared.working_point))
    comparison = identify.compare_structures([stiff, elastic], core, rng=np.random.default_rng(1), settings=known)
    for candidate in comparison.candidates:
        numbers = ", ".join(f"{n.name} = {n.value:.4f} +/- {n.std:.4f}" for n in candidate.identification.parameters)
        print(f"{candidate.name}: {numbers}")
    print(*comparison.sentences, sep="\n")
