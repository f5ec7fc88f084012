"""A recording before its fit: its signals, windows and repairs; and the campaign that somebody makes of it by eye."""

import json
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from pydantic import ValidationError

from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.campaign._chosen import Choice, Offered, chosen, kind_of_test, shortest_s, window_of
from shaftprint.campaign._excitations import Chirp, Staircase
from shaftprint.campaign._file_text import TESTS, campaign_text
from shaftprint.errors import ServerError, ShaftprintError, SignalError
from shaftprint.recording._read import read_recording
from shaftprint.records import faults
from shaftprint.signals._channel_readings import read_channels
from shaftprint.signals._describe_recording import describe_set_point
from shaftprint.signals._prepare import find_tests, prepare_signals
from shaftprint.signals._readings import Readings, usable_readings
from shaftprint.signals.kinds._speed_reading import SpeedReading
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import load_vessel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shaftprint.arrays import FloatArray
    from shaftprint.campaign._excitation import Excitation
    from shaftprint.recording._recording import Recording
    from shaftprint.signals.excitation._found_test import FoundTest
    from shaftprint.vessel._vessel import Vessel

COLUMNS: Final = 1600
"""Stretches of a signal of which the page draws the lowest and the highest value."""
MOST_REPAIRS: Final = 200
MOST_FINDINGS: Final = 20
_SAME_MIDDLE_V: Final = 0.05
# So far two tests may lie over each other by the errors of their times [s].
_SAME_TIME_S: Final = 0.5


def windows(path: str, vessel: str, campaign: str | None) -> dict[str, Any]:
    """Return a recording with its tests, for JSON.

    ``path``: the recording. ``vessel``, ``campaign``: paths, or names of files that come with the program; without a
    campaign its tests are those that the set point shows. Raises ShaftprintError if nothing of it can be drawn.
    """
    ship = load_vessel(_file(vessel))
    with read_recording(Path(path)) as opened:
        planned = None if campaign is None else load_campaign(_file(campaign))
        channels = read_channels(opened, ship)
        readings = usable_readings(channels)
        seen, unseen = _seen(opened, ship)
        if planned is None and seen is None:
            raise SignalError(unseen)
        tests = () if planned is None else find_tests(opened, ship, planned, readings=channels)
        found = {one.planned.name: one for one in tests}
        there = [(one.begin_s, one.planned.stop_s + one.later_s) for one in tests if one.is_found]
        asked, more = _with_more(planned, seen, there)
        refusal = ""
        findings: tuple[str, ...] = ()
        try:
            findings = prepare_signals(opened, ship, planned or asked, readings=channels).findings
        except ShaftprintError as error:
            refusal = str(error)
    repairs = readings.repairs
    return {
        "campaign": asked.model_dump(mode="json"),
        "more": more,
        "tests": [_test(one, found.get(one.name), readings, is_used=one.name not in more) for one in _moving(asked)],
        "strips": _strips(readings),
        "start_s": readings.clock.start_s,
        "stop_s": readings.clock.start_s + readings.clock.count / readings.clock.rate_hz,
        "repairs": [
            {"channel": one.channel, "kind": one.kind, "time_s": one.time_s, "count": one.count}
            for one in repairs[:MOST_REPAIRS]
        ],
        "repaired": len(repairs),
        "gaps": [
            {"channel": one.channel, "reason": one.reason, "start_s": one.first_s, "stop_s": one.last_s}
            for one in readings.gaps[:MOST_REPAIRS]
        ],
        "lost": len(readings.gaps),
        "refusal": refusal,
        "findings": list(findings[:MOST_FINDINGS]),
        "found": len(findings),
    }


def chosen_campaign(campaign: dict[str, Any], choices: dict[str, dict[str, Any]], remarks: str) -> dict[str, Any]:
    """Return the campaign that somebody has chosen by eye, as the text of its file.

    ``campaign``: as `windows` gave it. ``choices``: fields of a ``Choice`` by the name of each test. ``remarks``: what
    the head of the file says. Raises ServerError if what is chosen is no campaign; the sentence says why.
    """
    try:
        made = chosen(
            Offered.model_validate_json(json.dumps(campaign)), {name: Choice(**one) for name, one in choices.items()}
        )
    except ValidationError as error:
        raise ServerError(f"These windows make no campaign: {faults(error)}") from None
    return {"text": campaign_text(made, remarks=remarks), "tests": [one.name for one in _moving(made)]}


