"""A ship with two lines: the wash of one on the other by hand, the sea they share, one log of both."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tug.linearised import linearised_response
from tests.tug.linearised_both import linearised_both

from shaftprint.campaign import CampaignOfBoth
from shaftprint.campaign._both_shafts import load_campaign_of_both
from shaftprint.catalogue import structure
from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Sailing, Tug, normalised_truth, sail
from shaftprint.tug._sail_both import sail_both
from shaftprint.tug._shared_water import SharedWater
from shaftprint.tug.plant._both_lines import sea_and_own, voyage_of_both
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import Stretch, voyage
from shaftprint.vessel import Vessel, load_vessel

STEP_S = 5e-4
POINT_RPM, UPSTREAM, DOWNSTREAM, TORQUE_NM, RATIO = 1183.8, 54.006, 17.0, 1725.0, 3.82
OTHER = Tug(proportional_gain=4.4, integral_gain_per_s=3.6, governor_delay_s=0.0813, set_point_latency_s=0.0407)
WATER = SharedWater(port_share=0.03, starboard_share=0.02, wash_delay_s=0.2, wash_lag_s=0.35)


@pytest.fixture(scope="module")
def vessels() -> tuple[Vessel, Vessel]:
    return load_vessel("stan-tug-1205"), load_vessel("stan-tug-1205-starboard")


def both(duration_s: float, port: dict[str, Any], starboard: dict[str, Any]) -> CampaignOfBoth:
    content = {"name": "both", "duration_s": duration_s, "excited": "in turn", "port": port, "starboard": starboard}
    return CampaignOfBoth.model_validate(content)


def sine(frequency_hz: float, start_s: float, stop_s: float) -> dict[str, Any]:
    one = {"name": "S", "frequency_hz": frequency_hz, "amplitude_v": 0.02, "settled_s": start_s + 20.0}
    return {"offset_v": -5.0, "sines": [one | {"start_s": start_s, "stop_s": stop_s}]}


def at_the_end(duration_s: float) -> dict[str, Any]:
    stairs = {"name": "St", "levels_v": [-5.0], "dwell_s": 1.0, "start_s": duration_s - 1.0}
    return {"offset_v": -5.0, "staircases": [stairs]}


def sailed(
    vessels: tuple[Vessel, Vessel], campaign: CampaignOfBoth, water: SharedWater, *, chunk: int = 1 << 15, seed: int = 0
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return what happens to both lines; without a seed nothing disturbs them."""
    noise = Noise() if seed else Noise().without(process=True)
    rngs = [np.random.default_rng([seed, line]) for line in range(3)]
    sea, own = sea_and_own([noise, noise], water, STEP_S, rngs)
    stretches = list(
        voyage_of_both(
            (Tug(), OTHER),
            vessels,
            campaign.sides,
            water=water,
            step_s=STEP_S,
            steps=round(campaign.duration_s / STEP_S),
            chunk=chunk,
            sea=sea,
            disturbances=own,
        )
    )
    port, starboard = (joined([pair[side] for pair in stretches]) for side in (0, 1))
    return port, starboard


def joined(stretches: list[Stretch]) -> dict[str, np.ndarray]:
    names = ("time_s", "shaft_speed_rev_s", "shaft_torque_nm", "brake_torque_nm")
    return {name: np.concatenate([getattr(one, name) for one in stretches]) for name in names}


