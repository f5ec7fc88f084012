"""Fingerprints of two ships of different design: no cause is looked for in what differs as built."""

import json

import pytest

# a sister of the demo's tug by name only: larger engine, other gear and propeller
OTHER = {
    "name": "Vega",
    "engine.rated_power_kw": 400.0,
    "gearbox.ratio": 4.5,
    "propeller.diameter_m": 0.9,
}


@pytest.fixture
def ship(demo, tmp_path):
    """Write the fingerprint of the short demo with other particulars in its vessel file."""

    def write(called="other", tested_at="2026-03-01T10:00:00+01:00", **fields):
        content = json.loads((demo[0] / "fingerprint.json").read_text(encoding="utf-8"))
        content["vessel_fields"] |= {key.replace("__", "."): value for key, value in fields.items()}
        content["conditions"] |= {"tested_at": tested_at, "vessel": content["vessel_fields"]["name"]}
        for source in content["sources"]:
            if source["role"] == "recording":
                source["sha256"] = f"{len(called):064x}"
        path = tmp_path / f"{called}.json"
        path.write_text(json.dumps(content), encoding="utf-8")
        return path

    return write


def test_of_two_designs_the_numbers_stand_side_by_side(run, demo, ship, tmp_path):
    result = run("compare", demo[0], ship(**OTHER), "-o", tmp_path / "out")
    assert result.exit_code == 3
    words = " ".join(result.output.split())
    assert words.startswith(
        "demo and other: these are not sister ships (rated power, gear ratio and propeller diameter"
    )
    # the Stan Tug 1205 has 221 kW, a reduction of 3.82 and a propeller of 1.05 m
    assert "rated power 221 and 400 kW, gear ratio 3.82 and 4.5 and propeller diameter 1.05 and 0.9 m" in words
    assert "has changed" not in words
    assert "Odds" not in words
    assert "Physical values" in result.output
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "These are not sister ships: what differs is their design" in page
    assert "What may have changed" not in page


@pytest.mark.parametrize(
    "fields",
    [
        # a sister, a sister whose propeller was cropped by a hundredth, a new engine, a renamed ship
        {"name": "Vega"},
        {"name": "Vega", "propeller.diameter_m": 1.04},
        {"engine.rated_power_kw": 400.0, "engine.rated_speed_rpm": 1900.0},
        {"name": "Vega", **{key: value for key, value in OTHER.items() if key != "name"}, "ship.imo_number": 9074729},
    ],
)
def test_sisters_and_rebuilt_ships_are_compared(run, ship, fields):
    first = ship("first", **({"ship.imo_number": 9074729} if "ship.imo_number" in fields else {}))
    result = run("compare", first, ship(**fields))
    assert result.exit_code == 0
    assert "not sister ships" not in " ".join(result.output.split())


def test_a_history_of_two_ships_is_none(run, ship):
    result = run("drift", ship("first", "2025-03-01T10:00:00+01:00"), ship(**OTHER))
    assert result.exit_code == 1
    assert "other: expected a test of Stan Tug 1205, port, as first is, found one of Vega: rated power 221 and" in (
        result.stderr
    )


def test_the_model_of_another_ship_is_told_by_the_ship(run, demo, ship):
    fields = ("--vessel", demo[0] / "vessel.toml", "--campaign", demo[0] / "campaign.toml")
    result = run("validate", demo[0] / "recording.nc", *fields, "--fingerprint", ship(**OTHER), "--no-progress")
    assert result.exit_code == 1
    assert "found one of Vega, another ship: rated power 400 and 221 kW" in result.stderr
    result = run(
        "plan", *fields[:2], "--after", ship(**OTHER), "--within", "5min", "--limit", "set-point=1V", "-o", "x"
    )
    assert "found one of Vega, another ship" in result.stderr
    result = run("inertia", demo[0] / "vessel.toml", "--fingerprint", ship(**OTHER))
    assert "found one of Vega, another ship" in result.stderr


def test_a_test_of_another_ship_in_a_line_of_the_store_is_said(run, ship, tmp_path):
    store = ("--store", f"sqlite:///{tmp_path}/store.db")
    assert run("store", "init", *store).exit_code == 0
    stated = (*store, "--ship", "A", "--line", "port")
    result = run("store", "add", ship("first", "2025-03-01T10:00:00+01:00"), *stated)
    assert "But it is of" not in result.output
    result = run("store", "add", ship("another", **OTHER), *stated)
    assert "But it is of Vega, and other tests of this line are of another ship" in " ".join(result.output.split())
