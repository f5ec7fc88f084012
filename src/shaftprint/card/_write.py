"""The verb ``write_vessel``: from a card to a vessel file that can be loaded."""

from pathlib import Path

from shaftprint.card._card import Card
from shaftprint.card._vessel_text import vessel_text
from shaftprint.errors import SettingsError
from shaftprint.files import reason, written_whole
from shaftprint.vessel._vessel import Vessel, load_vessel


def write_vessel(card: Card, path: str | Path) -> Vessel:
    """Write the vessel file that follows from a card, and return what is in it.

    Nothing is left half-written.

    Parameters
    ----------
    card
        What stands on the ship's card.
    path
        A file that does not exist yet.

    Raises
    ------
    SettingsError
        If the card gives no vessel, the file exists already or cannot be written.
    """
    path = Path(path)
    text = vessel_text(card)
    try:
        with written_whole(path) as part:
            part.write_text(text, encoding="utf-8")
            try:
                return load_vessel(part)
            except SettingsError as error:
                # what was written nobody will see under that name
                raise SettingsError(str(error).replace(str(part), str(path))) from None
    except FileExistsError as error:
        raise SettingsError(str(error)) from None
    except OSError as error:
        raise SettingsError(f"{path}: the file cannot be written: {reason(error)}.") from None
