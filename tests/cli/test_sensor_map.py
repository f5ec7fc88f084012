"""The proposal of ``shaftprint inspect`` for the sensors of the vessel file."""

import tomllib

import numpy as np

from shaftprint.recording import RecordingWriter


def _map(result):
    """Return the proposed part of the vessel file; its comments are left out."""
    assert result.exit_code == 0
    return tomllib.loads(result.output.partition("are for you to fill in\n")[2])


def test_sensors_of_the_simulated_tug(run, recording):
    found = _map(run("inspect", recording))
    assert [speed["channel"] for speed in found["sensors"]["speed"]] == ["PTM_e", "PTM_1", "PTM_4"]
    assert [speed["shaft"] for speed in found["sensors"]["speed"]] == ["engine", "propeller", "propeller"]
    assert found["sensors"]["shaft_torque"] == {"channel": "M_s", "unit": "V"}
    assert found["sensors"]["set_point"] == {"channel": "U_setpoint", "unit": "V"}
    assert found["logger"] == {"sample_rate_hz": 2000.0}


def test_what_cannot_be_told_is_left_for_the_user(run, recording):
    lines = run("inspect", recording).output.splitlines()
    assert len([line for line in lines if line.startswith("# pulses_per_revolution =")]) == 3
    assert len([line for line in lines if line.startswith("# scale_nm_per_unit =")]) == 1


def test_shapes_and_units_of_a_foreign_recording(run, tmp_path):
    seconds = np.arange(20_000) / 1000.0
    channels = {
        # 60 pulses a second that stay up for a fifth of the time; a sine of the same levels is none
        "Tacho motor": ("V", 1000.0, np.where(seconds * 60.0 % 1.0 < 0.2, 5.0, 0.1)),
        "Tacho sine": ("V", 1000.0, np.sin(2.0 * np.pi * 60.0 * seconds)),
        "Drehmoment": ("N m", 1000.0, 20e3 + 1e3 * np.sin(seconds)),
        "Lever": ("V", 1000.0, np.sin(0.3 * seconds)),
        "ECU rack": ("%", 50.0, 50.0 + np.sin(seconds[::20])),
        "GPS": ("kn", 1.0, np.linspace(8.0, 9.0, 20)),
        "Cabin": ("K", 1.0, np.full(20, 293.0)),
    }
    path = tmp_path / "foreign.nc"
    with RecordingWriter(path) as writer:
        for name, (unit, rate_hz, values) in channels.items():
            writer.declare(name, unit=unit, rate_hz=rate_hz, dtype="float64")
            writer.append(name, values)
    found = _map(run("inspect", path))["sensors"]
    assert [(speed["channel"], speed["shaft"]) for speed in found["speed"]] == [("Tacho motor", "engine")]
    assert found["shaft_torque"] == {"channel": "Drehmoment", "unit": "N m", "scale_nm_per_unit": 1.0}
    assert found["set_point"]["channel"] == "Lever"
    assert found["rack"] == {"channel": "ECU rack", "unit": "%", "cycle_s": 0.02}
    assert found["ship_speed"] == {"channel": "GPS", "unit": "kn", "cycle_s": 1.0}


def test_a_set_point_that_jumps_is_no_pick_up(run, tmp_path):
    """As a co-simulation writes a step test: titles without units."""
    path = tmp_path / "cosim.csv"
    titles = "Time,StepCount,engine_speed_set_point [1 real input],shaft_torque [2 real output]\n"
    rows = (f"{0.01 * k:.2f},{k},{int(k % 100 > 80)},{np.sin(0.01 * k):.4f}\n" for k in range(1000))
    path.write_text(titles + "".join(rows))
    result = run("inspect", path)
    assert "sensors" not in _map(result)
    of_text = 'has no unit: state it, of text with --columns "NAME=NAME'
    assert f"# [sensors.set_point]: 'engine_speed_set_point' {of_text} [rpm]\"" in result.output
    assert f"# [sensors.shaft_torque]: 'shaft_torque' {of_text} [N m]\"" in result.output
    units = "engine_speed_set_point=engine_speed_set_point [rpm],shaft_torque=shaft_torque [N m]"
    found = _map(run("inspect", path, "--columns", units))["sensors"]
    assert (found["set_point"]["unit"], found["shaft_torque"]["unit"]) == ("rpm", "N m")


