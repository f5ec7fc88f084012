"""The wall: how every line stands, for a screen that nobody touches."""

from typing import Final

from shaftprint.web._asked import Asked, Shown
from shaftprint.web.pages._ships import content_of, headline_of, look_of, rows_of

MOST: Final = 60
"""Lines that a wall shows."""


async def kiosk(asked: Asked) -> Shown:
    """Return how every line stands, those first that need somebody."""
    return await asked.read(_kiosk, asked)


def _kiosk(asked: Asked) -> Shown:
    rows = rows_of(asked)
    return Shown(
        template="kiosk.html.j2",
        title="How the ships stand",
        data={
            "headline": headline_of(rows),
            "look": look_of(rows),
            "at": asked.service.now().isoformat(),
            "lines": [content_of(row) for row in rows[:MOST]],
            "more": max(0, len(rows) - MOST),
        },
    )
