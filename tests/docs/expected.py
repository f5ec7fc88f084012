"""What the commands of the pages leave behind and print, held against what is known of the simulated tug.

Each function is given the folder in which the command was run, what it printed, and its arguments.
"""

import csv
import math
import re
import tomllib

import numpy as np
import pytest
from expected_exports import EXPORTS

from shaftprint.campaign import load_campaign, load_trial_conditions
from shaftprint.catalogue import structure
from shaftprint.design import read_plan
from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import read_recording
from shaftprint.tug import read_truth
from shaftprint.vessel import load_vessel

CHANNELS = {"U_setpoint", "PTM_e", "PTM_1", "PTM_4", "M_s"}


def after(words, option):
    """Return what stands behind an option."""
    return words[words.index(option) + 1]


def rows(printed, heading):
    """Return the cells of a printed table by their first one."""
    lines = printed[printed.index(heading) :].splitlines()
    start = next(place for place, line in enumerate(lines) if line.startswith(" ──"))
    cells = [re.split(r"\s{2,}", line.strip()) for line in lines[start + 1 :]]
    end = next(place for place, row in enumerate(cells) if row == [""])
    return {row[0]: row[1:] for row in cells[:end]}


def expect_demo(folder, printed, words):
    assert read_fingerprint(folder / "demo" / "fingerprint.json").structure == "GAUGE-CLOSED"
    assert (folder / "demo" / "index.html").is_file()
    assert "What was found" in printed


def expect_settings(folder, printed, words):
    load = {"vessel": load_vessel, "campaign": load_campaign, "conditions": load_trial_conditions}[words[1]]
    (file,) = (word for word in words if word.endswith(".toml"))
    loaded = load(folder / file)
    assert loaded.place if words[1] == "conditions" else loaded.name


# What identify takes for tests of these ships, what such a test tells beside the parameters, and to how many per cent
# or better it knows the inertia behind the gauge.
PREDICTED = {
    "stan-tug-1205-underway": ("FREE-LOG", {"(e - a) / tau_u", "b (2 - a) / tau_u"}, 5),
    "nifs-research-vessel": ("GAUGE-PITCH", {"t_d + t_sp", "q c_th"}, 1),
    "nifs-research-vessel-combinator": ("GAUGE-COMBINATOR", {"t_d + t_sp", "q c_comb"}, 1),
}


def expect_prediction(folder, printed, words):
    ship = next((word for word in words if word in PREDICTED), "")
    name, combinations, per_cent = PREDICTED.get(ship, ("GAUGE-CLOSED", {"t_d + t_sp", "K_p / K_i"}, 1))
    predicted = structure(name)
    shown = "MY-LOOP" if "--structure" in words else name
    assert f"{shown}: {predicted.title.split(' with ')[0]}" in " ".join(printed.split())
    free = {parameter.name for parameter in predicted.free}
    assert free | combinations <= set(rows(printed, "Predicted accuracy with these lines"))
    assert re.search(rf"Known to {per_cent} % or better: [^.]*\btau_dn\b", printed)


def expect_inspection(folder, printed, words):
    if "--vessel" not in words:
        heading = next(line for line in printed.splitlines() if line.split()[:2] == ["channel", "unit"])
        assert all(word in heading for word in ("rate [Hz]", "span [s]", "lowest", "mean", "highest"))
        assert set(rows(printed, heading)) == CHANNELS
        # a sensor map to paste
        found = tomllib.loads(printed.partition("are for you to fill in\n")[2])
        assert [speed["channel"] for speed in found["sensors"]["speed"]] == ["PTM_e", "PTM_1", "PTM_4"]
        return
    for heading in (
        "Channels, raw", "Sensors of the vessel file", "Steady state", "Engine-speed channels",
        "Angles between the reflection strips", "Delay between set point and speed", "Repairs of raw channels",
        "Local signal-to-noise ratio", "Findings on the signals", "Limits",
    ):  # fmt: skip
        assert heading in printed
    # on a rigid line all three speeds have one mean
    means = rows(printed, "Engine-speed channels")
    assert set(means) == {"n_e", "n_e1", "n_e4"}
    mean = [next(line.split() for line in printed.splitlines() if line.split()[:1] == [name]) for name in means]
    assert [float(cells[2]) for cells in mean] == pytest.approx([float(mean[0][2])] * 3, rel=1e-4)
    assert mean[0][3] == "0.000"
    # the answer comes first
    assert printed.startswith("Good enough: 10 of 10 lines are good, 4 of them between 1 "
                              "and 12 rad/s, where the loop crosses over.")  # fmt: skip


