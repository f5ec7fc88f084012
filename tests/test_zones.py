"""Zones by their names; the offsets are those of the calendar, typed from it."""

from datetime import UTC, datetime, timedelta

import pytest

from shaftprint.zones import in_zone, possible, time_zone, utc_text

SHOWN = datetime(2026, 3, 13, 14, 5)  # noqa: DTZ001


@pytest.mark.parametrize(
    ("name", "hours"),
    [("UTC", 0.0), ("z", 0.0), ("+02:00", 2.0), ("-0330", -3.5), ("Europe/Amsterdam", 1.0), ("Asia/Kolkata", 5.5)],
)
def test_the_offset_of_a_zone_in_march(name, hours):
    moment = in_zone(SHOWN, time_zone(name))
    assert moment.utcoffset() == timedelta(hours=hours)
    assert moment == datetime(2026, 3, 13, 14, 5, tzinfo=UTC) - timedelta(hours=hours)


@pytest.mark.parametrize("name", ["", "Mars/Phobos", "../../etc/passwd", "/etc/localtime", "+25:00", "Europe", "a\0b"])
def test_a_name_of_no_zone_is_refused(name):
    with pytest.raises(ValueError, match=r"expected UTC, an offset such as \+02:00, or a name"):
        time_zone(name)


@pytest.mark.parametrize(("shown", "often"), [("2026-10-25 02:30:00", "twice"), ("2026-03-29 02:30:00", "never")])
def test_an_hour_that_a_clock_shows_twice_or_never_is_not_guessed(shown, often):
    with pytest.raises(ValueError, match=f"clocks of Europe/Amsterdam show {shown} {often}"):
        in_zone(datetime.fromisoformat(shown), time_zone("Europe/Amsterdam"))
    assert in_zone(datetime.fromisoformat(shown), time_zone("+01:00")).hour == 2


def test_an_instant_is_printed_in_the_zone_asked_for():
    moment = datetime(2026, 7, 1, 22, 30, tzinfo=UTC)
    assert utc_text(moment) == "2026-07-01 22:30 +00:00"
    assert utc_text(moment, time_zone("Europe/Amsterdam")) == "2026-07-02 00:30 +02:00"
    assert utc_text(moment, time_zone("America/St_Johns")) == "2026-07-01 20:00 -02:30"


NOW = datetime(3000, 6, 1, 12, tzinfo=UTC)


@pytest.mark.parametrize(
    "text",
    [
        "1950-01-01T00:00+00:00",
        "1950-01-01T09:00+09:00",
        "3000-06-02T12:00+00:00",
        "3000-06-02T12:00",
        # a clock ahead by 14 hours shows tomorrow
        "3000-06-03T02:00+14:00",
    ],
)
def test_since_1950_and_until_tomorrow_something_can_have_been_done(text):
    assert possible(datetime.fromisoformat(text), now=NOW) == datetime.fromisoformat(text)


@pytest.mark.parametrize(
    "text",
    [
        "0001-01-01T00:00+14:00",
        "0001-01-01T00:00-14:00",
        "1949-12-31T23:59+00:00",
        "1950-01-01T08:59+09:00",
        "3000-06-02T12:01+00:00",
        "9999-12-31T23:59-14:00",
        "9999-12-31T23:59+14:00",
        "9999-12-31T23:59",
    ],
)
def test_outside_of_it_a_time_is_refused_in_one_sentence(text):
    with pytest.raises(ValueError, match="expected a time from 1950-01-01 to 3000-06-02, found"):
        possible(datetime.fromisoformat(text), now=NOW)


@pytest.mark.parametrize("zone", ["+14:00", "-12:00", "Pacific/Kiritimati", "UTC"])
def test_the_ends_of_the_calendar_are_shown_in_every_zone(zone):
    last = datetime(9999, 12, 31, 23, 59, tzinfo=UTC)
    assert utc_text(last, time_zone(zone))[:10] == "9999-12-31"
    assert utc_text(datetime(1, 1, 1, tzinfo=UTC), time_zone(zone)).endswith("00:00") or zone != "-12:00"
