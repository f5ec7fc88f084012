"""The whole thesis campaign at 2000 Hz, once: what the main job must show.

Tolerances against the 95 % intervals of this campaign: half widths are near 0.12 % of ``tau_dn``, 0.1 % of ``k_q`` and
0.6 % of ``M_s0``, so that 1 % of ``I_dn`` and ``k_q`` is more than three standard deviations. Of ``t_d + t_sp`` one
standard deviation is 0.9 %, so that 1.5 % holds for nine seeds in ten. The seed is fixed; only a change of the
simulated noise draws a new case.
"""

import hashlib
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
import pytest
from benchmarks import thesis_tables
from benchmarks.result_tables import read_between_marks

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.clocks import align
from shaftprint.fingerprint import Fingerprint, SourceFile, read_fingerprint, take_fingerprint, write_fingerprint
from shaftprint.identify import Settings, Uniform, Unweighted, identify, profile_intervals
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, content_of, prepare_signals
from shaftprint.spectra import ExactBin, FrequencyResponse, estimate_response, open_loop
from shaftprint.tug import sail

pytestmark = pytest.mark.long

SEED = 1
TVC_S = 1.016
THESIS_STRUCTURES = ("OL1", "OL2", "OL3", "OL4", "OL5")


@dataclass(frozen=True, kw_only=True)
class Thesis:
    """The same recording, done the thesis' way."""

    signals: Signals
    response: FrequencyResponse
    fits: dict


def sha256(path):
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@pytest.fixture(scope="module")
def campaign():
    return load_campaign("thesis")


@pytest.fixture(scope="module")
def trip(vessel, campaign, tmp_path_factory):
    """Path, truth and hash of the recording before anyone reads it."""
    path = tmp_path_factory.mktemp("thesis") / "thesis.nc"
    truth = sail(vessel, campaign, path, seed=SEED)
    return path, truth, sha256(path)


@pytest.fixture(scope="module")
def found(identified, campaign, trip):
    return identified(trip[0], campaign)


@pytest.fixture(scope="module")
def true_values(trip, found):
    """True parameters and combinations by name, the latter worked out here."""
    p = dict(trip[1].normalised) | {"c_set": 1.0, "t_gauge": 0.0}
    return p | {
        "t_d + t_sp": p["t_d"] + p["t_sp"],
        "K_p / K_i": p["K_p"] / p["K_i"],
        "v K_i / (k_q - g)": p["v"] * p["K_i"] / (p["k_q"] - p["g"]),
        "v K_p / (tau_up + tau_dn)": p["v"] * p["K_p"] / (p["tau_up"] + p["tau_dn"]),
    }


@pytest.fixture(scope="module")
def fingerprint(found, vessel, campaign) -> Fingerprint:
    return take_fingerprint(
        found.fit,
        signals=found.signals,
        signal_to_noise=found.spectra.signal_to_noise,
        vessel=vessel,
        campaign=campaign,
        settings_files=(
            SourceFile(role="vessel", name="stan-tug-1205", sha256="0" * 64),
            SourceFile(role="campaign", name="thesis", sha256="1" * 64),
        ),
        now=datetime(2026, 5, 1, 12, 0, tzinfo=UTC),
    )


@pytest.fixture(scope="module")
def thesis(vessel, campaign, trip):
    with read_recording(trip[0]) as recording:
        signals = prepare_signals(recording, vessel, campaign, mode="thesis")
    response = estimate_response(signals, campaign, method=ExactBin())
    governor, core = open_loop(response)
    settings = Settings(weighting=Unweighted(), draw=Uniform())
    fits = {
        name: identify(
            structure(name),
            core if name == "OL1" else governor,
            rng=np.random.default_rng(SEED),
            settings=settings,
        )
        for name in THESIS_STRUCTURES
    }
    return Thesis(signals=signals, response=response, fits=fits)


