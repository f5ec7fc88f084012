"""``shaftprint drift`` on copies of the fingerprint of the short demo, made in other years."""

import json

import pytest

ACTION = "governor proportional action"


@pytest.fixture
def years(demo, tmp_path):
    """Write a test of each spring; from a year on the proportional gain of the governor is a fifth lower."""

    def write(*, count=5, lower_from=3, **conditions):
        paths = []
        for year in range(count):
            content = json.loads((demo[0] / "fingerprint.json").read_text(encoding="utf-8"))
            content["conditions"] |= {"tested_at": f"{2021 + year}-03-01T10:00:00+01:00"} | conditions
            for source in content["sources"]:
                if source["role"] == "recording":
                    source["sha256"] = f"{year:064x}"
            for number in content["physical"]:
                if number["name"] == ACTION and year >= lower_from:
                    number["value"] *= 0.8
            path = tmp_path / f"spring-{2021 + year}.json"
            path.write_text(json.dumps(content), encoding="utf-8")
            paths.append(path)
        return paths

    return write


def test_what_has_changed_is_said_first_with_its_date(run, years, tmp_path):
    result = run("drift", *reversed(years()), "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    printed = " ".join(result.output.split())
    assert printed.startswith("Has the ship changed? Yes: a lower proportional gain of the governor, by 20.0")
    assert "between 2023-03-01 and 2024-03-01." in printed
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "The ship has changed by more than chance" in page
    # what was seen, with what to do; other explanations are folded
    assert "Changed: proportional gain of the governor" in page
    assert "Read the gains in the control unit." in page
    assert page.index("What has changed") < page.index("Other explanations, each instead of what was seen")


def test_an_unchanged_line_and_a_line_whose_governor_was_exchanged_have_no_drift(run, years):
    assert (
        "No change beyond chance in 5 tests from 2021-03-01 to 2025-03-01." in run("drift", *years(lower_from=9)).output
    )
    changed = years()
    event = ("--event", "governor-changed=2023-09-01", "--time-zone", "Europe/Amsterdam")
    result = run("drift", *changed, *event)
    assert result.output.startswith("Has the ship changed? No change but what was noted")
    assert "governor" in result.output.partition("2023-09-01")[2].splitlines()[0]


def test_the_exit_code_says_what_was_found_where_it_is_asked_for(run, years):
    assert run("drift", *years()).exit_code == 0
    changed = run("drift", *years(), "--exit-code", "--json")
    assert changed.exit_code == 4
    assert json.loads(changed.stdout)["answer"][0].startswith("Has the ship changed? Yes")
    assert run("drift", *years(lower_from=9), "--exit-code").exit_code == 0


def test_a_step_goes_on_to_no_limit(run, years):
    printed = " ".join(run("drift", *years(), "--limit", "proportional=30%", "--limit", "delay=20ms").output.split())
    assert "proportional gain of the governor, 30 %: no ramp of it is seen" in printed
    assert "delay of governor and fuel, 20 ms: no ramp of it is seen" in printed


def test_the_document_holds_the_course_with_all_digits(run, years):
    document = json.loads(run("drift", *years(), "--json").output)
    best = document["result"]["finding"]["drifts"][0]["courses"][0]
    assert best["shape"] == "step"
    assert best["since"] == 3
    assert best["size"] == pytest.approx(-0.2, rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--event", "paint=2023-01-01"), "expected KIND=DATE with one of docking"),
        (("--limit", "paint=10%"), "expected the beginning of one of injection or turbocharger"),
        (("--limit", "propeller=ten"), "expected a number of % after propeller="),
        (("--event", "docking=yesterday"), "'yesterday' does not match the formats"),
        (("--event", "docking=2023-01-01", "--time-zone", "Mars/Olympus"), "expected UTC, an offset such as +02:00"),
        (("--event", "docking=2023-03-26T02:30", "--time-zone", "Europe/Amsterdam"), "show 2023-03-26 02:30:00 never"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(run, years, arguments, message):
    result = run("drift", *years(), *arguments)
    assert result.exit_code == 2
    assert message in " ".join(result.stderr.split())


def test_a_test_without_its_time_is_refused_with_what_to_do(run, years):
    result = run("drift", *years(tested_at=None))
    assert result.exit_code == 1
    assert "expected when the test was made, with time zone, found nothing; make it again with --tested-at" in " ".join(
        result.stderr.split()
    )


def test_one_fingerprint_is_no_history(run, years):
    result = run("drift", years()[0])
    assert result.exit_code == 2
    assert "expected two or more fingerprints, found 1" in result.stderr


def test_a_ship_of_the_store_is_watched_with_what_was_noted_as_done_to_it(run, years, tmp_path):
    pytest.importorskip("sqlalchemy", reason="the store is an extra")
    store = ("--store", tmp_path / "yard.db")
    assert run("store", "init", *store).exit_code == 0
    assert run("store", "add", *years(), "--ship", "Meander", "--line", "port", *store).exit_code == 0
    found = run("drift", "Meander", *store)
    assert "Yes: a lower proportional gain of the governor, by 20.0" in " ".join(found.output.split())
    exchanged = ("governor-changed", "--at", "2023-09-01T08:00+02:00")
    assert run("store", "event", "Meander", *exchanged, *store).exit_code == 0
    assert run("drift", "Meander", *store).output.startswith("Has the ship changed? No change but what was noted")
    missing = run("drift", "Maas", *store)
    assert missing.exit_code == 1
    assert "expected the name or IMO number of a ship in the store, found none" in missing.stderr
