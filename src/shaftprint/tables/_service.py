"""The table of a scan of service: what was asked of the whole log."""

import math
from typing import TYPE_CHECKING

from shaftprint.plain_table import Table, numbers, texts

if TYPE_CHECKING:
    from shaftprint.service._scan import Scan


def asked_table(found: "Scan") -> Table:
    """Return what was asked of the whole log, what was found, and whether it is refused for that."""
    return Table(
        title="Asked of the whole log",
        columns=(*texts("what"), *numbers("found"), *texts("unit", "verdict")),
        rows=tuple(
            (
                one.what,
                "–" if math.isnan(one.value) else f"{one.value:.2g}",
                one.unit,
                "refused" if one.refused else "nothing to tell by" if math.isnan(one.value) else "good",
            )
            for one in found.found
        ),
    )
