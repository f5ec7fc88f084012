"""What a model makes of a record is compared with it by: misfit beyond noise, remaining delay, numbers of a step."""

from shaftprint.validation.measures._delay import LONGEST_S, RemainingDelay, remaining_delay
from shaftprint.validation.measures._low_pass import low_pass, reach_of_low_pass
from shaftprint.validation.measures._misfit import Compared, Misfit, Outcome, Unfiltered, misfit_of
from shaftprint.validation.measures._noise_pieces import LEAST_LOAD, NoisePieces, QuietNoise, quiet_noise
from shaftprint.validation.measures._reach import EVERYWHERE, Reach, Swept, WhileSettling, while_settling
from shaftprint.validation.measures._step_numbers import STEP_NUMBERS, step_numbers

__all__ = [
    "EVERYWHERE",
    "LEAST_LOAD",
    "LONGEST_S",
    "STEP_NUMBERS",
    "Compared",
    "Misfit",
    "NoisePieces",
    "Outcome",
    "QuietNoise",
    "Reach",
    "RemainingDelay",
    "Swept",
    "Unfiltered",
    "WhileSettling",
    "low_pass",
    "misfit_of",
    "quiet_noise",
    "reach_of_low_pass",
    "remaining_delay",
    "step_numbers",
    "while_settling",
]
