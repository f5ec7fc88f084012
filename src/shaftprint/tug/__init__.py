"""A simulated tug with known truth that writes raw logger files.

It shares no physics with the models that are identified: a sign error cannot live in both.

============================ ========== ==========================================================================
quantity                     unit       meaning and sign
============================ ========== ==========================================================================
``n_s``, ``n_e``             rev/s      speed of propeller shaft and engine, positive ahead, ``n_e = i n_s``
``M_s``                      N m        torque at the gauge, positive when the engine drives the propeller
``T``                        N m        torque of an elastic coupling, positive as ``M_s``
``M_b``                      N m        brake torque at the engine flange, negative when the engine is motored
``M_m``                      N m        torque of an electric machine on the gearbox at the propeller shaft, negative
                                        when it is taken out
``X``                        1          fuel rack above zero-torque running; 1 gives rated torque at rated speed
``U``                        V          set-point voltage; more negative asks for more speed
``t_d``, ``t_sp``            s          delays inside the loop and before it
``u``                        rev/s      slipstream velocity, as the shaft speed to which it belongs in steady running
``v``                        m/s        speed of the ship through the water, positive ahead; 0 at the quay
inertias                     kg m2      referred to the propeller shaft, split at the gauge
============================ ========== ==========================================================================
"""

from shaftprint.tug._changes import (
    in_water,
    on_another_day,
    sea_water_kg_m3,
    with_delay,
    with_gains,
    with_inertia,
    with_injection,
    with_load,
)
from shaftprint.tug._coupling import Coupling
from shaftprint.tug._ideal import IdealSignals, simulate_signals
from shaftprint.tug._in_messages import MESSAGES, in_messages
from shaftprint.tug._like_stan_tug import like_stan_tug_1205, with_lever_of
from shaftprint.tug._linearise import linearised_response
from shaftprint.tug._linearise_both import linearised_both
from shaftprint.tug._noise import Noise
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug._pitch_series import steepened, torque_over_pitch
from shaftprint.tug._sail import sail
from shaftprint.tug._sail_as import sail_as
from shaftprint.tug._sail_both import TruthOfBoth, sail_both
from shaftprint.tug._sailing import Sailing
from shaftprint.tug._shaft_machine import ShaftMachineTruth
from shaftprint.tug._shared_water import SharedWater
from shaftprint.tug._simulated_fleet import (
    SailedTest,
    SimulatedFleet,
    Tolerances,
    as_built,
    sail_test,
    simulated_fleet,
    zero_taken,
)
from shaftprint.tug._simulated_ship import ShipWork, SimulatedShip, Wear, ship_at, vessel_at, with_works
from shaftprint.tug._truth import StripTruth, Truth, normalised_truth, read_truth, truth_path
from shaftprint.tug._tug import Tug
from shaftprint.tug.sensors import Fault

__all__ = [
    "MESSAGES",
    "Coupling",
    "Fault",
    "IdealSignals",
    "Noise",
    "PitchActuation",
    "SailedTest",
    "Sailing",
    "ShaftMachineTruth",
    "SharedWater",
    "ShipWork",
    "SimulatedFleet",
    "SimulatedShip",
    "StripTruth",
    "Tolerances",
    "Truth",
    "TruthOfBoth",
    "Tug",
    "Wear",
    "as_built",
    "in_messages",
    "in_water",
    "like_stan_tug_1205",
    "linearised_both",
    "linearised_response",
    "normalised_truth",
    "on_another_day",
    "read_truth",
    "sail",
    "sail_as",
    "sail_both",
    "sail_test",
    "sea_water_kg_m3",
    "ship_at",
    "simulate_signals",
    "simulated_fleet",
    "steepened",
    "torque_over_pitch",
    "truth_path",
    "vessel_at",
    "with_delay",
    "with_gains",
    "with_inertia",
    "with_injection",
    "with_lever_of",
    "with_load",
    "with_works",
    "zero_taken",
]