def test_strip_angles_are_found_to_a_tenth_of_a_degree(found, trip):
    (strips,) = found.signals.strips
    true = next(strip.angle_deg for strip in trip[1].strips if strip.channel == strips.channel)
    # which strip is the first cannot be seen in a recording
    turned = [np.roll(true, shift) for shift in range(4)]
    error = min(np.abs(360.0 * strips.angle_rev - angles).max() for angles in turned)
    assert error < 0.1
    assert error < 6.0 * 360.0 * strips.std_rev.max()


def test_calibration_line_is_found_to_a_fifth_of_a_percent(found, trip):
    signals, truth = found.signals, trip[1]
    slope = 60.0 * signals.calibration.slope_rev_s_per_v * signals.dc_scale
    assert slope == pytest.approx(truth.set_point_slope_rpm_per_v, rel=2e-3)
    at_five_volt = 60.0 * (signals.calibration.slope_rev_s_per_v * -5.0 + signals.calibration.intercept_rev_s)
    true = -5.0 * truth.set_point_slope_rpm_per_v + truth.set_point_intercept_rpm
    assert at_five_volt == pytest.approx(true, rel=2e-3)


def test_working_point_is_that_of_the_ship(found):
    point = found.signals.working_point
    assert 60.0 * point.engine_speed_rev_s == pytest.approx(1183.8, rel=1e-3)
    assert point.shaft_torque_nm == pytest.approx(1725.0, abs=4.0 * point.shaft_torque_std_nm)


def test_pulses_that_the_tug_lost_are_found(found, trip):
    lost = [fault.time_s for fault in trip[1].faults if fault.channel == "PTM_e" and fault.kind == "missing pulse"]
    repaired = [r.time_s for r in found.signals.repairs if r.channel == "PTM_e" and r.kind == "missing pulse"]
    assert len(lost) > 5
    assert len(repaired) == len(lost)
    assert np.abs(np.array(lost) - np.array(repaired)).max() < 0.15


def test_what_is_promised_of_every_seed(fingerprint, true_values):
    assert fingerprint.quantity("I_dn").value == pytest.approx(17.0, rel=0.01)
    assert fingerprint.quantity("k_q").value == pytest.approx(2.0, rel=0.01)
    total = fingerprint.quantity("t_d + t_sp")
    assert total.value == pytest.approx(0.1221, rel=0.015)
    for name in ("K_p / K_i", "v K_i / (k_q - g)"):
        quantity = fingerprint.quantity(name)
        low, high = quantity.interval_95
        assert quantity.value == pytest.approx(true_values[name], rel=0.05)
        assert low < quantity.value < high


def test_truth_lies_inside_the_intervals(found, true_values):
    """15 numbers or so, 95 % each: were they independent, two or more would lie outside for 17 % of the seeds."""
    intervals = profile_intervals(found.fit)
    outside = [
        name
        for name, interval in intervals.items()
        if not (interval.lower <= true_values[name] or interval.lower_open)
        or not (true_values[name] <= interval.upper or interval.upper_open)
    ]
    assert len(intervals) == len(found.fit.structure.free) + 4
    assert len(outside) <= 1


def test_delays_that_cannot_be_told_apart_are_said_to_be_known_as_a_sum(found, fingerprint):
    widths = {name: i.upper - i.lower for name, i in profile_intervals(found.fit).items()}
    assert widths["t_d"] > 10.0 * widths["t_d + t_sp"]
    assert widths["t_sp"] > 10.0 * widths["t_d + t_sp"]
    for name in ("t_d", "t_sp"):
        finding = next(text for text in fingerprint.findings if text.startswith(f"{name} ="))
        assert "is poorly determined by this test; better determined: " in finding
        assert "t_d + t_sp = 0.12" in finding


def test_model_explains_the_data_to_within_their_noise(fingerprint):
    quality = fingerprint.quality
    # 14 lines of two complex values and a prior
    assert quality.degrees_of_freedom == 14 * 4 + 1 - len(fingerprint.parameters)
    # 1 % and 99 % points of chi-square with 45 degrees of freedom
    assert 25.9 < quality.chi_square < 70.0
    for output, percent in quality.fit_percent.items():
        assert percent > quality.fit_ceiling[output] - 1.0
    assert quality.starts_at_optimum >= 5


