"""Which ship a shaft line belongs to: what fingerprints of many years are kept under."""

from typing import Annotated

from pydantic import AfterValidator, Field

from shaftprint.settings import Settings

DIGITS = 7

LONGEST_NAME = 100
ShortName = Annotated[str, Field(strict=True, min_length=1, max_length=LONGEST_NAME)]


def _checked(number: int) -> int:
    if not is_imo_number(number):
        raise ValueError(f"expected an IMO number, seven digits of which the last checks the others, found {number}")
    return number


def is_imo_number(number: int) -> bool:
    """Return whether a number can be that of a ship: the last of its seven digits checks the others.

    The first six, times 7, 6, 5, 4, 3 and 2, have a sum that ends in the seventh (IMO resolution A.1117(30)).
    """
    if not 10 ** (DIGITS - 1) <= number < 10**DIGITS:
        return False
    digits = [int(letter) for letter in str(number)]
    total = sum(factor * digit for factor, digit in zip(range(DIGITS, 1, -1), digits, strict=False))
    return total % 10 == digits[-1]


ImoNumber = Annotated[int, Field(strict=True), AfterValidator(_checked)]
"""The number that a ship keeps for life, whatever it is called."""


class Ship(Settings):
    """The ship, and which of its shaft lines was tested."""

    name: ShortName
    """Name of the ship, without that of the line."""
    imo_number: ImoNumber | None = None
    """Its IMO number; small and inland ships have none."""
    class_name: ShortName | None = None
    """What its sister ships have in common, such as ``Stan Tug 1205``."""
    line: ShortName
    """The shaft line, such as ``port``."""
