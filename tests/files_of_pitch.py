"""Vessel and campaign file of a tug with controllable pitch, made of the shipped ones."""

import re
from importlib.resources import files

SENSORS = """
[sensors.ship_speed]
channel = "v_s"
unit = "m/s"
cycle_s = 0.2
resolution = 0.005
latency_s = 0.3

[sensors.pitch_set_point]
channel = "U_pitch"
unit = "V"
pitch_ratio_per_v = 0.14
pitch_ratio_at_zero_v = 0.41
"""
FREQUENCIES_HZ = (0.01, 0.02, 0.035, 0.06, 0.1, 0.16, 0.25, 0.4)


def write_pitch_files(folder):
    """Write both files and return their paths; the pitch stands at 5 V, P/D 1.11, and moves by 3 % of it."""
    vessel, campaign = folder / "cpp.toml", folder / "pitch.toml"
    vessel.write_text((files("shaftprint.vessel") / "shipped" / "stan_tug_1205.toml").read_text() + SENSORS)
    text = (files("shaftprint.campaign") / "shipped" / "transit.toml").read_text()
    start_s, sines = float(re.search(r"^duration_s = (.*)$", text, re.M)[1]), ""
    for number, frequency_hz in enumerate(FREQUENCIES_HZ, start=1):
        length_s = max(round(3.0 / frequency_hz), 100)
        sines += f"""
[[sines]]
name = "P{number}"
input = "pitch_set_point"
frequency_hz = {frequency_hz}
amplitude_v = 0.24
start_s = {start_s}
settled_s = {start_s + 20.0}
stop_s = {start_s + 20.0 + length_s}
"""
        start_s += length_s + 25.0
    text = re.sub(
        r"^duration_s = .*$",
        f"duration_s = {start_s}\nfurther_offsets_v = {{ pitch_set_point = 5.0 }}",
        text,
        flags=re.M,
    )
    campaign.write_text(text + sines)
    return vessel, campaign
