"""Records that are meant otherwise: an output that counts the other way round, a thousandth of a unit, times in ms."""

import numpy as np
import pytest
from tests.bench.drawn_lags import LAG_TOML, identified, lag, levels, written

from shaftprint.errors import IdentificationError

INTERVAL = 0.05


def columns(sign, noise):
    """A lag with a gain of 100, counted either way, with noise beside it."""
    rng = np.random.default_rng(4)
    inputs = levels(rng, 240, 16)
    output = lag(inputs, INTERVAL, hold=True)
    return {"u": inputs, "y": sign * output + noise * output.std() * rng.standard_normal(output.size)}


def test_it_is_told_with_its_channel_and_what_turns_it(tmp_path):
    path = written(tmp_path, "turned", columns(-1.0, 0.01), INTERVAL)
    with pytest.raises(IdentificationError, match=r'channel "y": .* 100 % .* other way round.*reversed = true for y'):
        identified(tmp_path, path, text=LAG_TOML + "inputs_hold = true\n")


def test_the_drive_file_turns_it(tmp_path):
    path = written(tmp_path, "turned", columns(-1.0, 0.01), INTERVAL)
    text = LAG_TOML.replace("[[outputs]]\n", "[[outputs]]\nreversed = true\n")
    found = identified(tmp_path, path, text=f"{text}inputs_hold = true\n")
    gain = next(one for one in found.identification.parameters if one.name == "K")
    assert gain.value == pytest.approx(100.0, rel=0.02)
    right = written(tmp_path, "right", columns(1.0, 0.01), INTERVAL)
    with pytest.raises(IdentificationError, match="reversed = false for y"):
        identified(tmp_path, right, text=f"{text}inputs_hold = true\n")


def test_noise_that_hides_most_of_an_output_turns_nothing(tmp_path):
    path = written(tmp_path, "noisy", columns(1.0, 2.0), INTERVAL)
    found = identified(tmp_path, path, text=LAG_TOML + "inputs_hold = true\n")
    gain = next(one for one in found.identification.parameters if one.name == "K")
    assert abs(gain.value - 100.0) < 4.0 * gain.std


@pytest.mark.parametrize(("name", "factor"), [("y", 1e3), ("y", 1e-3), ("u", 1e3)])
def test_a_channel_in_a_thousandth_of_its_unit_is_told(tmp_path, name, factor):
    """The gain of 100 is then beyond its bounds, 1 to 1000; the factor is that of one value."""
    read = columns(1.0, 0.01)
    read[name] = factor * read[name]
    path = written(tmp_path, "scaled", read, INTERVAL)
    # a thousandth of the input explains as much as a thousand of the output: both are told
    output = 1.0 / factor if name == "y" else factor
    told = rf"explains \d+ % of .* values are {1.0 / output:g} V each"
    told = rf"(?=.*{told})(?=.*values are {output:g} rad/s each)"
    with pytest.raises(IdentificationError, match=told):
        identified(tmp_path, path, text=LAG_TOML + "inputs_hold = true\n")


def test_times_in_milliseconds_are_told(tmp_path):
    """Of 0.3 s are 300, beyond the bound of 10; samples are 50 s apart."""
    path = written(tmp_path, "times", columns(1.0, 0.01), 1e3 * INTERVAL)
    # without a unit it is asked for
    path.write_text(path.read_text(encoding="utf-8").replace("time", "time [s]", 1), encoding="utf-8")
    told = r"times: .* explains \d+ % of the records where they count 0.001 s each, .* --sample-rate 20\."
    with pytest.raises(IdentificationError, match=told):
        identified(tmp_path, path, text=LAG_TOML + "inputs_hold = true\n")