def expect_identification(folder, printed, words):
    place = folder / after(words, "-o")
    found = read_fingerprint(place / "fingerprint.json")
    assert found.structure == "GAUGE-CLOSED"
    assert re.search(rf"^Fingerprint: {place.name}.fingerprint\.json$", printed, flags=re.MULTILINE)
    page = (place / "index.html").read_text(encoding="utf-8")
    assert all(f"plots/{path.name}" in page for path in (place / "plots").iterdir())
    assert found.quality.weighting == "MaximumLikelihood"
    assert found.quality.starts == 50
    assert (found.priors["g"].mean, found.priors["g"].std) == (0.0, 0.1)
    # table E.1 of the thesis: 54.006 kg m2 upstream of the gauge; 2 pi 54.006 n_s0 / M_s0 at the measured working point
    torque, speed = found.conditions.shaft_torque.value, found.conditions.engine_speed.value
    tau_up = 2.0 * math.pi * 54.006 * speed / 60.0 / 3.82 / torque
    assert found.priors["tau_up"].mean == pytest.approx(tau_up, rel=1e-3)
    sources = [("recording", words[1]), ("vessel", after(words, "--vessel")), ("campaign", after(words, "--campaign"))]
    assert [(s.role, s.name) for s in found.sources] == sources
    # the truth of the simulated tug: 17.0 kg m2 of propeller, shaft and water; 0.0703 + 0.0518 s
    assert found.quantity("I_dn").value == pytest.approx(17.0, rel=0.02)
    assert found.quantity("t_d + t_sp").value == pytest.approx(0.1221, rel=0.05)


def expect_saved_fingerprint(folder, printed, words):
    assert printed.startswith(
        "Verdict: trustworthy, but not governor gains\n  * The fit can be trusted: "
        "GAUGE-CLOSED explains 10 good spectral lines"
    )
    found = read_fingerprint(folder / words[1] / "fingerprint.json")
    assert set(rows(printed, "Identified parameters")) == {quantity.name for quantity in found.parameters}
    assert set(rows(printed, "Combinations of parameters")) == {quantity.name for quantity in found.combinations}
    assert set(rows(printed, "Physical values")) == {quantity.name for quantity in found.physical}


def expect_recording(folder, printed, words):
    path = folder / after(words, "-o")
    with read_recording(path) as recording:
        assert set(recording.channels) == CHANNELS
        begin = round(2000.0 * float(after(words, "--from"))) if "--from" in words else 0
        end = round(2000.0 * float(after(words, "--to"))) if "--to" in words else 1_720_000
        clocks = {(channel.count, channel.rate_hz, channel.start_s) for channel in recording.channels.values()}
        assert clocks == {(end - begin, 2000.0, begin / 2000.0)}
        assert path.suffix == ".nc" or "MDF" in recording.format
        if words[0] == "convert":
            with read_recording(folder / words[1]) as source:
                for name, channel in recording.channels.items():
                    np.testing.assert_array_equal(
                        channel.values(0, 5000), source.channel(name).values(begin, begin + 5000), err_msg=name
                    )
    if words[0] == "sail":
        assert read_truth(path.with_name(f"{path.stem}.truth.json")).seed == 1
    if path.name == "thesis.nc":
        # the voyage of the demo, whose recording other commands take under this name
        assert path.read_bytes() == (folder / "recording.nc").read_bytes()


def expect_merged(folder, printed, words):
    with read_recording(folder / after(words, "-o")) as merged, read_recording(folder / "recording.nc") as before:
        assert set(merged.channels) == CHANNELS
        for name, channel in merged.channels.items():
            # the first sample and the last are where one logger would have them, within a tenth of a millisecond
            one = before.channel(name)
            assert channel.count == one.count
            assert channel.start_s == pytest.approx(one.start_s, abs=1e-4), name
            assert channel.start_s + channel.duration_s == pytest.approx(one.start_s + one.duration_s, abs=1e-4), name
            np.testing.assert_allclose(channel.values(0, 100), one.values(0, 100), atol=1e-9)


def expect_structure(folder, printed, words):
    assert printed.startswith("MY-LOOP: gauge-aware closed loop, n_set -> n, M_s\n")
    assert set(rows(printed, "MY-LOOP")) == set(structure("GAUGE-CLOSED").names)
    assert "t_d + t_sp [s]: total delay" in printed


