"""A planned test sailed before it is sailed: raw recordings of a simulated tug that is as the ship is assumed.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
truth               as is   parameters and combinations of the simulated ship, normalised at the first working point
limited share       -       part of the time of a leg for which a limit of the simulated engine acted
=================== ======= ==========================================================================================

The tug shares no physics with the models that are identified from it, so that what a plan overlooks shows.
"""

from shaftprint.rehearsal._continue import standing_after
from shaftprint.rehearsal._rehearse import rehearse_on_tug
from shaftprint.rehearsal._simulated_ship import simulated_truth, tug_of_plan

__all__ = ["rehearse_on_tug", "simulated_truth", "standing_after", "tug_of_plan"]
