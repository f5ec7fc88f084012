"""What is asked for once is done once: the key of a job is that of all that its fingerprint depends on."""

from datetime import UTC, datetime, timedelta
from importlib.resources import files

import pytest

from shaftprint.errors import RecordingError, SettingsError, StructureError
from shaftprint.fleet import submit
from shaftprint.fleet._arguments import job_arguments
from shaftprint.store import job_counts

LATER = datetime.now(UTC) + timedelta(hours=1)
VESSEL = (files("shaftprint.vessel") / "shipped" / "stan_tug_1205.toml").read_text(encoding="utf-8")


@pytest.fixture
def asked(store, tmp_path):
    """Ask for one recording, and return its job."""
    (tmp_path / "a.nc").write_bytes(b"a recording")

    def ask(*, recording="a.nc", vessel="stan-tug-1205", campaign="short", **facts):
        arguments = job_arguments(tmp_path / recording, vessel, campaign, named="test", **facts)
        (job,) = submit(store, [arguments], now=LATER)
        return job

    return ask


def test_the_same_is_asked_for_once(asked, tmp_path):
    first = asked(ship="Meander")
    (tmp_path / "copy of a.nc").write_bytes(b"a recording")
    # a copy is the same recording
    assert {asked(ship="Meander").id, asked(recording="copy of a.nc", ship="Meander").id} == {first.id}


def test_another_file_or_setting_is_another_job(asked, tmp_path):
    mine = tmp_path / "mine.toml"
    mine.write_text(VESSEL, encoding="utf-8")
    (tmp_path / "b.nc").write_bytes(b"another recording")
    ids = [
        asked().id,
        asked(recording="b.nc").id,
        asked(campaign="5min").id,
        asked(structure="GAUGE-OPEN").id,
        asked(seed=2).id,
        asked(starts=10).id,
        asked(line="port").id,
        asked(draught_m=1.8).id,
        asked(tested_at="2026-03-31T09:30+02:00").id,
    ]
    # the same content in a file of one's own is the same vessel
    assert asked(vessel=mine).id == ids[0]
    mine.write_text(VESSEL + "\n# another line\n", encoding="utf-8")
    ids.append(asked(vessel=mine).id)
    (tmp_path / "a.nc").write_bytes(b"a longer recording")
    ids.append(asked().id)
    assert len(set(ids)) == len(ids)


@pytest.mark.parametrize(
    ("facts", "error", "words"),
    [
        ({"vessel": "no-such-ship"}, SettingsError, "no-such-ship"),
        ({"campaign": "no-such-campaign"}, SettingsError, "no-such-campaign"),
        ({"structure": "NOPE"}, StructureError, "there is no structure 'NOPE'"),
        ({"structure": "mine.py:line"}, StructureError, "there is no structure"),
        ({"recording": "gone.nc"}, RecordingError, r"gone\.nc: expected a recording"),
    ],
)
def test_what_cannot_be_done_is_refused_before_anything_is_asked_for(asked, store, facts, error, words):
    with pytest.raises(error, match=words):
        asked(**facts)
    assert job_counts(store).all == 0
