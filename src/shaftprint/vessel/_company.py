"""Who makes the tests, as a report names them."""

import re
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field, PrivateAttr

from shaftprint.settings import Settings
from shaftprint.vessel._ship import ShortName

_PICTURE = re.compile(r"[^./\\:\x00-\x1f][^/\\:\x00-\x1f]{0,200}\.(png|jpe?g)", flags=re.IGNORECASE)


def _checked(name: str) -> str:
    if not _PICTURE.fullmatch(name):
        raise ValueError(f"expected the name of a PNG or JPEG file beside the vessel file, found {name}")
    return name


class Company(Settings):
    """The company on the first page of a report."""

    name: ShortName
    """Its name."""
    logo: Annotated[str, Field(strict=True), AfterValidator(_checked)] | None = None
    """Its logo: the name of a PNG or JPEG file beside the vessel file."""

    _folder: Path | None = PrivateAttr(default=None)

    def lies_in(self, folder: Path) -> None:
        """Note where the vessel file lies."""
        self._folder = folder

    @property
    def logo_path(self) -> Path | None:
        """Where the logo is to lie; None where there is none, or the vessel comes from no file."""
        return None if self.logo is None or self._folder is None else self._folder / self.logo
