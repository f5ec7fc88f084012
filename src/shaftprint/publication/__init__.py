"""Results that appear as a whole: written and synced in a hidden folder, committed by one rename, then moved.

======================== =======================================================================================
file in the folder       meaning
======================== =======================================================================================
``.shaftprint.lock``     the system's lock on it is held by the command that writes here; a dead one holds none
``.shaftprint.new/``     new results that are being written
``.shaftprint.journal``  the new results are complete and synced: whoever reads or writes here next moves them
======================== =======================================================================================

Without a journal the folder holds the earlier results; with one, the new. Decision 31 says why.
"""
