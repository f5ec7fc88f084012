"""Which errors two tests share by what their vessel files state, and how it is said."""

import pytest

from shaftprint.drift import shared_errors
from shaftprint.fingerprint import SourceFile, vessel_fields
from shaftprint.identify import Budget, BudgetRow, Prior
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences, vessel_file_table
from shaftprint.vessel import Vessel

STATED = ("TVC", "gauge scale", "telemetry latency", "prior of g")
OWN = ("noise of n", "gauge zero", "wander of the load")


def changed(vessel, change):
    content = vessel.model_dump()
    change(content)
    return Vessel.model_validate(content)


@pytest.fixture
def make(fingerprint):
    """A fingerprint of a vessel file, its sources of error those of a test without the rack."""

    def with_file(vessel, sha="ab", **update):
        return fingerprint.model_copy(
            update={
                "vessel_fields": vessel_fields(vessel),
                "sources": (SourceFile(role="vessel", name="tug.toml", sha256=32 * sha),),
                "priors": {"g": Prior(0.0, 0.1)},
                "budget": Budget(sources=(*OWN, *STATED), rows=()),
                **update,
            }
        )

    return with_file


def upstream(content):
    return next(row for row in content["inertia"] if row["gauge"] == "upstream")


def downstream(content):
    return next(row for row in content["inertia"] if row["gauge"] == "downstream")


@pytest.mark.parametrize(
    ("change", "apart"),
    [
        (lambda c: c["sensors"]["shaft_torque"].update(zero_nm=-8.5), ()),
        (lambda c: c.update(name="Stan Tug 1205, starboard"), ()),
        (lambda c: (upstream(c).update(name="renamed"), c.update(links=())), ()),
        (lambda c: downstream(c).update(inertia_kg_m2=9.0), ()),
        (lambda c: c["sensors"]["shaft_torque"].update(scale_nm_per_unit=401.0), ("gauge scale",)),
        (lambda c: c["sensors"]["shaft_torque"].update(latency_s=0.007), ("telemetry latency",)),
        (lambda c: upstream(c).update(inertia_kg_m2=99.0), ("TVC",)),
        (lambda c: c["gearbox"].update(ratio=4.0), ("TVC",)),
    ],
    ids=["zero", "name", "row renamed", "propeller", "scale", "latency", "flywheel", "gear"],
)
def test_only_what_is_stated_otherwise_is_not_shared(make, vessel, change, apart):
    """What rests on a field that both files state alike is common, whatever else the files say."""
    found = shared_errors(make(vessel), make(changed(vessel, change), sha="cd"))
    assert found.apart == apart
    assert set(found.common) == set(STATED) - set(apart)
    assert found.changes


def test_an_assumption_is_shared_where_it_is_the_same(make, vessel):
    other = make(vessel, sha="cd", priors={"g": Prior(-0.1, 0.05)})
    assert shared_errors(make(vessel), other).apart == ("prior of g",)


def test_the_same_file_shares_everything_and_an_unknown_one_nothing(make, vessel):
    plain = make(vessel)
    assert set(shared_errors(plain, plain).common) == set(STATED)
    old = plain.model_copy(update={"vessel_fields": {}})
    assert set(shared_errors(plain, old).common) == set(STATED)
    older = make(vessel, sha="cd", vessel_fields={})
    assert shared_errors(plain, older).common == ("prior of g",)
    assert shared_errors(plain, older).changes is None


def test_it_is_said_which_fields_differ_and_what_follows(make, vessel):
    def retaken(content):
        content["sensors"]["shaft_torque"] |= {"zero_nm": -8.5, "scale_nm_per_unit": 401.5}

    first, other = make(vessel), make(changed(vessel, retaken), sha="cd")
    gauge = vessel.sensors.shaft_torque
    assert vessel_file_sentences(first, other) == (
        f"The vessel files differ in sensors.shaft_torque.scale_nm_per_unit ({gauge.scale_nm_per_unit:g}, then 401.5); "
        f"sensors.shaft_torque.zero_nm ({gauge.zero_nm:g}, then -8.5).",
        "Stated alike for both tests, so that the error cancels: TVC; telemetry latency; prior of g.",
        "Not the same in both tests, so that the error counts in full: gauge scale.",
    )
    rows = vessel_file_table({"2025": first, "2026": other}).rows
    assert [row[0] for row in rows] == ["sensors.shaft_torque.scale_nm_per_unit", "sensors.shaft_torque.zero_nm"]
    assert rows[1][1:] == (f"{gauge.zero_nm:g}", "-8.5")
    assert vessel_file_sentences(first, first)[0] == "Both vessel files state the same."


def test_it_is_said_which_numbers_an_error_is_in(make, vessel):
    """Of I_dn 80 % of the variance is the gauge's scale, of t_d 1 %, which is nothing to speak of; of tau_up half of
    it in the second test alone."""
    first, other = (
        make(
            vessel,
            budget=Budget(
                sources=("noise of n", "gauge scale"),
                rows=tuple(
                    BudgetRow(
                        name=name, unit="-", value=1.0, variances={"noise of n": 1.0 - share, "gauge scale": share}
                    )
                    for name, share in {"I_dn": 0.8, "t_d": 0.01, "K_Q": 0.5, "tau_up": of_tau_up}.items()
                ),
            ),
        )
        for of_tau_up in (0.0, 0.5)
    )
    common = "Stated alike for both tests, so that the error cancels: gauge scale"
    assert vessel_file_sentences(first, first)[1] == f"{common} (in I_dn, K_Q)."
    assert vessel_file_sentences(first, other)[1] == f"{common} (in I_dn, K_Q, tau_up)."


def test_fields_are_found_by_their_path(vessel):
    fields = vessel_fields(vessel)
    row = vessel.inertia[0]
    assert fields["sensors.shaft_torque.scale_nm_per_unit"] == vessel.sensors.shaft_torque.scale_nm_per_unit
    assert fields[f"inertia.{row.name}.inertia_kg_m2"] == row.inertia_kg_m2
    assert fields["sensors.speed.n_e.pulses_per_revolution"] == 1.0
    assert "sensors.rack.channel" not in fields
