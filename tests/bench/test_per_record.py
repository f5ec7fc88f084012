"""Parameters that have a value of their own in each record, or in each group of records."""

from functools import partial

import numpy as np
import pytest
from tests.bench.drawn_lags import LAG_TOML, identified, lag, levels, written
from tests.known_fits import NOW

from shaftprint.bench import equipped, read_records
from shaftprint.bench._fingerprint import drive_fingerprint, identified_drive
from shaftprint.bench._per_record import with_structures
from shaftprint.bench._predict import predict_drive, predicted_at
from shaftprint.bench._validate import validate_drive
from shaftprint.drive import load_drive
from shaftprint.errors import FingerprintError, SettingsError, StructureError
from shaftprint.identify import Prior

INTERVAL = 0.05
TIMES_S = {"brass": 0.2, "steel_1": 0.5, "steel_2": 0.5, "known": 0.35}
OWN = """inputs_hold = true

[[per_record]]
name = "T"
values = { known = 0.35, lost = 1.0 }
groups = { steel = ["steel_1", "steel_2"] }
"""


def lag_of(time_s, rng, samples=240):
    """Return columns of a lag with a gain of 100 and some time constant."""
    inputs = levels(rng, samples, 16)
    output = lag(inputs, INTERVAL, hold=True, time_s=time_s) + 0.5 * rng.standard_normal(samples)
    return {"u": inputs, "y": output}


@pytest.mark.slow
def test_what_differs_from_record_to_record_is_found_in_each(tmp_path):
    rng = np.random.default_rng(3)
    paths = [written(tmp_path, name, lag_of(time_s, rng), INTERVAL) for name, time_s in TIMES_S.items()]
    found = identified(tmp_path, *paths, text=LAG_TOML + OWN)
    values = {one.name: one for one in found.identification.parameters}
    assert set(values) == {"K", "T(brass)", "T(steel)"}
    for name, true in (("K", 100.0), ("T(brass)", 0.2), ("T(steel)", 0.5)):
        assert abs(values[name].value - true) < 4.0 * values[name].std < 0.05 * true
        lower, upper = found.intervals[name].lower, found.intervals[name].upper
        assert lower < values[name].value < upper
    assert found.verdict.trustworthy
    assert any("T names lost, of which no record" in sentence for sentence in found.verdict.sentences)

    kept = drive_fingerprint(found, sources=(), now=NOW)
    assert kept.held == {"T(known)": 0.35}
    # a record of another lag: its own time constant is found with it, the gain is not
    other = written(tmp_path, "other", lag_of(1.1, rng), INTERVAL)
    weaker = lag_of(0.2, rng)
    brass = written(tmp_path, "brass", weaker | {"y": 0.7 * weaker["y"]}, INTERVAL)
    one = found.equipped
    passed, failed = validate_drive(kept, one, (*read_records([other], one), *read_records([brass], one)))
    assert (passed.outcome, failed.outcome) == ("passes", "fails")

    with pytest.raises(FingerprintError, match=r"one value of T, found T\(known\), T\(brass\), T\(steel\); state"):
        identified_drive(kept, one)
    path = tmp_path / "one.toml"
    path.write_text(LAG_TOML + 'inputs_hold = true\n[[known]]\nname = "T"\nvalue = 0.7\n', encoding="utf-8")
    model = identified_drive(kept, equipped(load_drive(path)))
    assert dict(zip(model.structure.names, model.values, strict=True))["T"] == 0.7
    assert [parameter.name for parameter in model.structure.free] == ["K"]
    assert model.covariance.shape == (1, 1)


def test_planned_records_tell_their_own_values_apart(tmp_path):
    path = tmp_path / "drive.toml"
    path.write_text(LAG_TOML + OWN, encoding="utf-8")
    one = equipped(load_drive(path))
    columns = lag_of(0.3, np.random.default_rng(1), 120)
    plans = [written(tmp_path, name, columns, INTERVAL) for name in TIMES_S]
    records = read_records(plans, one)
    alone = predict_drive(one, records, noise_std={"y": 0.5}, values={"T": 0.3})
    assert list(alone) == ["K", "T(brass)", "T(steel)"]
    # two records of steel tell more than the one of brass, and all of them the gain
    assert alone["T(steel)"] < 0.85 * alone["T(brass)"]
    assert alone["K"] < 0.6 * predict_drive(one, records[:1], noise_std={"y": 0.5}, values={"T": 0.3})["K"]
    groups = [structure for structure, _ in with_structures(one, records)]
    assert groups[1] is groups[2]


def test_a_stated_value_stands_for_those_of_all_records_before_what_is_known(tmp_path):
    path = tmp_path / "drive.toml"
    path.write_text(LAG_TOML + OWN + '[[known]]\nname = "T"\nvalue = 0.9\nstd = 0.1\n', encoding="utf-8")
    one = equipped(load_drive(path))
    plans = [written(tmp_path, name, {"u": np.arange(40.0) % 7.0}, INTERVAL) for name in ("brass", "steel_1", "known")]
    records = read_records(plans, one, planned=True)
    assumed = partial(predicted_at, one, records, priors={"K": Prior(90.0, 5.0)})
    assert assumed(values={}) == {"K": 90.0, "T(brass)": 0.9, "T(steel)": 0.9, "T(known)": 0.35}
    assert assumed(values={"T(steel)": 0.4})["T(steel)"] == 0.4
    stated = assumed(values={"K": 70.0, "T": 0.3, "T(steel)": 0.4})
    assert (stated["K"], stated["T(brass)"], stated["T(steel)"]) == (70.0, 0.3, 0.4)
    with pytest.raises(StructureError, match="T_1"):
        assumed(values={"T_1": 1.0})


def test_what_is_held_has_no_own_values(tmp_path):
    path = tmp_path / "drive.toml"
    path.write_text(LAG_TOML + OWN + '[[known]]\nname = "T"\nvalue = 0.3\n', encoding="utf-8")
    with pytest.raises(SettingsError, match="per_record: expected a free parameter, found T, which is held"):
        equipped(load_drive(path))
