"""A look at a recording: its channels with rates and levels, and when the logger's clock says it began."""

from pathlib import Path
from typing import Any

from shaftprint.digits import rounded
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.recording._level_watch import watch_levels
from shaftprint.recording._read import read_recording
from shaftprint.tables._recording import level_table
from shaftprint.web.calculator._tables import table_content


def inspected(path: str) -> dict[str, Any]:
    """Return what is in a recording, for JSON.

    ``path``: the recording, in any format that is read.
    """
    with read_recording(Path(path)) as opened:
        channels = opened.channels.values()
        rows = tuple(
            (
                one.name,
                one.unit or "–",
                rounded(one.rate_hz),
                f"{rounded(one.start_s)} to {rounded(one.start_s + one.duration_s)}",
            )
            for one in channels
        )
        columns = (*texts("channel", "unit"), *numbers("rate [Hz]"), *texts("span [s]"))
        table = Table(title="Channels", columns=columns, rows=rows)
        levels = level_table(opened, watch_levels(opened).levels())
        return {
            "format": opened.format,
            "began": None if opened.began is None else opened.began.isoformat(),
            "duration_s": max((one.start_s + one.duration_s for one in channels), default=0.0),
            "tables": [table_content(table), table_content(levels)],
        }
