"""Recordings of a fleet to fingerprints: jobs in the ledger of a store, and workers that do them on any computer.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
lease               s           how long a worker that is not heard of keeps its job
try                 -           a worker that has begun a job; the third that dies on it is the last
=================== =========== ==================================================================================

The truth lies in the store: a job is done exactly when its fingerprint is there. Whoever works, processes of one
computer, several computers, an existing Dask cluster, only takes jobs from it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
