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
``bench``       ``DriveFit``                ``equipped``, ``read_records``, ``identify_drive``
``tables``      ``Table``                   ``parameter_table``, ``physical_table``
``report``                                  ``render_report``, ``plot``, ``bode_chart``
``store``       ``Store``, ``History``      ``create_store``, ``open_store``, ``add``, ``history``, ``newest``
``tug``         ``Truth``                   ``sail``
=============== =========================== ==========================================================================

``sp.open_survey(recording, vessel, campaign)`` is ``survey.run``: all of ``shaftprint identify`` in one call.
Verbs take the noun first and the rest by keyword. Errors that a user can mend are ``errors.ShaftprintError``.
"""

import importlib
from typing import Any

__version__ = "0.1.0"

_ROOMS = (
    "bench",
    "campaign",
    "card",
    "catalogue",
    "clocks",
    "design",
    "drift",
    "drive",
    "errors",
    "export",
    "fingerprint",
    "fleet",
    "forecast",
    "identify",
    "limits",
    "models",
    "propeller",
    "recording",
    "rehearsal",
    "report",
    "settings",
    "signals",
    "simulation",
    "spectra",
    "store",
    "survey",
    "tables",
    "time_domain",
    "torsion",
    "tug",
    "units",
    "validation",
    "vessel",
    "web",
)

_INNER_ROOMS = (
    "arguments",
    "arrays",
    "choices",
    "cli",
    "digits",
    "distributions",
    "escape",
    "files",
    "kernels",
    "late",
    "markup",
    "memory",
    "normalisation",
    "notebook",
    "plain_table",
    "publication",
    "reasons",
    "records",
    "sender_cycle",
    "spelling",
    "zones",
)
"""What the rooms are made with; no word of the field, so a session does not offer it."""

_VERB = "open_survey"
"""All of ``shaftprint identify`` in one call, ``survey.run``."""


def __getattr__(name: str) -> Any:
    """Load a room when it is first used: all of them together take seconds.

    Raises
    ------
    AttributeError
        If there is no room of that name; the message says where names like it are.
    """
    if name == _VERB:
        return importlib.import_module("shaftprint.survey").run
    if name in _ROOMS or name in _INNER_ROOMS:
        return importlib.import_module(f"shaftprint.{name}")
    message = f"module 'shaftprint' has no attribute {name!r}"
    if name.startswith("_"):
        # what copy, pickle, inspect and notebooks ask every object for
        raise AttributeError(message)
    answers = importlib.import_module("shaftprint.notebook").closest_names(name)
    if answers:
        raise AttributeError(f"{message}; is {' or '.join(answers)} meant?")
    raise AttributeError(f"{message}; its rooms are {', '.join(_ROOMS)}.")


def __dir__() -> list[str]:
    return ["__version__", _VERB, *_ROOMS]
