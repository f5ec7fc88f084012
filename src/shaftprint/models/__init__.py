"""Grey-box model structures: blocks, their composition, exact delays, exact gradients, stability.

Arithmetic only: no data, no files, no plots.

=============== ======= ==============================================================================================
quantity        unit    meaning and sign
=============== ======= ==============================================================================================
``n``           -       deviation of engine speed over its working-point value; positive faster
``n_set``       -       deviation of the engine-speed set point over the same working-point speed
``e``           -       ``n_set - n``: positive when the engine is too slow
``E_n``         s       integral of ``e``
``M_s``         -       deviation of shaft torque at the gauge over its working-point value; positive when the engine
                        drives the propeller
``X``           -       deviation of the fuel rack over its working-point value; positive for more fuel
``v_s``         -       deviation of the speed of the ship over its working-point value; positive faster ahead
``M_m``         -       deviation of the torque of an electric machine, at the propeller shaft and over ``M_s0``
``theta_set``   -       deviation of the set point of the pitch over its working-point value; positive for more thrust
``s``           rad/s   Laplace variable, ``1j omega`` on the frequency axis
``tau``         s       inertia time ``2 pi I n_s0 / M_s0``, of the inertia that the index names
=============== ======= ==============================================================================================

Feedback is negative: the closed loop of forward ``G`` and back ``H`` is ``G / (1 + G H)``.
"""

from shaftprint.models._block import Block
from shaftprint.models._blocks import (
    FilteredDerivative,
    FirstOrderLag,
    Gain,
    Integrator,
    PIGovernor,
    SecondOrderLag,
)
from shaftprint.models._check import check_structure
from shaftprint.models._combination import Combination
from shaftprint.models._delays import AveragingSensor, Delay, PadeDelay, ZeroOrderHold
from shaftprint.models._diagram import Diagram, Port
from shaftprint.models._expression import Constant, Expression, Inverse, Sensitivity, feedback
from shaftprint.models._free_response import free_responses
from shaftprint.models._margins import Margins, margins, poles
from shaftprint.models._nyquist import is_stable, loop_gain, stable_rows, unstable_poles
from shaftprint.models._own_blocks import FunctionBlock, RationalBlock
from shaftprint.models._parameter import Parameter
from shaftprint.models._program import Computed, Late, Program, program_of
from shaftprint.models._role import Basis, PhysicalForm, Role
from shaftprint.models._sampled_drive import Held
from shaftprint.models._shaft_blocks import DynamicInflow, EntrainedWater, Inertia, Shaft, TorqueBalance
from shaftprint.models._small_signal import SmallSignal
from shaftprint.models._step_response import step_response
from shaftprint.models._structure import Structure
from shaftprint.models._tabulated import Tabulated
from shaftprint.models._tied_parameter import Tie
from shaftprint.models._working_point import at_working_point
from shaftprint.models.equations import (
    Flow,
    Formula,
    Governed,
    Leaves,
    Number,
    as_formula,
    backlash,
    boosted,
    choose,
    clip,
    coefficients,
    coulomb_friction,
    deadband,
    derivatives,
    evaluate,
    firing_delay,
    first_order_lag,
    full_load,
    limited_pi,
    maximum,
    minimum,
    number,
    postorder,
    quadratic_propeller,
    raised,
    rate_limited,
    realised,
    rebuilt,
    replaced,
    second_order_lag,
    slipping_clutch,
    stribeck_friction,
    table,
    two_sided,
)

__all__ = [
    "AveragingSensor",
    "Basis",
    "Block",
    "Combination",
    "Computed",
    "Constant",
    "Delay",
    "Diagram",
    "DynamicInflow",
    "EntrainedWater",
    "Expression",
    "FilteredDerivative",
    "FirstOrderLag",
    "Flow",
    "Formula",
    "FunctionBlock",
    "Gain",
    "Governed",
    "Held",
    "Inertia",
    "Integrator",
    "Inverse",
    "Late",
    "Leaves",
    "Margins",
    "Number",
    "PIGovernor",
    "PadeDelay",
    "Parameter",
    "PhysicalForm",
    "Port",
    "Program",
    "RationalBlock",
    "Role",
    "SecondOrderLag",
    "Sensitivity",
    "Shaft",
    "SmallSignal",
    "Structure",
    "Tabulated",
    "Tie",
    "TorqueBalance",
    "ZeroOrderHold",
    "as_formula",
    "at_working_point",
    "backlash",
    "boosted",
    "check_structure",
    "choose",
    "clip",
    "coefficients",
    "coulomb_friction",
    "deadband",
    "derivatives",
    "evaluate",
    "feedback",
    "firing_delay",
    "first_order_lag",
    "free_responses",
    "full_load",
    "is_stable",
    "limited_pi",
    "loop_gain",
    "margins",
    "maximum",
    "minimum",
    "number",
    "poles",
    "postorder",
    "program_of",
    "quadratic_propeller",
    "raised",
    "rate_limited",
    "realised",
    "rebuilt",
    "replaced",
    "second_order_lag",
    "slipping_clutch",
    "stable_rows",
    "step_response",
    "stribeck_friction",
    "table",
    "two_sided",
    "unstable_poles",
]
