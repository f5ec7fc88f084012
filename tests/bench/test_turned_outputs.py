"""An output that counts the other way round than its structure: told by its channel, and turned by the drive file."""

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
