"""Sailing as a whole: reproducible, independent of chunks, whole or not at all, with the truth beside it."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from shaftprint.errors import RecordingError, SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Tug, read_truth, sail, truth_path
from shaftprint.vessel import Vessel

Make = Callable[..., Any]


@pytest.fixture(scope="module")
def campaign(ask: Make, sine: Make) -> Any:
    levels = {"name": "St", "levels_v": [-3.0, -7.0], "dwell_s": 3.0, "start_s": 22.0}
    return ask(30.0, sines=[sine(0.8, 0.6)], staircases=[levels])


@pytest.fixture(scope="module")
def busy() -> Tug:
    return Tug(
        noise=replace(
            Noise(),
            missing_pulse_interval_s=4.0,
            doubled_pulse_interval_s=5.0,
            torque_spike_interval_s=3.0,
            torque_dropout_interval_s=6.0,
            set_point_spike_interval_s=5.0,
        )
    )


def test_same_seed_gives_the_same_bytes(vessel: Vessel, campaign: Any, busy: Tug, tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        sail(vessel, campaign, tmp_path / f"{name}.nc", tug=busy, seed=seed)
    first, second, third = ((tmp_path / f"{name}.nc").read_bytes() for name in "abc")
    assert first == second
    assert first != third
    texts = [truth_path(tmp_path / f"{name}.nc").read_text(encoding="utf-8") for name in "abc"]
    assert texts[0] == texts[1]
    assert texts[0] != texts[2]


def test_result_does_not_depend_on_chunks(
    vessel_with_bus: Vessel, campaign: Any, busy: Tug, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    truths = []
    for chunk in (262_144, 1777):
        monkeypatch.setattr("shaftprint.tug._sail.CHUNK", chunk)
        truths.append(sail(vessel_with_bus, campaign, tmp_path / f"{chunk}.nc", tug=busy, seed=7))
    assert truths[0] == truths[1]
    with read_recording(tmp_path / "262144.nc") as whole, read_recording(tmp_path / "1777.nc") as cut:
        assert "X_percent" in whole.channels
        for name, channel in whole.channels.items():
            assert channel.start_s == cut.channel(name).start_s
            assert np.array_equal(channel.read(0, channel.count), cut.channel(name).read(0, channel.count))


def test_truth_lies_beside_the_recording(vessel: Vessel, campaign: Any, tmp_path: Path) -> None:
    reports: list[float] = []
    truth = sail(vessel, campaign, tmp_path / "test.nc", seed=3, progress=reports.append)
    assert reports[-1] == 1.0
    assert truth_path(tmp_path / "test.nc") == tmp_path / "test.truth.json"
    assert read_truth(tmp_path / "test.truth.json") == truth
    assert sorted(path.name for path in tmp_path.iterdir()) == ["test.nc", "test.truth.json"]
    content = json.loads((tmp_path / "test.truth.json").read_text(encoding="utf-8"))
    content["normalised"]["K_p"], content["evil"] = "many", 1
    (tmp_path / "wrong.json").write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(RecordingError, match=r"truth\.normalised\.K_p: .* valid number.*; truth\.evil"):
        read_truth(tmp_path / "wrong.json")
    assert truth.normalised == pytest.approx(
        {
            "tau_up": 1.01601, "tau_dn": 0.31982, "tau_t": 1.33583, "k_q": 2.0, "g": 0.0, "v": 1.0, "K_p": 5.7,
            "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.0518, "X_0": 0.39707, "kappa": 0.0,
            "tau_i": 0.1, "tau_w": 0.0,
        },
        rel=1e-4,
    )  # fmt: skip
    assert truth.physical["governor_proportional_per_rev_s"] == pytest.approx(0.1147, rel=1e-3)
    assert truth.physical["map_rack_slope_nm"] == pytest.approx(1172.44, rel=1e-5)
    assert (truth.engine_speed_rpm, truth.shaft_torque_nm) == pytest.approx((1183.8, 1725.0))
    assert (truth.set_point_slope_rpm_per_v, truth.set_point_intercept_rpm) == (-250.97, -83.467)
    assert truth.limited["S"] == 0.0
    assert 0.001 < truth.limited["St"] < 0.5
    assert list(truth.faults) == sorted(truth.faults, key=lambda fault: (fault.time_s, fault.channel))


def test_truth_tells_of_inflow_water_zero_and_bus(vessel_with_bus: Vessel, campaign: Any, tmp_path: Path) -> None:
    tug = Tug(
        inflow_gain=1.2, inflow_time_s=0.15, entrained_water_kg_m2=3.4, torque_zero_offset_nm=40.0, rack_latency_s=0.013
    )
    truth = sail(vessel_with_bus, campaign, tmp_path / "test.nc", tug=tug, seed=3)
    assert read_truth(tmp_path / "test.truth.json") == truth
    found = truth.normalised
    assert (found["kappa"], found["tau_i"]) == (1.2, 0.15)
    # a fifth of the 17 kg m2 that the vessel has: water beyond it, and part of the whole
    assert found["tau_w"] == pytest.approx(0.2 * 0.31982, rel=1e-4)
    assert found["tau_dn"] == pytest.approx(1.2 * 0.31982, rel=1e-4)
    # the vessel file says 10 ms
    assert found["t_rack"] == pytest.approx(0.003)
    assert truth.physical["torque_zero_offset_nm"] == 40.0
    assert truth.physical["entrained_water_kg_m2"] == 3.4
    assert truth.physical["inertia_downstream_kg_m2"] == pytest.approx(20.4, abs=1e-3)


def test_nothing_is_replaced_unless_asked(vessel: Vessel, ask: Make, tmp_path: Path) -> None:
    path = tmp_path / "test.nc"
    sail(vessel, ask(1.0), path, seed=1)
    before = path.read_bytes()
    with pytest.raises(RecordingError, match="exists already"):
        sail(vessel, ask(1.0), path, seed=2)
    assert path.read_bytes() == before
    sail(vessel, ask(1.0), path, seed=2, overwrite=True)
    assert path.read_bytes() != before


def test_an_interrupted_voyage_leaves_nothing_behind(vessel: Vessel, ask: Make, tmp_path: Path) -> None:
    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sail(vessel, ask(1.0), tmp_path / "test.nc", seed=1, progress=stop)
    assert list(tmp_path.iterdir()) == []


def test_missing_folder_and_empty_campaign_are_refused(vessel: Vessel, ask: Make, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"test\.nc: the recording cannot be written"):
        sail(vessel, ask(1.0), tmp_path / "none" / "test.nc", seed=1)
    short = {"name": "St", "levels_v": [-5.0], "dwell_s": 1e-5, "start_s": 0.0}
    with pytest.raises(SettingsError, match="expected at least one sample at 2000 Hz"):
        sail(vessel, ask(1e-4, staircases=[short]), tmp_path / "test.nc", seed=1)


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"schema": 1, "strips": [], "faults": []}'])
def test_foreign_truth_is_refused(tmp_path: Path, content: str) -> None:
    path = tmp_path / "test.truth.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(RecordingError, match="expected a truth file"):
        read_truth(path)


def test_truth_of_another_version_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "test.truth.json"
    path.write_text(json.dumps({"schema": 2}), encoding="utf-8")
    with pytest.raises(RecordingError, match="expected truth of schema 1, found 2"):
        read_truth(path)


def test_absent_truth_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="No such file"):
        read_truth(tmp_path / "none.json")


def test_reference_tug_is_the_default() -> None:
    assert Tug.stan_tug_1205() == Tug()
