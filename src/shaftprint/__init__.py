"""Fingerprints of ship propulsion lines, identified from a logger recording.

``import shaftprint as sp`` gives the rooms; a room is loaded when it is first used. Data flow through them in this
order, and each hands one noun to the next:

=============== =========================== ==========================================================================
room            nouns                       verbs
=============== =========================== ==========================================================================
``vessel``      ``Vessel``                  ``load_vessel``
``campaign``    ``Campaign``                ``load_campaign``, ``setpoint``
``recording``   ``Recording``               ``read_recording``, ``write_recording``
``clocks``      ``ClockMap``                ``align``
``signals``     ``Signals``                 ``prepare_signals``, ``inspect_channels``
``spectra``     ``FrequencyResponse``       ``estimate_response``, ``response_from_arrays``, ``plant_from_closed_loop``
``models``      ``Structure``, ``Parameter`` ``margins``, ``is_stable``
``catalogue``                               ``structure``, ``limited``
``identify``    ``Identification``,         ``identify``, ``assess``, ``profile``, ``identifiability``,
                ``Verdict``                 ``predict_accuracy``, ``compare_structures``
``time_domain`` ``Record``                  ``records_of``, ``identify_in_time``, ``identify_nonlinear``
``simulation``  ``Trace``                   ``simulate``, ``simulate_exactly``, ``equilibrium``, ``linearise``
``validation``  ``Validation``              ``validate``
``fingerprint`` ``Fingerprint``             ``take_fingerprint``, ``read_fingerprint``, ``write_fingerprint``
``drift``       ``Finding``                 ``differ``, ``watch``, ``judge_sisters``
``design``      ``Plan``, ``Wish``, ``Limits`` ``design_campaign``, ``assumed_ship``, ``limits_from_vessel``
``rehearsal``                               ``rehearse_on_tug``
``export``      ``ExportedModel``           ``exported_model``, ``write_fmu``, ``write_matlab``, ``write_modelica``
``survey``      ``Survey``                  ``run``, ``measure``, ``fit``, ``survey_of``
``live``                                    ``envelope_of``, ``prove``, ``rehearse``, ``replayed``
``service``     ``Scan``, ``ServiceDay``    ``scan``, ``fit_service``
``bench``       ``DriveFit``                ``equipped``, ``read_records``, ``identify_drive``
``tables``      ``Table``                   ``parameter_table``, ``physical_table``
``report``                                  ``render_report``, ``plot``, ``bode_chart``
``store``       ``Store``, ``History``      ``create_store``, ``open_store``, ``add``, ``history``, ``newest``
``tug``         ``Truth``                   ``sail``
=============== =========================== ==========================================================================

``sp.open_survey(recording, vessel, campaign)`` is ``survey.run``: all of ``shaftprint identify`` in one call.
``sp.read("result")`` is ``survey.read``: the result, recording or settings file that a command would take.
Verbs take the noun first and the rest by keyword. Errors that a user can mend are ``errors.ShaftprintError``.
"""

import importlib
import pkgutil
from typing import Any

__version__ = "0.1.0"

_NOT_OFFERED = {"cli", "kernels", "markup", "notebook", "publication"}
"""Rooms that others are made with; no word of the field, so a session does not offer them."""
_OFFERED_FILES = {"errors", "settings", "units"}
"""Leaf modules that a session offers."""

_VERBS = {"open_survey": "run", "read": "read"}
"""Verbs of ``survey`` that stand beside the rooms, by the name of each here."""


def __getattr__(name: str) -> Any:
    """Load a room when it is first used: all of them together take seconds.

    Raises
    ------
    AttributeError
        If there is no room of that name; the message says where names like it are.
    """
    if name in _VERBS:
        return getattr(importlib.import_module("shaftprint.survey"), _VERBS[name])
    rooms = _rooms()
    if name in rooms:
        return importlib.import_module(f"shaftprint.{name}")
    message = f"module 'shaftprint' has no attribute {name!r}"
    if name.startswith("_"):
        # what copy, pickle, inspect and notebooks ask every object for
        raise AttributeError(message)
    answers = importlib.import_module("shaftprint.notebook._public_names").closest_names(name)
    if answers:
        raise AttributeError(f"{message}; is {' or '.join(answers)} meant?")
    raise AttributeError(f"{message}; its rooms are {', '.join(room for room in rooms if rooms[room])}.")


def __dir__() -> list[str]:
    return ["__version__", *_VERBS, *(room for room, is_offered in _rooms().items() if is_offered)]


def _rooms() -> dict[str, bool]:
    """Return all rooms and leaf modules, which are what lies in this folder, with whether a session offers them."""
    found = {module.name: module.ispkg for module in pkgutil.iter_modules(__path__) if module.name != "__main__"}
    return {
        name: name not in _NOT_OFFERED if is_room else name in _OFFERED_FILES for name, is_room in sorted(found.items())
    }
