"""One verb for what a session opens by name: results, recordings and settings files, as commands take them."""

from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import load_campaign
from shaftprint.campaign._trial_conditions import load_trial_conditions
from shaftprint.errors import ShaftprintError
from shaftprint.escape import printable
from shaftprint.file_kinds import kind_of_file
from shaftprint.files import reason
from shaftprint.fingerprint._json_file import IN_A_FOLDER, read_any_fingerprint
from shaftprint.publication._publish import complete
from shaftprint.recording._read import read_recording
from shaftprint.settings import shipped_names
from shaftprint.spelling import meant_beside
from shaftprint.vessel._vessel import load_vessel

_SETTINGS: Final[Mapping[str, Callable[[str], Any]]] = MappingProxyType(
    {"vessel": load_vessel, "campaign": load_campaign, "conditions": load_trial_conditions}
)
_PLAN = "plan.json"


@refusing_none(ShaftprintError, place='read("result"): the folder of a result, a logger file, a settings file')
def read(place: str | Path | Sequence[str | Path], *further: str | Path, **hints: Any) -> Any:
    """Return what a file or a folder holds, as commands take it; of several a tuple in their order.

    Parameters
    ----------
    place
        The folder of a result, or its fingerprint.json, for a ``Fingerprint``; a logger file, for a ``Recording``,
        which is open; a vessel, campaign or conditions file, or a shipped vessel or campaign by its name.
    further
        More of them.
    hints
        What a logger file does not say itself, as for ``read_recording``.

    Raises
    ------
    ShaftprintError
        If there is nothing that can be read; the message says what to give.
    """
    places = [place] if isinstance(place, str | Path) else [*place]
    found = tuple(_opened(str(one), hints) for one in (*places, *further))
    return found[0] if isinstance(place, str | Path) and not further else found


def _opened(name: str, hints: Mapping[str, Any]) -> Any:
    try:
        return _read(name, hints)
    except OSError as error:
        raise ShaftprintError(f"{name}: expected a file or a folder that can be opened: {reason(error)}.") from None


def _read(name: str, hints: Mapping[str, Any]) -> Any:
    path = Path(name)
    if path.is_dir():
        complete(path)
        return _of_folder(path)
    if not path.exists():
        for kind in ("vessel", "campaign"):
            if name in shipped_names(files(f"shaftprint.{kind}") / "shipped"):
                return _SETTINGS[kind](name)
        raise ShaftprintError(f"{name}: expected a file or a folder, found none there.{meant_beside(path)}")
    if path.suffix.lower() == ".toml":
        kind_there = kind_of_file(path) or ""
        if kind_there == "drive":
            raise ShaftprintError(
                f"{name}: expected a file of a ship, found that of a drive; sp.drive.load_drive reads it."
            )
        # what is of no kind is told what a vessel file has
        return _SETTINGS.get(kind_there, load_vessel)(name)
    if path.suffix.lower() == ".json":
        if path.name == _PLAN:
            raise ShaftprintError(f'{name}: expected a result, found a plan; sp.design.read_plan("{name}") reads it.')
        return read_any_fingerprint(path)
    return read_recording(path, **hints)


def _of_folder(folder: Path) -> Any:
    if (folder / IN_A_FOLDER).is_file():
        return read_any_fingerprint(folder)
    if (folder / _PLAN).is_file():
        return _read(str(folder / _PLAN), {})
    inside = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
    within = [name for name in inside if (folder / name / IN_A_FOLDER).is_file()]
    if within:
        hint = f'read one of its results, such as "{printable(str(folder / within[0]))}"'
    elif inside:
        hint = f'name a file in it, such as "{printable(str(folder / inside[0]))}"'
    else:
        hint = "it is empty"
    raise ShaftprintError(f"{folder}: expected the folder of a result, found no {IN_A_FOLDER} in it; {hint}.")