def test_encoders_and_speeds_are_proposed_in_their_unit(run, tmp_path):
    seconds = np.arange(20_000) / 1000.0
    channels = {
        "Shaft encoder": ("counts", np.floor(4096.0 * 5.0 * seconds) % 65_536.0),
        "Crank angle": ("deg", 7200.0 * seconds % 360.0),
        "Rudder angle": ("deg", np.sin(seconds)),
        "Engine speed": ("rpm", 1200.0 + np.sin(seconds)),
    }
    path = tmp_path / "foreign.nc"
    with RecordingWriter(path) as writer:
        for name, (unit, values) in channels.items():
            writer.declare(name, unit=unit, rate_hz=1000.0, dtype="float64")
            writer.append(name, values)
    result = run("inspect", path)
    assert [(speed["channel"], speed["unit"], speed["shaft"]) for speed in _map(result)["sensors"]["speed"]] == [
        ("Shaft encoder", "counts", "propeller"),
        ("Crank angle", "deg", "engine"),
        ("Engine speed", "rpm", "engine"),
    ]
    assert result.output.count("# counts_per_revolution =") == 2


def test_sensors_that_no_channel_looks_like_are_named(run, tmp_path):
    path = tmp_path / "cabin.nc"
    with RecordingWriter(path) as writer:
        writer.declare("Cabin", unit="K", rate_hz=1.0, dtype="float64")
        writer.append("Cabin", np.full(20, 293.0))
    output = run("inspect", path).output
    for words in ("[sensors.shaft_torque]: no", "[sensors.set_point]: no", "[[sensors.speed]]: no channel holds"):
        assert words in output


def test_signals_of_a_control_unit_are_known_by_their_numbers(run, tmp_path):
    """As a DBC file gave them: SPN 513 is nearer to what the governor gives than 512."""
    channels = {
        "EEC1_a": ("%", "SPN 512: driver's demand"),
        "EEC1_b": ("%", "SPN 513: actual"),
        "EEC1_c": ("rpm", "SPN 190"),
        "EEC2_a": ("%", "SPN 91"),
        "EEC2_b": ("%", "SPN 92"),
        "LFE": ("L/h", "SPN 183"),
        "EEC3": ("rpm", "SPN 515: desired operating speed"),
    }
    path = tmp_path / "bus.nc"
    with RecordingWriter(path) as writer:
        for name, (unit, long_name) in channels.items():
            writer.declare(name, unit=unit, rate_hz=50.0, dtype="float64", long_name=long_name)
            writer.append(name, 40.0 + np.sin(np.arange(1000.0)))
    result = run("inspect", path)
    found = _map(result)["sensors"]
    assert found["rack"] == {"channel": "EEC1_b", "unit": "%", "cycle_s": 0.02}
    assert [(speed["channel"], speed["unit"]) for speed in found["speed"]] == [("EEC1_c", "rpm")]
    assert found["set_point"] == {"channel": "EEC2_a", "unit": "%"}
    assert found["demand"] == {"channel": "EEC3", "unit": "rpm", "cycle_s": 0.02}
    assert set(found) == {"rack", "set_point", "speed", "demand"}
    said = [line for line in result.output.splitlines() if "another channel" in line]
    assert [line.split("'")[1] for line in said] == ["EEC2_b", "LFE"]


def test_what_a_control_unit_sends_for_want_of_better(run, tmp_path):
    """A voltage asks faster than the pedal; without a torque the load shows the rack, else the fuel rate."""

    def proposed(**channels):
        path = tmp_path / f"{'_'.join(channels)}.nc"
        with RecordingWriter(path) as writer:
            for name, (unit, long_name, rate_hz) in channels.items():
                writer.declare(name, unit=unit, rate_hz=rate_hz, dtype="float64", long_name=long_name)
                writer.append(name, 40.0 + np.sin(np.arange(40_000.0)))
        return run("inspect", path)

    pedal, load, fuel = ("%", "SPN 91", 50.0), ("%", "SPN 92", 50.0), ("L/h", "SPN 183", 10.0)
    beside = proposed(EEC2_a=pedal, Setpoint=("V", "", 2000.0), EEC2_b=load, LFE=fuel)
    found = _map(beside)["sensors"]
    assert found["set_point"] == {"channel": "Setpoint", "unit": "V"}
    assert found["rack"] == {"channel": "EEC2_b", "unit": "%", "shows": "load", "cycle_s": 0.02}
    assert "'EEC2_a': SPN 91, position of the accelerator pedal; the set point comes from another channel" in (
        beside.output
    )
    alone = proposed(LFE=fuel)
    assert _map(alone)["sensors"]["rack"] == {"channel": "LFE", "unit": "L/h", "cycle_s": 0.1}
    assert "# rated_l_h =" in alone.output


