"""How late an instrument shows what it measures."""

from typing import Annotated, TypeAlias

from pydantic import AfterValidator

from shaftprint.settings import NotNegativeNumber
from shaftprint.units import MILLI

# Telemetries, filters and messages of a bus are late by milliseconds to tenths of a second [s].
_LONGEST_S = 1.0


def _of_an_instrument(seconds: float) -> float:
    if seconds > _LONGEST_S:
        raise ValueError(
            f"expected a latency of at most {_LONGEST_S:g} s, found {seconds:g} s; {seconds:g} ms are "
            f"{seconds / MILLI:g} s."
        )
    return seconds


LatencySeconds: TypeAlias = Annotated[NotNegativeNumber, AfterValidator(_of_an_instrument)]
"""A time by which a line cannot be identified where it is a second or more: milliseconds were typed."""
