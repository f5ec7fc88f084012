"""What the settings of a job say: whether they can be used, and of which ship they speak."""

from typing import Any

from shaftprint.survey import load_trial


def settings_said(vessel: str, campaign: str, conditions: str | None) -> dict[str, Any]:
    """Return of which ship and line a vessel file speaks, and when the test was made, for JSON.

    Parameters
    ----------
    vessel, campaign
        Paths, or names of files that come with the program.
    conditions
        Path of the file of conditions; None where there is none.
    """
    trial = load_trial(vessel, campaign, conditions)
    ship = trial.vessel.ship
    began = trial.conditions.began(None)
    return {
        "ship": None if ship is None else ship.name,
        "imo": None if ship is None else ship.imo_number,
        "line": None if ship is None else ship.line,
        "tested_at": None if began is None else began.isoformat(),
    }
