"""Fit a structure to a measured response: search, weights, covariance.

=================== ======= ==========================================================================================
quantity            unit    meaning
=================== ======= ==========================================================================================
cost                -       half the sum of squared weighted residuals; for maximum likelihood ``2 cost`` is a
                            chi-square
``fit_percent``     %       ``100 (1 - |y - yh| / |y - mean y|)`` of one output (thesis eq. 2.41)
``fit_ceiling``     %       the same for the true model: what the noise allows
covariance          mixed   of the free parameters, each in its own unit
=================== ======= ==========================================================================================

Here are the verbs, what they take and what they return. All else is public behind the folders' own doors, such as
``identify.uncertainty.budget``. Each folder imports only from those above it (``judgement`` and ``prediction`` nothing
from each other):

=============== ======================================================================================================
folder          what happens there
=============== ======================================================================================================
``likelihood``  what a fit minimises: terms, weights, tails, priors
``search``      how the lowest cost is found: settings, starts, descent within bounds
``fit``         the verb and what it found: values, covariance, test of fit, other optima, scans
``uncertainty`` how far a number can be trusted: profile intervals, repeats, bands, the budget
``judgement``   whether the numbers of a fit may be used, and the sentences that say why
``prediction``  what a test can find before it is made
``comparison``  which of several structures the data want
=============== ======================================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