def test_margins_are_those_of_the_reference_truth(fingerprint):
    """Domain values of the reference line: gain margin 1.60, phase margin 53.6 degrees."""
    gain, phase = fingerprint.quantity("gain margin"), fingerprint.quantity("phase margin")
    assert gain.value == pytest.approx(1.60, abs=0.05)
    assert phase.value == pytest.approx(53.6, abs=3.0)


def test_aliased_lines_are_left_out_and_named(fingerprint):
    assert set(fingerprint.conditions.lines_left_out) == {"S15", "S16"}
    assert all("aliased" in reason for reason in fingerprint.conditions.lines_left_out.values())
    assert fingerprint.conditions.lines_used == tuple(f"S{number}" for number in range(1, 15))


def test_fingerprint_comes_back_equal_from_its_file(fingerprint, trip, tmp_path):
    write_fingerprint(fingerprint, tmp_path / "tug.json")
    assert read_fingerprint(tmp_path / "tug.json") == fingerprint
    assert fingerprint.sources[0].sha256 == trip[2]


def test_clocks_of_two_loggers_are_brought_together(second_logger, vessel, trip):
    """0.4 s apart and 30 ppm adrift: three hours later 0.34 s more."""
    engine, _, propeller = vessel.sensors.speed
    with read_recording(trip[0]) as recording:
        reference = content_of(recording.channel(engine.channel), engine, rate_hz=50.0)
        other = content_of(second_logger.of(recording.channel(propeller.channel)), propeller, rate_hz=50.0)
    clock = align(other, reference).map
    assert np.abs(clock.reference_s(other.time_s) - second_logger.true_time_s(other.time_s)).max() < 2e-3
    assert clock.drift == pytest.approx(30e-6, abs=4.0 * np.sqrt(clock.covariance[1, 1]))


def test_thesis_finds_the_wrong_inertia(thesis):
    """The TVC's 1.016 s belong to what is upstream of the gauge, and the pick-up is late: a factor of two to four."""
    assert 2.0 < TVC_S / thesis.fits["OL1"].value("tau_n") < 4.0


def test_thesis_cannot_tell_its_governors_apart(thesis):
    fits = [thesis.fits[name] for name in THESIS_STRUCTURES[1:]]
    percent = [fit.fit_percent["M_s"] for fit in fits]
    gain = [fit.value("K_p") for fit in fits]
    integral = [fit.value("K_i") for fit in fits]
    assert max(percent) - min(percent) < 5.0
    assert max(gain) > 1.5 * min(gain)
    # the same K_i in all four, as the thesis found, and as wrong
    assert max(integral) < 1.02 * min(integral)
    assert abs(np.mean(integral) / 4.27 - 1.0) > 0.1


def test_thesis_way_is_what_the_page_on_the_thesis_prints(thesis):
    """Tables 5.2 and 5.3, whole: the page was made from this recording, by this seed."""
    lines = read_between_marks(thesis_tables.DOCUMENT, thesis_tables.BEGIN, thesis_tables.END).splitlines()
    for name in THESIS_STRUCTURES[1:]:
        first = next(i for i, line in enumerate(lines) if line.startswith(f"| {name} | printed |"))
        row = next(line for line in lines[first:] if line.startswith("|  | simulated, thesis' way |"))
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        # the search may end a little apart on another machine; the last digit is 0.001
        assert thesis.fits[name].value("K_i") == pytest.approx(float(cells[4]), abs=0.003)
        assert thesis.fits[name].fit_percent["M_s"] == pytest.approx(float(cells[-1]), abs=0.11)


def test_thesis_uses_aliased_lines_and_is_told_so(thesis):
    assert thesis.response.used.all()
    assert thesis.signals.dc_scale == 1.0
    for line in ("S15", "S16"):
        assert "aliased" in thesis.response.remarks[line]


def test_recording_is_never_changed(thesis, fingerprint, trip):
    """After everything above has read it."""
    assert sha256(trip[0]) == trip[2]
    assert {place.name for place in trip[0].parent.iterdir()} == {"thesis.nc", "thesis.truth.json"}
