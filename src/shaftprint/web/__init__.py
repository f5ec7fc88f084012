"""A server of pages: ships with a word for each, histories, comparisons, jobs and uploads, for browsers and programs.

It loads nothing that calculates. What is calculated from a user's file is calculated by processes beside it, which have
limits of memory and time; what somebody does not see is not there for him.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
