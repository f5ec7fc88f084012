"""The record: what is kept, and that it comes back from its file as it was."""

import json
from datetime import UTC, datetime, timedelta, timezone
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from shaftprint.campaign import TrialConditions
from shaftprint.catalogue import ShipRole
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.identify import Estimate, Prior, Settings, Unweighted
from shaftprint.vessel._ship import Ship

NOW = datetime(2026, 3, 14, 9, 30, tzinfo=UTC)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "fingerprint.json"


def written_and_read(fingerprint, path):
    write_fingerprint(fingerprint, path)
    return read_fingerprint(path)


def with_field(fingerprint, path, change):
    """Write a fingerprint whose JSON has been changed by hand."""
    content = json.loads(fingerprint.model_dump_json())
    change(content)
    path.write_text(json.dumps(content), encoding="utf-8")


def test_loads_back_equal(fingerprint, path):
    assert written_and_read(fingerprint, path) == fingerprint


def test_place_and_date_of_the_test_are_kept(fingerprint, path):
    conditions = written_and_read(fingerprint, path).conditions
    assert conditions.place == "Quay 12, Rotterdam"
    assert conditions.tested_at.isoformat() == "2026-03-13T14:05:00"


def test_ship_and_water_of_the_test_are_kept(gauge_fit, take, vessel, path):
    """``K_Q`` is made with the measured density: 1025/1000 times that with the density of the vessel file."""
    ship = Ship(name="Meander", imo_number=9074729, line="port", class_name="Stan Tug 1205")
    trial = TrialConditions(place="Dock", draught_m=1.8, water_temperature_c=4.0, water_density_kg_m3=1000.0)
    fresh = vessel.model_copy(update={"ship": ship, "water_density_kg_m3": 1000.0})
    kept = written_and_read(take(gauge_fit, vessel=fresh, trial_conditions=trial), path)
    conditions = kept.conditions
    assert conditions.ship.model_dump() == ship.model_dump()
    assert (conditions.place, conditions.draught_m, conditions.water_temperature_c) == ("Dock", 1.8, 4.0)
    assert (conditions.water_density_kg_m3, conditions.depth_m, conditions.trim_m) == (1000.0, None, None)
    sea = take(gauge_fit)
    assert kept.quantity("K_Q").value == pytest.approx(1.025 * sea.quantity("K_Q").value, rel=1e-12)
    assert sea.conditions.ship is None


def test_loads_back_equal_with_all_that_a_number_can_be(fingerprint, path):
    odd = Estimate(
        name="t_d",
        unit="s",
        value=1.0 / 3.0,
        std=np.inf,
        interval_95=(0.0, np.inf),
        interval_open=(True, True),
        at_bound=True,
        expected=-1e-300,
        expected_std=0.0,
        meaning='delay "t_d", 80 % in äußerst schwerer See',
    )
    unusual = fingerprint.model_copy(
        update={
            "parameters": (odd, odd),
            "covariance": ((np.inf, -1e-17), (-1e-17, 0.1 + 0.2)),
            "joint": None,
            "findings": (),
        }
    )
    assert written_and_read(unusual, path) == unusual


def without_roles(content):
    """Return the JSON of a version before roles."""
    if isinstance(content, dict):
        return {k: without_roles(v) for k, v in content.items() if k != "role" or "sha256" in content}
    return [without_roles(item) for item in content] if isinstance(content, list) else content


def test_an_earlier_file_gets_the_roles_of_its_structure(fingerprint, path):
    path.write_text(json.dumps(without_roles(json.loads(fingerprint.model_dump_json()))), encoding="utf-8")
    found = read_fingerprint(path)
    assert found.quantity("I_dn").role == ShipRole.INERTIA_DOWNSTREAM
    assert found.multiplied(found.quantity("I_dn")).role == ShipRole.INERTIA_DOWNSTREAM
    conditions = found.conditions
    assert found.model_copy(update={"conditions": fingerprint.conditions}) == fingerprint
    assert conditions.engine_speed.role is None


def test_an_earlier_file_of_an_own_structure_stays_without_roles(fingerprint, path):
    content = without_roles(json.loads(fingerprint.model_dump_json()))
    path.write_text(json.dumps(content | {"structure": "MINE"}), encoding="utf-8")
    assert all(number.role is None for number in read_fingerprint(path).physical)


def test_a_role_that_is_none_is_refused(fingerprint, path):
    with_field(fingerprint, path, lambda content: content["parameters"][0].update(role="tailor"))
    with pytest.raises(FingerprintError, match=r"parameters\.0: role: expected one of inertia downstream, .* 'tailor'"):
        read_fingerprint(path)


