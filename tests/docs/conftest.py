"""A harbour: the folder in which the user of the pages works, with what a user has."""

import contextlib
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from click.testing import CliRunner
from pages import as_run, berth
from tests.planned import with_little_effort

from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint
from shaftprint.design import (
    Effort,
    PlannedTest,
    SetPointLine,
    Wish,
    assumed_ship,
    design_campaign,
    limits_from_vessel,
    write_plan_files,
)
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.recording import cut, read_recording, write_csv, write_recording
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

pytest.register_assert_rewrite("expected", "expected_exports")
IDENTIFY = "identify log.csv --vessel mine.toml --campaign test.toml -o result"
MY_SHIP = """
import dataclasses
from shaftprint.catalogue import structure

my_loop = dataclasses.replace(structure("GAUGE-CLOSED"), name="MY-LOOP")
"""
# The simulated tug, normalised at its working point.
TUG = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
# The second logger's clock is behind and slow: the first's time is 0.4 s and 1.00003 times the second's own.
BEHIND_S, SLOW = 0.4, 30e-6


@pytest.fixture(scope="session")
def harbour(demo, tmp_path_factory):
    """The folder: settings that are filled in, recordings, fingerprints, a structure of one's own, a set point.

    ``result`` is what the page's own command makes of the page's own log; its output is in ``printed``.
    """
    folder, voyage = tmp_path_factory.mktemp("harbour"), demo[0]
    for name in ("recording.nc", "tug.nc", "last_year.nc", "thesis.nc"):
        berth(voyage / "recording.nc", folder / name)
    berth(voyage / "vessel.toml", folder / "mine.toml")
    lever = "[sensors.set_point]\ntable_rpm = [[-8.0, 1936.8], [-2.0, 430.8]]\n"
    text = (voyage / "vessel.toml").read_text(encoding="utf-8").replace("[sensors.set_point]\n", lever)
    (folder / "vessel.toml").write_text(text, encoding="utf-8")
    for name in ("test.toml", "campaign.toml", "last_year.toml"):
        berth(voyage / "campaign.toml", folder / name)
    berth(voyage, folder / "demo")
    write_loggers(folder)
    write_last_years(folder, voyage)
    write_planned(folder)
    (folder / "my_ship.py").write_text(MY_SHIP, encoding="utf-8")
    rows = "".join(f"{0.1 * i:.1f},{0.0 if i < 10 else 0.02}\n" for i in range(50))
    (folder / "set_point.csv").write_text(f"time [s],n_set [-]\n{rows}", encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def printed(demo, harbour):
    """The output of the commands whose results other commands take, by the command as it is run."""
    with contextlib.chdir(harbour):
        found = CliRunner().invoke(shaftprint, IDENTIFY.split(), catch_exceptions=False)
    return {IDENTIFY: found, as_run(["demo"]): demo[1]}


def write_loggers(folder):
    """Write the recording as text, and as two loggers would have made it."""
    with read_recording(folder / "recording.nc") as recording:
        write_csv(folder / "log.csv", recording.channels.values())
        write_mdf(folder / "log.mf4", recording)
        write_recording(folder / "bridge.nc", [recording.channel(name) for name in ("U_setpoint", "PTM_e")])
        rate = 1.0 + SLOW
        shaft = [
            replace(channel, start_s=(channel.start_s - BEHIND_S) / rate, rate_hz=channel.rate_hz * rate)
            for channel in (recording.channel(name) for name in ("PTM_1", "PTM_4", "M_s"))
        ]
        write_recording(folder / "shaft.nc", shaft)


def write_planned(folder):
    """Write a plan of the tug, and its recording that was broken off after two periods of the second leg."""
    vessel = load_vessel("stan-tug-1205")
    plan = design_campaign(
        assumed_ship(structure("GAUGE-CLOSED"), TUG, std={}),
        Wish(),
        limits_from_vessel(vessel, set_point_rpm=200.0),
        STAN_TUG_NOISE,
        speeds=(1.15, 0.78),
        within_s=210.0,
        rng=np.random.default_rng(1),
        effort=Effort(steps=30, restarts=1),
    )
    line = SetPointLine(slope_rpm_per_v=-250.97, offset_v=-5.0)
    now = datetime(2026, 11, 23, tzinfo=UTC)
    planned = PlannedTest(
        name="short", vessel=vessel.name, plan=plan, line=line, created=now, noise_source="stored noise"
    )
    (folder / "plan").mkdir()
    write_plan_files(planned, folder / "plan", rate_hz=100.0)
    second = planned.campaign.multisines[1]
    sail(vessel, planned.campaign, folder / "sailed.nc", seed=1)
    with read_recording(folder / "sailed.nc") as whole:
        end_s = second.settled_s + 2.2 * second.period_s
        write_recording(folder / "broken_off.nc", cut(whole, to_s=end_s).channels.values())


def write_mdf(path, recording):
    """Write a recording as an MDF logger would have made it."""
    asammdf = pytest.importorskip("asammdf", reason="asammdf writes MDF")
    log = asammdf.MDF()
    for channel in recording.channels.values():
        seconds = channel.start_s + np.arange(channel.count) / channel.rate_hz
        volts = channel.values(0, channel.count).astype(np.float32)
        log.append([asammdf.Signal(samples=volts, timestamps=seconds, name=channel.name, unit=channel.unit)])
    log.save(path)
    log.close()


def write_last_years(folder, voyage):
    """Write the fingerprints of four springs; in the last there is half as much inertia again behind the gauge."""
    first = read_fingerprint(voyage / "fingerprint.json")
    more = tuple(replace(q, value=1.5 * q.value) if q.name == "I_dn" else q for q in first.physical)
    for year in (2023, 2024, 2025, 2026):
        sources = tuple(
            one.model_copy(update={"sha256": f"{year:064x}"}) if one.role == "recording" else one
            for one in first.sources
        )
        conditions = first.conditions.model_copy(update={"tested_at": datetime(year, 3, 1, 9, tzinfo=UTC)})
        changes = {"sources": sources, "conditions": conditions} | ({"physical": more} if year == 2026 else {})
        place = folder / f"result-{year}"
        place.mkdir()
        write_fingerprint(first.model_copy(update=changes), place / "fingerprint.json")


@pytest.fixture(autouse=True)
def _plans_with_little_effort(monkeypatch):
    with_little_effort(monkeypatch)
