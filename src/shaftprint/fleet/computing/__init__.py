"""The arithmetic of a job, and the process that does it: ``python -m shaftprint.fleet.computing``.

It is apart from the room, since a worker holds no more than the ledger and the processes.
"""