def expect_simulation(folder, printed, words):
    with (folder / after(words, "-o")).open(encoding="utf-8") as file:
        titles, *lines = csv.reader(file)
    values = dict(zip(titles, np.array(lines, dtype=float).T, strict=True))
    time_s = values["time [s]"]
    if "--fingerprint" not in words:
        # 2 % more from 1 s on, which an integrating governor follows; propeller torque has the slope 2
        assert values["n [-]"][time_s < 1.0].tolist() == [0.0] * 10
        assert values["n [-]"][-1] == pytest.approx(0.02, rel=0.02)
        assert values["M_s [-]"][-1] == pytest.approx(0.04, rel=0.02)
        return
    assert time_s[[0, -1]].tolist() == [7880.0, 8240.0]
    for name in ("engine speed", "shaft torque"):
        unit = {"engine speed": "rpm", "shaft torque": "N m"}[name]
        # steady running first, and a band where something moves
        assert values[f"{name} std [{unit}]"][0] == 0.0
        assert values[f"{name} std [{unit}]"].max() > 0.0
    # St2 of the thesis goes from -3 to -7 V, 250.97 rpm each, about 1183.5 rpm; a step overshoots
    asked, speed = values["set point [rpm]"], values["engine speed [rpm]"]
    assert [asked.min(), asked.max()] == pytest.approx([1183.5 - 502.0, 1183.5 + 502.0], rel=2e-3)
    assert speed.min() < 1.01 * asked.min()
    assert speed.max() > 0.99 * asked.max()
    if "--figure" in words:
        assert (folder / after(words, "--figure")).read_bytes().startswith(b"\x89PNG")


def expect_validation(folder, printed, words):
    assert printed.startswith("Validation: ")
    assert "GAUGE-CLOSED misses of records that it has not seen" in printed
    # 1 V steps of 30 s from 10 s on
    for at in (10, 40, 70, 100, 130, 160, 190):
        assert f"St1, step at {at}.0 s" in printed
    assert "overshoot of n [%]" in printed
    written = {path.name for path in (folder / after(words, "-o")).glob("*.svg")}
    assert {"missed_beyond_noise.svg", "St1-whole-staircase.svg"} <= {name.replace(" ", "-") for name in written}


def expect_explanation(folder, printed, words):
    for heading in ("The factor:", "The damping:", "The drift:"):
        assert heading in printed
    assert "calculation, downstream of the gauge" in printed
    assert "GAUGE-CLOSED" in printed
    assert not set("\N{MINUS SIGN}\N{PLUS-MINUS SIGN}\N{DEGREE SIGN}") & set(printed)
    place = folder / after(words, "-o")
    assert 'id="explanation"' in (place / "thesis.html").read_text(encoding="utf-8")
    assert (place / "plots" / "missing_damping.js").is_file()
    assert read_fingerprint(place / "fingerprint.json").structure == "GAUGE-CLOSED"


def expect_history(folder, printed, words):
    # the inertia of the last spring came with the docking before it
    said = "Has the ship changed? No change but what was noted in 4 tests from 2023-03-01 to 2026-03-01."
    assert printed.startswith(said)
    # half as much inertia again
    assert "Since the docking on 2025-05-01, as noted: more inertia behind the torque gauge, by 50.0" in printed
    assert (folder / after(words, "-o") / "index.html").is_file()


def expect_comparison(folder, printed, words):
    assert "result-2026 compared with result-2025" in printed
    said = {line.split()[0]: line for line in printed.splitlines() if line.split()}
    # half as much inertia again behind the gauge, and nothing else
    assert " differs " in said["I_dn"]
    for name in ("I_up", "K_Q", "gain", "K_p"):
        assert " no difference seen " in said[name] or " cannot be compared " in said[name], name
    assert " no difference seen " in said["I_up"]
    assert (folder / after(words, "-o") / "index.html").is_file()


def expect_plan(folder, printed, words):
    names = {"campaign.toml", "index.html", "plan.json", "set_point.csv", "set_point_generator.txt", "set_point.mat"}
    written = folder / after(words, "-o")
    assert names <= {path.name for path in written.iterdir()}
    assert " meet every wish, as predicted." in printed
    wishes = rows(printed, "Wish against prediction")
    assert set(wishes) == {"t_d", "K_p"}
    assert float(wishes["t_d"][3]) <= 1.0
    test = read_plan(written)
    # twelve minutes, and the way back to the first level
    assert 690.0 < test.plan.duration_s <= 720.0
    assert "The plan was not rehearsed." in printed


def expect_further_leg(folder, printed, words):
    assert printed.startswith("Nothing is wished; of the plan 2 of M2 periods are missing.")
    further = read_plan(folder / "plan" / "next")
    assert [leg.speed_share for leg in further.plan.legs] == [0.78]
    assert len(further.sailed) == 2


def expect_start(folder, printed, words):
    # the folder of the pages has vessel, campaign and results: nothing is asked
    assert re.search(r"^Next: +shaftprint \w+", printed, re.MULTILINE)


EXPECTED = {
    "start": expect_start,
    "plan": expect_plan,
    "continue": expect_further_leg,
    "demo": expect_demo,
    "new": expect_settings,
    "predict": expect_prediction,
    "inspect": expect_inspection,
    "identify": expect_identification,
    "show": expect_saved_fingerprint,
    "convert": expect_recording,
    "sail": expect_recording,
    "merge": expect_merged,
    "structures": expect_structure,
    "simulate": expect_simulation,
    "validate": expect_validation,
    "explain": expect_explanation,
    "compare": expect_comparison,
    "drift": expect_history,
} | {f"export {name}": expect for name, expect in EXPORTS.items()}