@pytest.mark.parametrize(
    ("value", "std", "interval", "is_stated"),
    [
        (1.222, 0.046, (1.151, 1.330), True),
        (2.000, 0.100, (1.804, 2.196), True),
        # the interval reaches to one side only: +/- would promise what the data exclude
        (7.1, 3.9, (4.9, 7.4), False),
        (0.122, 0.022, (0.057, 0.1234), False),
        (4.72, 0.42, (4.498, 6.229), False),
        # as long to both sides, and three times as wide or a third of it
        (2.000, 0.300, (1.804, 2.196), False),
        (2.000, 0.033, (1.804, 2.196), False),
    ],
)
def test_a_standard_deviation_is_shown_where_it_gives_the_interval(value, std, interval, is_stated):
    number = Estimate(name="K_p", unit="-", value=value, std=std, interval_95=interval)
    assert number.stated_std == (std if is_stated else None)


def test_every_fit_loads_back_equal(fit, take, path):
    """Held parameters, lines left out, no feedback, no profile of an unweighted fit."""
    core = fit("OL1", {"tau_n": 0.39}, settings=Settings(weighting=Unweighted(), starts=5), lines=["S1", "S5", "S9"])
    kept = written_and_read(take(core), path)
    assert kept == take(core)
    assert kept.held == {"k_q": 2.0}
    assert kept.margins == ()
    assert kept.parameters[0].interval_95 is None
    assert kept.quality.chi_square is None
    assert kept.quality.weighting == "Unweighted"


@pytest.mark.parametrize("zone", [timezone(timedelta(hours=-3, minutes=-30)), ZoneInfo("Europe/Amsterdam")])
def test_time_keeps_its_instant_and_offset(gauge_fit, take, path, zone):
    now = datetime(2026, 7, 1, 23, 59, 59, 123456, tzinfo=zone)
    kept = written_and_read(take(gauge_fit, now=now), path)
    assert kept.created == now
    assert kept.created.utcoffset() == now.utcoffset()


def test_time_without_zone_is_refused(gauge_fit, take):
    with pytest.raises(FingerprintError, match="now: expected a time with time zone"):
        take(gauge_fit, now=NOW.replace(tzinfo=None))


def test_keeps_what_is_needed_to_judge_it_in_ten_years(fingerprint):
    assert fingerprint.schema_version == "2.2"
    assert [(s.role, s.name, s.sha256[:2]) for s in fingerprint.sources] == [
        ("recording", "port.nc", "ab"),
        ("vessel", "tug.toml", "cd"),
        ("campaign", "test.toml", "ef"),
    ]
    where = fingerprint.conditions
    assert (where.vessel, where.campaign) == ("Stan Tug 1205, port", "Test around -5 V")
    assert where.engine_speed.value == pytest.approx(1183.8)
    assert where.engine_speed.std == pytest.approx(0.6)
    assert where.shaft_torque.value == 1725.0
    # 8 N m of the load, 2 % of the gauge's scale, 25 N m of its zero
    assert where.shaft_torque.std == pytest.approx((8.0**2 + 34.5**2 + 25.0**2) ** 0.5)
    assert (where.set_point_v, where.speed_channel, where.mode) == (-5.05, "n_e", "shaftprint")
    assert fingerprint.structure == "GAUGE-CLOSED"
    assert fingerprint.held == {"v": 1.0, "T_average": 0.0, "T_hold": 0.0, "t_pickup": 0.0, "T_filter": 0.0}
    assert fingerprint.priors == {"g": Prior(0.0, 0.1)}


def test_parameters_are_the_truth_within_their_intervals(fingerprint, truth):
    found = {quantity.name: quantity for quantity in fingerprint.parameters}
    assert {"K_p", "K_i", "t_d", "t_sp", "tau_dn", "tau_up", "g", "k_q", "omega_n", "zeta", "c_set"} <= set(found)
    for name, quantity in found.items():
        assert quantity.value == pytest.approx(truth[name], abs=1e-3)
        assert quantity.interval_95[0] <= truth[name] <= quantity.interval_95[1]
        assert quantity.std > 0.0
        assert quantity.meaning
    assert found["t_sp"].unit == "s"


def test_combinations_are_those_of_the_truth(fingerprint):
    found = {quantity.name: quantity.value for quantity in fingerprint.combinations}
    assert found["t_d + t_sp"] == pytest.approx(0.1221, abs=1e-5)
    assert found["K_p / K_i"] == pytest.approx(5.7 / 4.27, rel=1e-4)
    assert found["v K_i / (k_q - g)"] == pytest.approx(4.27 / 2.0, rel=1e-3)
    assert found["v K_p / (tau_up + tau_dn)"] == pytest.approx(5.7 / 1.336, rel=1e-3)


