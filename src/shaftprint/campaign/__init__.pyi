from ._both_shafts import CampaignOfBoth
from ._campaign import Campaign, load_campaign
from ._excitations import Sine, Staircase
from ._multisine import Multisine
from ._setpoint import setpoint
from ._trial_conditions import TrialConditions, load_trial_conditions

__all__ = [
    "Campaign",
    "CampaignOfBoth",
    "Multisine",
    "Sine",
    "Staircase",
    "TrialConditions",
    "load_campaign",
    "load_trial_conditions",
    "setpoint",
]
