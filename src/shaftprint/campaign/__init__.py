"""What is asked of the ship: sines, multisines, chirps and staircases of the speed set point, from a TOML file.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
time                  s        since the start of the recording
set point ``U``       V        what is put out to the governor; a lower voltage asks for more speed
                               on the Stan Tug
offset                V        set point outside of every excitation, and the middle of sines and
                               chirps
amplitude             V        half of peak to peak
frequency             Hz       of a test line; never rad/s
===================== ======== ====================================================================

A sine and a chirp start at their phase, ``U = offset + amplitude sin(phase)``, 0 where none is stated. A
staircase jumps.
Every excitation holds in the half-open interval from its start to its stop.
"""

from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._both_shafts import SIDES, CampaignOfBoth, load_campaign_of_both
from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Chirp, Sine, Staircase
from shaftprint.campaign._file_text import campaign_text, tests_text
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._multisine import Multisine
from shaftprint.campaign._setpoint import setpoint
from shaftprint.campaign._trial_conditions import TrialConditions, load_trial_conditions

__all__ = [
    "SIDES",
    "BinarySequence",
    "Campaign",
    "CampaignOfBoth",
    "Chirp",
    "Excitation",
    "Leg",
    "Multisine",
    "Sine",
    "Staircase",
    "TrialConditions",
    "campaign_text",
    "load_campaign",
    "load_campaign_of_both",
    "load_trial_conditions",
    "setpoint",
    "tests_text",
]
