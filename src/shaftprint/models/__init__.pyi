from ._block import Block
from ._blocks import FilteredDerivative, FirstOrderLag, Gain, Integrator, PIGovernor, SecondOrderLag
from ._check import check_structure
from ._combination import Combination
from ._delays import AveragingSensor, Delay, PadeDelay, ZeroOrderHold
from ._diagram import Diagram
from ._expression import Constant, Sensitivity, feedback
from ._margins import margins
from ._nyquist import is_stable
from ._own_blocks import FunctionBlock, RationalBlock
from ._parameter import Parameter
from ._sampled_drive import Held
from ._shaft_blocks import DynamicInflow, EntrainedWater, Inertia, Shaft, TorqueBalance
from ._step_response import step_response
from ._structure import Structure
from ._tied_parameter import Tie
from ._working_point import at_working_point
from .equations._calculus import derivatives
from .equations._engine_parts import boosted, firing_delay, full_load, quadratic_propeller
from .equations._formula import choose, clip, maximum, minimum, table
from .equations._friction import backlash, coulomb_friction, stribeck_friction
from .equations._limits import deadband, first_order_lag, limited_pi, rate_limited, second_order_lag

__all__ = [
    "AveragingSensor",
    "Block",
    "Combination",
    "Constant",
    "Delay",
    "Diagram",
    "DynamicInflow",
    "EntrainedWater",
    "FilteredDerivative",
    "FirstOrderLag",
    "FunctionBlock",
    "Gain",
    "Held",
    "Inertia",
    "Integrator",
    "PIGovernor",
    "PadeDelay",
    "Parameter",
    "RationalBlock",
    "SecondOrderLag",
    "Sensitivity",
    "Shaft",
    "Structure",
    "Tie",
    "TorqueBalance",
    "ZeroOrderHold",
    "at_working_point",
    "backlash",
    "boosted",
    "check_structure",
    "choose",
    "clip",
    "coulomb_friction",
    "deadband",
    "derivatives",
    "feedback",
    "firing_delay",
    "first_order_lag",
    "full_load",
    "is_stable",
    "limited_pi",
    "margins",
    "maximum",
    "minimum",
    "quadratic_propeller",
    "rate_limited",
    "second_order_lag",
    "step_response",
    "stribeck_friction",
    "table",
]
