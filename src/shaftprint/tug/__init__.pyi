from ._coupling import Coupling
from ._like_stan_tug import like_stan_tug_1205
from ._noise import Noise
from ._sail import sail
from ._sailing import Sailing
from ._simulated_fleet import Tolerances
from ._truth import Truth, normalised_truth, read_truth, truth_path
from ._tug import Tug
from .plant._physics import build_plant
from .plant._plant import derivatives, governor_rack
from .service._sail_service import sail_service

__all__ = [
    "Coupling",
    "Noise",
    "Sailing",
    "Tolerances",
    "Truth",
    "Tug",
    "build_plant",
    "derivatives",
    "governor_rack",
    "like_stan_tug_1205",
    "normalised_truth",
    "read_truth",
    "sail",
    "sail_service",
    "truth_path",
]
