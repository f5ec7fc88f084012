"""The page on a scan: every move in its place, with its reason."""

from datetime import UTC, datetime
from types import SimpleNamespace

from shaftprint.report._service_page import render_service, strip_chart
from shaftprint.service import Scan


def segment(log, move_s, reason=""):
    return SimpleNamespace(log=log, reason=reason, move_s=move_s)


def made_up(refused=""):
    segments = (segment("a/1.nc", 660.0), segment("a/<b>.nc", 4200.0, "a channel is missing there"))
    names = ("log", "move_s", "swing_rpm", "from_rpm", "to_rpm", "state", "used", "reason")
    rows = tuple(dict.fromkeys(names, "0") | {"log": "<b>.nc", "reason": one.reason} for one in segments)
    return Scan(
        segments=segments,
        line=None,
        seconds={"ahead": 7200.0},
        left_out=(),
        found=(
            SimpleNamespace(what="clock of the lever beside the fingerprint", value=3.0, unit="ms", refused=refused),
        ),
        refused=refused,
        accuracy={},
        values={},
        rows=rows,
        facts={},
        spans_s={"a/1.nc": (0.0, 3600.0), "a/<b>.nc": (3600.0, 7200.0)},
    )


def test_moves_stand_at_their_minutes_in_the_row_of_their_log():
    (panel,) = strip_chart(made_up()).panels
    used, missing = panel.marks
    assert (used.x[0], used.y[0], used.name) == (11.0, 0.0, "used")
    assert (missing.x[0], missing.y[0], missing.name) == (10.0, 1.0, "a channel is missing there")


def test_the_page_says_what_was_seen_and_keeps_names_of_files_harmless(tmp_path):
    now = datetime(2026, 11, 28, tzinfo=UTC)
    page = render_service(tmp_path / "page", made_up(), vessel="Meander", now=now).read_text(encoding="utf-8")
    assert "1 useful move of the lever in 2 hours" in page
    assert "a channel is missing there" in page
    assert "&lt;b&gt;.nc" in page
    assert "<b>.nc" not in page
    refused = render_service(tmp_path / "no", made_up("it is 1 s late"), vessel="Meander", now=now)
    assert "nothing may be fitted to them: it is 1 s late" in refused.read_text(encoding="utf-8")