def own_response(tug: Tug, frequency_hz: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ``n / n_set``, ``n / load`` and ``tau_dn s + 2`` of a line, worked out by hand; g is 0, v is 1."""
    s = 2j * np.pi * frequency_hz
    up, down = (2.0 * np.pi * i * POINT_RPM / 60.0 / RATIO / TORQUE_NM for i in (UPSTREAM, DOWNSTREAM))
    omega, zeta = tug.natural_frequency_rad_s, tug.damping_ratio
    fuel = omega**2 / (s**2 + 2.0 * zeta * omega * s + omega**2) * np.exp(-s * tug.governor_delay_s)
    engine = (tug.proportional_gain + tug.integral_gain_per_s / s) * fuel
    turning = (up + down) * s + 2.0 + engine
    return engine / turning * np.exp(-s * tug.set_point_latency_s), -1.0 / turning, down * s + 2.0


def test_responses_of_both_lines_are_those_worked_out_by_hand(vessels: tuple[Vessel, Vessel]) -> None:
    frequency = np.geomspace(0.1, 10.0, 25) / (2.0 * np.pi)
    s = 2j * np.pi * frequency
    wash = np.exp(-0.2 * s) / (0.35 * s + 1.0)
    (asked_p, load_p, gauge_p), (asked_s, load_s, _) = (own_response(tug, frequency) for tug in (Tug(), OTHER))
    closed = 1.0 / (1.0 - load_p * 0.03 * wash * load_s * 0.02 * wash)
    n_p, n_s = asked_p * closed, -load_s * 0.02 * wash * asked_p * closed
    response = linearised_both((Tug(), OTHER), vessels, frequency, water=WATER)
    assert response[0, 0] == pytest.approx(n_p, rel=3e-6)
    assert response[2, 0] == pytest.approx(n_s, rel=3e-6)
    assert response[0, 1] == pytest.approx(-load_p * 0.03 * wash * asked_s * closed, rel=3e-6)
    # the gauge of port feels its own inertia and propeller, and the wash of the other
    assert response[1, 0] == pytest.approx(gauge_p * n_p - 0.03 * wash * n_s, rel=3e-6)


def test_own_lines_are_those_of_one_shaft_within_half_a_per_cent(vessels: tuple[Vessel, Vessel]) -> None:
    """What ties both shafts to the catalogue: on its own lines each side is a line alone, but for the wash squared."""
    omega = np.geomspace(0.1, 10.0, 40)
    response = linearised_both((Tug(), OTHER), vessels, omega / (2.0 * np.pi), water=WATER)
    for side, tug in enumerate((Tug(), OTHER)):
        truth, model = normalised_truth(tug, vessels[side]), structure("GAUGE-CLOSED")
        # sensors without errors, and what the simulated line does not have
        perfect = {p.name: p.value for p in model.parameters} | {"t_gauge": 0.0, "c_set": 1.0}
        values = np.array([truth.get(p.name, perfect[p.name]) for p in model.parameters])
        modelled = model.response(values, 1j * omega).reshape(2, omega.size)
        ratio = response[2 * side : 2 * side + 2, side] / modelled
        assert np.abs(ratio) == pytest.approx(np.ones(ratio.shape), abs=0.005)
        assert np.degrees(np.angle(ratio)) == pytest.approx(np.zeros(ratio.shape), abs=0.5)


@pytest.mark.parametrize("frequency_hz", [0.2, 0.9])
def test_stepped_lines_follow_a_small_sine_of_one_side_as_linearised(
    vessels: tuple[Vessel, Vessel], frequency_hz: float
) -> None:
    campaign = both(50.0, sine(frequency_hz, 0.0, 45.01), at_the_end(50.0))
    port, starboard = sailed(vessels, campaign, WATER)
    late = (port["time_s"] >= 25.0) & (port["time_s"] < 45.0)
    phase = 2.0 * np.pi * frequency_hz * port["time_s"][late]
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)

    def part(values: np.ndarray) -> complex:
        cosine, sine_part, mean = np.linalg.lstsq(columns, values[late], rcond=None)[0]
        return complex(cosine, -sine_part) / mean

    names = ("shaft_speed_rev_s", "shaft_torque_nm")
    found = np.array([part(line[name]) for line in (port, starboard) for name in names])
    expected = linearised_both((Tug(), OTHER), vessels, [frequency_hz], water=WATER)[:, 0, 0]
    assert found[1:] / found[0] == pytest.approx(expected[1:] / expected[0], rel=5e-3)


def test_lines_without_common_water_are_two_ships(vessels: tuple[Vessel, Vessel]) -> None:
    """Bit for bit the voyages of each line alone."""
    water = SharedWater(port_share=0.0, starboard_share=0.0, sea_share=0.0)
    campaign = both(4.0, sine(1.0, 0.0, 3.0) | {"sines": []} | {"staircases": [STAIRS]}, at_the_end(4.0))
    pair = sailed(vessels, campaign, water, seed=5)
    for line, tug in enumerate((Tug(), OTHER)):
        alone = voyage(
            tug,
            vessels[line],
            campaign.sides[line],
            step_s=STEP_S,
            steps=8000,
            chunk=1 << 15,
            disturbance=Disturbance(Noise(), STEP_S, np.random.default_rng([5, line + 1])),
        )
        for name, values in joined(list(alone)).items():
            assert np.array_equal(values, pair[line][name]), name


STAIRS = {"name": "St", "levels_v": [-4.5, -5.5], "dwell_s": 1.0, "start_s": 0.5}


def test_voyage_of_both_does_not_depend_on_its_chunks(vessels: tuple[Vessel, Vessel]) -> None:
    campaign = both(4.0, {"offset_v": -5.0, "staircases": [STAIRS]}, at_the_end(4.0))
    pairs = zip(*(sailed(vessels, campaign, WATER, chunk=chunk, seed=3) for chunk in (8000, 777)), strict=True)
    for whole, cut in pairs:
        for name, values in whole.items():
            assert cut[name] == pytest.approx(values, rel=1e-12, abs=1e-12), name


def test_sea_of_both_has_the_size_of_one_and_the_stated_share() -> None:
    noise, water = Noise(), SharedWater(sea_share=0.3)
    sea, own = sea_and_own([noise, noise], water, 0.5, [np.random.default_rng(seed) for seed in range(3)])
    common = sea.next(400_000)[0]
    port, starboard = (common + one.next(400_000)[0] for one in own)
    size = noise.inflow_rms**2 + noise.surge_rms**2
    assert np.var(port) == pytest.approx(size, rel=0.05)
    assert np.cov(port, starboard)[0, 1] == pytest.approx(0.3 * size, rel=0.1)


def test_one_recording_holds_both_lines(vessels: tuple[Vessel, Vessel], tmp_path: Path) -> None:
    campaign = both(4.0, {"offset_v": -5.0, "staircases": [STAIRS]}, at_the_end(4.0))
    truth = sail_both(vessels, campaign, tmp_path / "both.nc", tugs=(Tug(), OTHER), seed=2)
    assert truth.starboard.normalised["K_p"] == 4.4
    assert (tmp_path / "both.truth.json").exists()
    sail(vessels[0], campaign.port, tmp_path / "port.nc", seed=2)
    with read_recording(tmp_path / "both.nc") as recording, read_recording(tmp_path / "port.nc") as alone:
        assert {*recording.channels} == {*alone.channels} | {f"{name}_starboard" for name in alone.channels}
        counts = {channel.count for channel in recording.channels.values()}
        assert counts == {8000}


def test_same_seed_gives_the_same_bytes(vessels: tuple[Vessel, Vessel], tmp_path: Path) -> None:
    campaign = both(4.0, {"offset_v": -5.0, "staircases": [STAIRS]}, at_the_end(4.0))
    for name in ("a.nc", "b.nc"):
        sail_both(vessels, campaign, tmp_path / name, tugs=(Tug(), OTHER), seed=2)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_starboard_file_is_the_port_one_but_for_names(vessels: tuple[Vessel, Vessel]) -> None:
    port, starboard = (one.model_dump(mode="json") for one in vessels)
    for content in (port, starboard):
        del content["name"]
        for sensor in (
            *content["sensors"]["speed"],
            content["sensors"]["shaft_torque"],
            content["sensors"]["set_point"],
        ):
            sensor["channel"] = sensor["channel"].removesuffix("_starboard")
            sensor.pop("strip_angles_deg", None)
    assert port == starboard


def test_what_cannot_be_one_log_is_refused(vessels: tuple[Vessel, Vessel], tmp_path: Path) -> None:
    campaign, (port, starboard) = load_campaign_of_both("at-once"), vessels
    with pytest.raises(SettingsError, match="expected channels of their own, found M_s, PTM_1"):
        sail_both((port, port), campaign, tmp_path / "x.nc", tugs=(Tug(), OTHER), seed=1)
    with pytest.raises(SettingsError, match="expected a tug at the quay"):
        sail_both((port, starboard), campaign, tmp_path / "x.nc", tugs=(Tug(sailing=Sailing()), Tug()), seed=1)
    water = SharedWater(wash_delay_s=1e-4)
    with pytest.raises(SettingsError, match=r"expected wash_delay_s of at least 0\.001"):
        sail_both((port, starboard), campaign, tmp_path / "x.nc", tugs=(Tug(), Tug()), water=water, seed=1)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"port_share": 0.6}, "port_share between 0 and 0.5"),
        ({"sea_share": -0.1}, "sea_share between 0 and 1"),
        ({"wash_lag_s": 0.0}, "wash_lag_s above 0"),
    ],
)
def test_impossible_water_is_refused(change: dict[str, float], said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        replace(WATER, **change)


def test_a_load_is_felt_as_worked_out(vessels: tuple[Vessel, Vessel]) -> None:
    frequency = np.geomspace(0.02, 2.0, 9)
    _, loaded, gauge = own_response(Tug(), frequency)
    expected = np.array([loaded, 1.0 + gauge * loaded])
    assert linearised_response(Tug(), vessels[0], frequency, input="load")[:, 0] == pytest.approx(expected, rel=3e-6)
