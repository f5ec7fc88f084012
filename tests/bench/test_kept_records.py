"""What a fingerprint keeps of the records of a drive: the colour of their noise, their offsets, where they are from."""

import numpy as np
import pytest

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._predict import planned_noise, predict_drive
from shaftprint.catalogue import shipped_structure
from shaftprint.drive import Drive
from shaftprint.drive._signals import Signal
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, DriveRecord, NoiseOfRecord
from shaftprint.identify import Verdict
from shaftprint.tables._drive import drive_record_table
from shaftprint.time_domain import record_from_arrays

POLE, ANEW = 0.9, 0.3


def kept(**changed):
    """A fingerprint of one record of 100 Hz whose noise remembers nine tenths of itself."""
    record = DriveRecord(
        name="steps, first half",
        seconds=10.0,
        rate_hz=100.0,
        fit_percent={"omega": 99.0},
        fit_ceiling={"omega": 99.1},
        noise_std={"omega": ANEW / np.sqrt(1.0 - POLE**2)},
        noise=NoiseOfRecord(coefficients=(((POLE,),),), covariance=((ANEW**2,),)),
        offset={"omega": -571.4},
        offset_std={"omega": 0.6},
        recording="a" * 64,
        from_s=0.0,
        to_s=10.0,
    )
    content = {
        "shaftprint_version": "1", "created": "2026-11-28T00:00:00Z", "sources": (), "drive": "bench",
        "structure": "MOTOR", "inputs": {"u": "V"}, "outputs": {"omega": "rad/s"}, "parameters": (), "held": {},
        "priors": {}, "covariance": (), "combinations": (), "records": (record,), "p_value": 0.5, "starts": 4,
        "starts_at_optimum": 4,
        "verdict": Verdict(trustworthy=False, reason="", sentences=(), trusted=(), not_trusted={}, loop=None),
    }  # fmt: skip
    return DriveFingerprint(**(content | changed))


def test_halves_of_a_file_share_no_time():
    (record,) = kept().records
    assert record.overlaps("a" * 64, 5.0, 20.0)
    assert not record.overlaps("a" * 64, 10.0, 20.0)
    assert not record.overlaps("b" * 64, 0.0, 10.0)


def test_offset_stands_in_the_table_of_records_and_in_the_file():
    fingerprint = kept()
    assert any("571.40 ± 0.60" in cell for cell in drive_record_table(fingerprint).rows[0])
    again = DriveFingerprint.model_validate_json(fingerprint.model_dump_json())
    assert again.records[0].offset == {"omega": -571.4}


def test_file_of_an_earlier_version_is_read_without_colour_and_offset():
    content = kept().model_dump(mode="json")
    content["schema_version"] = "drive 1.0"
    for key in ("noise", "offset", "offset_std", "recording", "from_s", "to_s"):
        del content["records"][0][key]
    (record,) = DriveFingerprint.model_validate(content).records
    assert record.noise is None
    assert record.offset == {}


@pytest.mark.parametrize("wanted", [0.2, 2.0])
def test_planned_noise_has_the_colour_that_is_kept_and_the_size_that_is_stated(wanted):
    """A noise of the pole 0.9 is correlated by 0.9 from sample to sample, whatever its size."""
    noise = planned_noise(kept(), ["omega"], noise_std={"omega": wanted}, rate_hz=100.0)
    assert noise.coefficients[0, 0, 0] == POLE
    assert np.sqrt(noise.power[0, 0]) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(("fingerprint", "rate_hz"), [(None, 100.0), (kept(), 50.0)])
def test_planned_noise_is_white_where_no_colour_is_kept_at_its_rate(fingerprint, rate_hz):
    noise = planned_noise(fingerprint, ["omega"], noise_std={"omega": 0.4}, rate_hz=rate_hz)
    assert noise.order == 0
    assert noise.covariance[0, 0] == pytest.approx(0.16)


def test_slow_noise_tells_less_of_a_constant_by_what_it_remembers():
    """n samples of a level tell n / s^2 of it under white noise, ((n - 1) (1 - a)^2 + 1 - a^2) / v^2 under pole a."""
    structure = shipped_structure("MOTOR").of_outputs("omega")
    structure = structure.held_at(**{p.name: p.value for p in structure.free if p.name != "K_m"})
    drive = Drive(
        name="bench", structure="MOTOR", inputs=(Signal(name="u", channel="u", unit="V"),),
        outputs=(Signal(name="omega", channel="omega", unit="rad/s"),), fit={"offset": "none"},
    )  # fmt: skip
    one = EquippedDrive(drive=drive, structure=structure, priors={}, factors={"u": 1.0}, units={"u": "V"})
    voltage = np.full(4000, 5.0)
    record = record_from_arrays("level", {"u": voltage}, {"omega": 0.0 * voltage}, rate_hz=100.0)
    size = {"omega": 0.5}
    white = predict_drive(one, [record], noise_std=size)["K_m"]
    slow = predict_drive(one, [record], noise_std=size, kept=kept())["K_m"]
    # with s^2 = v^2 / (1 - a^2): 4.349, near the root of (1 + a) / (1 - a)
    ratio = voltage.size * (1.0 - POLE**2) / ((voltage.size - 1) * (1.0 - POLE) ** 2 + 1.0 - POLE**2)
    assert slow / white == pytest.approx(np.sqrt(ratio), rel=1e-6)
