# What type checkers see of the rooms, which __init__.py loads when they are first used.
from shaftprint import arguments as arguments
from shaftprint import arrays as arrays
from shaftprint import bench as bench
from shaftprint import campaign as campaign
from shaftprint import card as card
from shaftprint import catalogue as catalogue
from shaftprint import clocks as clocks
from shaftprint import design as design
from shaftprint import digits as digits
from shaftprint import distributions as distributions
from shaftprint import drive as drive
from shaftprint import errors as errors
from shaftprint import escape as escape
from shaftprint import export as export
from shaftprint import files as files
from shaftprint import fingerprint as fingerprint
from shaftprint import identify as identify
from shaftprint import kernels as kernels
from shaftprint import limits as limits
from shaftprint import memory as memory
from shaftprint import models as models
from shaftprint import normalisation as normalisation
from shaftprint import notebook as notebook
from shaftprint import propeller as propeller
from shaftprint import publication as publication
from shaftprint import reasons as reasons
from shaftprint import recording as recording
from shaftprint import rehearsal as rehearsal
from shaftprint import report as report
from shaftprint import settings as settings
from shaftprint import signals as signals
from shaftprint import simulation as simulation
from shaftprint import spectra as spectra
from shaftprint import spelling as spelling
from shaftprint import store as store
from shaftprint import survey as survey
from shaftprint import tables as tables
from shaftprint import time_domain as time_domain
from shaftprint import torsion as torsion
from shaftprint import tug as tug
from shaftprint import units as units
from shaftprint import validation as validation
from shaftprint import vessel as vessel
from shaftprint import zones as zones
from shaftprint.survey import run as open_survey  # noqa: F401

__version__: str