def _file(text: str) -> str | Path:
    # a path begins a file, a name one of those that come with the program
    return Path(text) if "/" in text or "\\" in text else text


def _moving(campaign: Campaign) -> "list[Excitation]":
    """Return what somebody chooses of: every test but those that go with a leg."""
    beside = {one.name for leg in campaign.legs for one in campaign.beside(leg)}
    return [one for one in campaign.excitations if one.name not in beside]


def _seen(opened: "Recording", ship: "Vessel") -> tuple[Campaign | None, str]:
    """Return the campaign that the set point shows, or why it shows none."""
    try:
        return describe_set_point(opened, ship).campaign, ""
    except ShaftprintError as error:
        return None, str(error)


def _with_more(
    planned: Campaign | None, seen: Campaign | None, there: "Sequence[tuple[float, float]]"
) -> tuple[Campaign, list[str]]:
    """Return a campaign with the tests that the set point shows beside those that were found, and the names of these.

    ``there``: from when to when those were found [s]. None of the others is in the result of itself: who looks at the
    page takes it in.
    """
    if planned is None:
        assert seen is not None  # noqa: S101
        return seen, []
    if seen is None or abs(seen.offset_v - planned.offset_v) > _SAME_MIDDLE_V:
        return planned, []
    names = {one.name for one in planned.excitations}
    tests, more = {section: list(getattr(planned, section)) for section in TESTS}, []
    for section in TESTS:
        for one in getattr(seen, section):
            if any(
                one.start_s < end_s - _SAME_TIME_S and begin_s < one.stop_s - _SAME_TIME_S for begin_s, end_s in there
            ):
                continue
            name = next(text for at in count(1) if (text := f"seen {at}") not in names)
            names.add(name)
            more.append(name)
            tests[section].append(one.model_copy(update={"name": name}))
    ramps = {"ramp_s": planned.ramp_s, "ramp_v_per_s": planned.ramp_v_per_s}
    if not any(ramps.values()):
        ramps = {"ramp_s": seen.ramp_s, "ramp_v_per_s": seen.ramp_v_per_s}
    # not checked as a whole: what is taken in is checked with the rest when it is chosen
    return planned.model_copy(update={name: tuple(every) for name, every in tests.items()} | ramps), more


def _test(one: "Excitation", found: "FoundTest | None", readings: Readings, *, is_used: bool) -> dict[str, Any]:
    begin_s, end_s = window_of(one)
    later_s = None if found is None or not found.is_found else found.later_s
    return {
        "name": one.name,
        "words": kind_of_test(one),
        "used": is_used,
        "has_window": not isinstance(one, Chirp | Staircase),
        "start_s": one.start_s,
        "settled_s": begin_s,
        "stop_s": one.stop_s,
        "window_stop_s": end_s,
        "shortest_s": shortest_s(one),
        "missing": readings.coverage.missing(begin_s, end_s),
        "later_s": later_s,
        "differences": [] if found is None else list(found.differences),
    }


def _strips(readings: Readings) -> list[dict[str, Any]]:
    """Return what is drawn: the set point, the speed that is identified, the torque."""
    strips = [("set point", "V", readings.set_point)]
    speed = next((one for one in readings.by_name.values() if isinstance(one, SpeedReading)), None)
    if speed is not None:
        strips.append(("engine speed", "rpm", rpm_from_rev_s(speed.values)))
    if "M_s" in readings.by_name:
        strips.append(("shaft torque", "kN m", readings.torque_nm / 1000.0))
    return [
        {"name": name, "unit": unit, **_envelope(values)}
        for name, unit, values in strips
        if values.shape == (readings.clock.count,)
    ]


def _envelope(values: "FloatArray") -> dict[str, list[float]]:
    """Return the lowest and the highest value of each of many stretches."""
    edges = np.linspace(0, values.size, min(COLUMNS, values.size) + 1).astype(np.int64)[:-1]
    low, high = np.fmin.reduceat(values, edges), np.fmax.reduceat(values, edges)
    return {"low": _plain(low), "high": _plain(high)}


def _plain(values: "FloatArray") -> list[float]:
    return [float(f"{one:.5g}") for one in np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0).tolist()]