def test_covariance_is_that_of_the_parameters(fingerprint):
    covariance = np.array(fingerprint.covariance)
    std = [quantity.std for quantity in fingerprint.parameters]
    assert np.sqrt(np.diag(covariance)) == pytest.approx(std)
    names = [quantity.name for quantity in fingerprint.parameters]
    both = [names.index("t_d"), names.index("t_sp")]
    total = np.sqrt(covariance[np.ix_(both, both)].sum())
    assert total == pytest.approx(fingerprint.quantity("t_d + t_sp").std, rel=1e-6)


def test_keeps_how_good_the_data_were(fingerprint):
    quality = fingerprint.quality
    assert quality.chi_square == pytest.approx(0.0, abs=1e-6)
    # 14 lines of two complex values and one prior
    assert quality.degrees_of_freedom == 14 * 4 + 1 - len(fingerprint.parameters)
    assert quality.weighting == "MaximumLikelihood"
    assert quality.fit_percent == pytest.approx({"n": 100.0, "M_s": 100.0}, abs=1e-3)
    assert quality.snr_overall == {"n_set": 0.999, "n_e": 0.94, "M_s": 0.57}
    assert quality.snr_local_db["M_s"]["S2"] == 5.0
    assert quality.repairs == {"M_s: outlier": 2, "PTM_e: missing pulse": 1}
    assert quality.remarks == ("channel M_s reaches full scale from 12.0 s on: 3 samples are cut off there",)
    assert 1 <= quality.starts_at_optimum <= quality.starts == 20


def test_keeps_the_history_of_the_sensors(fingerprint):
    found = {quantity.name: quantity for quantity in fingerprint.calibration}
    slope, intercept, scale = (found[f"set-point {name}"] for name in ("slope", "intercept", "scale"))
    assert (slope.value, slope.std, slope.unit) == (pytest.approx(-252.0), pytest.approx(0.6), "rpm/V")
    assert (intercept.value, intercept.std) == (pytest.approx(-84.0), pytest.approx(3.0))
    assert (scale.value, scale.std) == (1.004, 0.001)
    assert [found[f"PTM_4 strip {n}"].value for n in (1, 2, 3, 4)] == [90.0] * 4
    assert found["PTM_4 strip 4"].std == pytest.approx(0.036)


def test_line_that_is_fitted_in_spite_of_a_remark_keeps_it(fit, take):
    remarks = {"S13": "aliased", "S14": "aliased too"}
    core = fit("OL1", {"tau_n": 0.39}, remarks=remarks, lines=["S1", "S5", "S13"])
    kept = take(core)
    assert kept.quality.remarks[1:] == ("Line S13 is fitted, but: aliased.",)
    assert kept.conditions.lines_used == ("S1", "S5", "S13")
    assert kept.conditions.lines_left_out["S14"] == "aliased too"
    assert kept.conditions.lines_left_out["S2"] == "not chosen"


def test_quantity_is_found_by_name_wherever_it_stands(fingerprint):
    for name in ("K_p", "t_d + t_sp", "I_dn", "gain margin", "set-point scale"):
        assert fingerprint.quantity(name).name == name
    with pytest.raises(FingerprintError, match=r"has no 'K_P'. Did you mean K_p\? It has .*K_p, .*I_dn"):
        fingerprint.quantity("K_P")


def test_a_fingerprint_is_read_like_a_table_of_its_numbers(fingerprint):
    """Every name of its table is an item, those of the working point too; a wrong one is a KeyError in plain words."""
    for name in (*fingerprint.to_pandas().index, "n_0", "M_s0"):
        assert fingerprint[name].name == name
        assert name in fingerprint
        assert name in fingerprint._ipython_key_completions_()
    assert fingerprint["n_0"].value == fingerprint.conditions.engine_speed.value
    with pytest.raises(KeyError) as raised:
        fingerprint["gain_margin"]
    assert str(raised.value).startswith("the fingerprint has no 'gain_margin'. Did you mean gain margin?")
    with pytest.raises(KeyError, match="held at"):
        fingerprint[next(iter(fingerprint.held))]
    with pytest.raises(AttributeError, match=r"its numbers are items: fingerprint\['K_p'\]"):
        _ = fingerprint.K_p


def test_a_number_says_its_value_its_interval_and_why_it_is_not_to_be_used(fingerprint):
    doubted = next(iter(fingerprint.verdict.not_trusted))
    assert fingerprint.verdict.not_trusted[doubted] in str(fingerprint[doubted])
    assert not fingerprint[doubted].trusted
    inertia = fingerprint["I_dn"]
    words = str(inertia).split()
    assert words[:2] == ["I_dn", "value"]
    assert float(words[2]) == pytest.approx(inertia.value, rel=2e-3)
    assert "kg m2" in str(inertia)


