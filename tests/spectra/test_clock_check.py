"""What the frequencies of sines say of the clock of a channel, and what they do not."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.spectra.lines._clock_check import clock_reasons

CHANNELS = {"the set point": "n_set", "the shaft torque": "M_s"}
# Lines of a quarter of an hour: frequency [Hz], whole periods.
LINES = ((0.1, 8), (0.15, 8), (0.3, 15), (0.5, 20), (0.8, 30), (1.2, 40), (1.8, 60), (2.5, 80))


def _measured(noise, *, ratio=1.0, rng):
    """Return cuts and lines of a set point and a torque whose clock runs by a ratio faster, with that much noise."""
    cuts, lines = [], []
    for (frequency_hz, periods), share in zip(LINES, noise, strict=True):
        rate_hz = 40.0 * frequency_hz
        time_s = np.arange(40 * periods) / rate_hz
        # of an amplitude of 1 in white noise the deviation of a component is std sqrt(2 / samples)
        scatter = share * np.sqrt(time_s.size / 2.0)
        shown = {
            "n_set": np.sin(2.0 * np.pi * frequency_hz * time_s),
            "M_s": np.sin(2.0 * np.pi * frequency_hz * ratio * time_s) + scatter * rng.standard_normal(time_s.size),
        }
        window = SimpleNamespace(line=f"S{len(cuts)}", frequency_hz=frequency_hz, periods=periods)
        cuts.append(SimpleNamespace(window=window, rate_hz=rate_hz, of=shown.__getitem__))
        lines.append(
            SimpleNamespace(
                window=window,
                noise=SimpleNamespace(covariance=np.diag([1e-12, share**2])),
                amplitude=np.ones(2),
                of=lambda values, name: values[["n_set", "M_s"].index(name)],
            )
        )
    return cuts, lines


@pytest.mark.slow
def test_channels_of_one_clock_are_never_in_doubt():
    """Sixty tests, whose fastest lines are as faint as the noise or fainter."""
    rng = np.random.default_rng(8)
    for _ in range(60):
        noise = rng.uniform(0.5, 1.5) * np.array([0.02, 0.01, 0.01, 0.01, 0.02, 0.1, 0.4, 0.9])
        assert clock_reasons(*_measured(noise, rng=rng), channels=CHANNELS) == ()


def test_a_faint_fast_line_on_a_peak_of_the_noise_is_no_clock():
    rng = np.random.default_rng(2)
    cuts, lines = _measured(np.full(8, 0.01), rng=rng)
    # the two lines with most periods, 0.13 % off as a peak of the noise may be, and as certain of it as of themselves
    for k in (6, 7):
        frequency_hz, periods = LINES[k]
        time_s = np.arange(40 * periods) / (40.0 * frequency_hz)
        moved = np.sin(2.0 * np.pi * 1.0013 * frequency_hz * time_s)
        shown = {"n_set": cuts[k].of("n_set"), "M_s": moved}
        cuts[k].of = shown.__getitem__
    assert clock_reasons(cuts, lines, channels=CHANNELS) == ()


@pytest.mark.parametrize("ratio", [1.005, 0.998])
def test_a_clock_of_its_own_is_named(ratio):
    noise = np.array([0.02, 0.01, 0.01, 0.01, 0.02, 0.1, 0.4, 0.9])
    (reason,) = clock_reasons(*_measured(noise, ratio=ratio, rng=np.random.default_rng(4)), channels=CHANNELS)
    assert (reason.kind, reason.where) == ("channel clock", "the shaft torque")
    stated = float(re.search(r"run ([+-][\d.]+) %", reason.sentence).group(1))
    assert stated == pytest.approx(100.0 * (ratio - 1.0), abs=0.03)
