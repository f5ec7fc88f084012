"""The report's section on the inertia by calculation."""

from types import SimpleNamespace

import pytest

from shaftprint.report.sections._inertia import inertia_section


@pytest.fixture(scope="module")
def section(fingerprint, vessel):
    (found,) = inertia_section(SimpleNamespace(fingerprint=fingerprint, vessel=vessel))
    return found


def rows(section, caption):
    table = next(table for table in section.tables if caption in table.title)
    return {str(row[0]): [str(cell) for cell in row[1:]] for row in table.rows}


def test_calculated_and_identified_stand_side_by_side(section, fingerprint):
    found = rows(section, "beside the identified")
    down = found["tau_dn"]
    # 2 pi 17.0 n_s0 / M_s0 at the 19.53 rev/s of the fixture's working point: 0.3166 s
    assert down[0].startswith("0.317 ±")
    identified = fingerprint.quantity("tau_dn")
    assert float(down[1].split(" ±")[0]) == pytest.approx(identified.value, abs=identified.std)
    assert abs(float(down[2].replace("−", "-"))) < 3.0
    assert found["I_up + I_p"][0].startswith("66.3 ±")


def test_budget_water_and_modes_follow(section):
    captions = [table.title for table in section.tables]
    assert len(captions) == 4
    assert rows(section, "Entrained water")["Schwanecke"][0].startswith("5.9 ±")
    assert rows(section, "Torsional modes")["1"][0] == "13.60 ± 0.96"
    (picture,) = section.pictures
    assert len(picture.chart().panels) == 4


def test_a_vessel_without_stiffness_has_no_modes(fingerprint, vessel):
    bare = vessel.model_copy(update={"links": ()})
    (found,) = inertia_section(SimpleNamespace(fingerprint=fingerprint, vessel=bare))
    assert found.pictures == []
    assert not any("modes" in table.title for table in found.tables)
