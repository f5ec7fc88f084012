"""Fingerprints of many ships over many years in a database: SQLite in one file, or PostgreSQL for several computers.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
``tested_at``       -           when a recording began, kept in UTC
draught, trim       m           trim is positive aft
value, std          as stated   of a number, in the unit that its fingerprint has
low, high           as stated   95 % interval; none at an open end
=================== =========== ==================================================================================

A document is kept byte by byte, never changed and never deleted: another fingerprint of the same recording takes its
place in a history, and it stays. What is not in a document is refused or stated by hand, and nothing is guessed. Jobs
that make fingerprints stand in the same database: one is done exactly when its fingerprint is kept.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
