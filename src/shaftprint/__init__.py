"""Fingerprints of ship propulsion lines, identified from a logger recording.

The rooms, in the order in which data flow through them: ``vessel``, ``campaign``, ``recording``, ``signals``,
``spectra``, ``models``, ``identify``, ``fingerprint``, ``report``; ``tug`` is a simulated ship that writes recordings.
"""

__version__ = "0.1.0"