def test_gauges_are_proposed_with_what_their_unit_needs(run, tmp_path):
    def proposed(unit, number):
        path = tmp_path / f"{number}.nc"
        with RecordingWriter(path) as writer:
            writer.declare("Shaft torque", unit=unit, rate_hz=1000.0, dtype="float64")
            writer.append("Shaft torque", 5.0 + np.sin(np.arange(20_000) / 1000.0))
        return run("inspect", path)

    units = ("mA", "%", "mV/V", "kN m")
    loop, share, bridge, torque = [proposed(unit, number) for number, unit in enumerate(units)]
    gauges = [_map(result)["sensors"]["shaft_torque"] for result in (loop, share, bridge, torque)]
    assert tuple(gauge["unit"] for gauge in gauges) == units
    assert gauges[3]["scale_nm_per_unit"] == 1000.0
    assert "# reading_at_zero =" in loop.output
    assert "[sensors.shaft_torque.shaft]: diameters" in bridge.output


def test_a_channel_without_numbers_is_no_sensor(run, tmp_path):
    """Control units send fields that they do not know; the next one that shows the same is proposed."""
    path = tmp_path / "foreign.nc"
    seconds = np.arange(1000) / 50.0
    with RecordingWriter(path) as writer:
        channels = {"Load": np.full(1000, np.nan), "Trim tabs": np.sin(seconds), "Rack": 40.0 + np.sin(seconds)}
        for name, values in channels.items():
            writer.declare(name, unit="%", rate_hz=50.0, dtype="float64")
            writer.append(name, values)
    result = run("inspect", path)
    assert _map(result)["sensors"] == {"rack": {"channel": "Rack", "unit": "%", "cycle_s": 0.02}}
    assert "# 'Load': it holds no numbers" in result.output


def test_names_go_before_units(run, tmp_path):
    # a lever in % at a rate of messages is no rack; percent torque that somebody demands is none of the speed
    time = np.arange(400) / 50.0
    channels = {"LeverPosition": ("%", 40.0 + np.sin(time)), "DemandTorque": ("%", 50.0 + np.cos(time))}
    path = tmp_path / "lever.nc"
    with RecordingWriter(path) as writer:
        for name, (unit, values) in channels.items():
            writer.declare(name, unit=unit, rate_hz=50.0, dtype="float64")
            writer.append(name, values)
    found = _map(run("inspect", path))["sensors"]
    assert (found["set_point"]["channel"], found["rack"]["channel"]) == ("LeverPosition", "DemandTorque")


def test_of_several_channels_in_percent_the_rack_is_one_that_is_called_so(run, tmp_path):
    def proposed(*names):
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.nc"
        with RecordingWriter(path) as writer:
            for name in names:
                writer.declare(name, unit="%", rate_hz=10.0, dtype="float64")
                writer.append(name, 40.0 + np.sin(np.arange(400.0)))
        return run("inspect", path)

    sensors = _map(proposed("AF Correction", "Humidity", "Engine load"))["sensors"]
    assert sensors["rack"]["channel"] == "Engine load"
    unnamed = proposed("AF Correction", "Humidity")
    assert "sensors" not in _map(unnamed)
    assert "# [sensors.rack]: of what is in %, 'AF Correction', 'Humidity', no name says it" in unnamed.output


def test_what_alone_is_left_in_milliampere_is_proposed_for_the_set_point(run, tmp_path):
    """A name in another language is none that is known; of two nobody knows which."""

    def proposed(*names):
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.nc"
        with RecordingWriter(path) as writer:
            for name, unit in [("Drehmoment", "kN m"), *((name, "mA") for name in names)]:
                writer.declare(name, unit=unit, rate_hz=10.0, dtype="float64")
                writer.append(name, 8.0 + np.sin(np.arange(400.0)))
        return run("inspect", path)

    result = proposed("Fahrhebel")
    assert _map(result)["sensors"]["set_point"]["channel"] == "Fahrhebel"
    assert "check" not in result.output.partition("[sensors.set_point]")[2].partition("[logger]")[0]
    result = proposed("Maneta")
    assert _map(result)["sensors"]["set_point"]["channel"] == "Maneta"
    assert "# no name says so: nothing else that is not taken is in V or mA; check" in result.output
    assert "# [sensors.set_point]: no channel looks like it" in proposed("AI 3", "AI 4").output