def test_prior_is_kept_in_its_own_unit(fit, take, truth):
    settings = Settings(starts=20, priors={"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.03)})
    assert take(fit("GAUGE-CLOSED", truth, settings=settings)).priors["tau_up"].std == 0.03


def test_file_that_is_missing(tmp_path):
    with pytest.raises(
        FingerprintError, match=r"none\.json: expected a fingerprint in JSON, found nothing there; name the file"
    ):
        read_fingerprint(tmp_path / "none.json")
    (tmp_path / "result").mkdir()
    with pytest.raises(FingerprintError, match=r"has put it\. Did you mean result\?$"):
        read_fingerprint(tmp_path / "reslt")
    # a folder that is there is not proposed in place of itself
    with pytest.raises(FingerprintError, match=r"has put it\.$"):
        read_fingerprint(tmp_path / "result")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\x89HDF\r\n\x1a\n\x00\xff", "expected a fingerprint in JSON, found something else"),
        (b"time;n_e\n0,0;1183,8\n", "expected a fingerprint in JSON, found something else"),
        (b"", "expected a fingerprint in JSON, found something else"),
        (b"[1, 2]", "expected a fingerprint, found JSON without a schema_version"),
        (b'{"schema": 1, "vessel": "tug"}', "expected a fingerprint, found JSON without a schema_version"),
        (b'{"schema_version": 3, "hull": {}}', "expected a fingerprint of schema 1 or 2, found schema 3; read it with"),
        (b'{"schema_version": "3.1"}', "expected a fingerprint of schema 1 or 2, found schema 3.1"),
        (b'{"schema_version": "2.99999999"}', "expected a fingerprint of schema 1 or 2, found schema 2.9"),
        (b'{"schema_version": "one"}', "expected a fingerprint of schema 1 or 2, found schema one"),
        (b'{"schema_version": true}', "expected a fingerprint of schema 1 or 2, found schema True"),
        (b'{"schema_version": [1]}', "expected a fingerprint of schema 1 or 2"),
    ],
)
def test_foreign_file(path, content, message):
    path.write_bytes(content)
    with pytest.raises(FingerprintError, match=message):
        read_fingerprint(path)


def test_cut_file(fingerprint, path):
    write_fingerprint(fingerprint, path)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(FingerprintError, match="found something else"):
        read_fingerprint(path)


def test_unknown_fields_are_refused_with_their_place(fingerprint, path):
    with_field(fingerprint, path, lambda c: c.update(colour="red"))
    with pytest.raises(FingerprintError, match=r"not a fingerprint of schema 2.2: colour: Extra inputs"):
        read_fingerprint(path)
    with_field(fingerprint, path, lambda c: c["conditions"].update(tide_m=1.2))
    with pytest.raises(FingerprintError, match=r"conditions\.tide_m: Extra inputs"):
        read_fingerprint(path)


def test_all_wrong_fields_are_listed(fingerprint, path):
    def spoil(content):
        content["conditions"]["mode"] = "martinus"
        content["parameters"][1]["value"] = "much"
        content["created"] = "2026-03-14T09:30:00"
        del content["sources"]

    with_field(fingerprint, path, spoil)
    with pytest.raises(FingerprintError) as caught:
        read_fingerprint(path)
    for place in ("conditions.mode: ", "parameters.1.value: ", "created: ", "sources: Field required"):
        assert place in str(caught.value)


def test_is_written_whole_or_not_at_all(fingerprint, path, tmp_path):
    write_fingerprint(fingerprint, path)
    write_fingerprint(fingerprint, path)
    assert [place.name for place in tmp_path.iterdir()] == ["fingerprint.json"]
    with pytest.raises(FingerprintError, match=r"nowhere.*the fingerprint cannot be written"):
        write_fingerprint(fingerprint, tmp_path / "nowhere" / "fingerprint.json")


def test_is_readable_by_anything_that_reads_json(fingerprint, path):
    write_fingerprint(fingerprint.model_copy(update={"covariance": ((np.inf,),)}), path)
    content = json.loads(path.read_text(encoding="utf-8"), parse_constant=pytest.fail)
    assert content["covariance"] == [["Infinity"]]
    assert content["created"] == "2026-03-14T09:30:00Z"


def test_a_fingerprint_is_read_from_the_folder_of_its_results(fingerprint, tmp_path):
    write_fingerprint(fingerprint, tmp_path / "fingerprint.json")
    assert read_fingerprint(tmp_path) == read_fingerprint(tmp_path / "fingerprint.json")
    (tmp_path / "empty").mkdir()
    with pytest.raises(FingerprintError, match=r"fingerprint\.json"):
        read_fingerprint(tmp_path / "empty")
