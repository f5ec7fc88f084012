"""What the report says of loggers that were merged, about clocks that are written down by hand."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.clocks import Alignment, ClockMap, LoggerClock, Stretch, clock_attributes
from shaftprint.errors import RecordingError
from shaftprint.fingerprint import ClockInfluence
from shaftprint.report import render_report
from shaftprint.report.sections._clocks import clock_sentences
from shaftprint.tables._recording import clock_map_table

# 1 ms, 2 ppm and a correlation of -0.5
LINE = ClockMap(offset_s=0.4, drift=30e-6, middle_s=430.0, covariance=np.array([[1e-6, -1e-9], [-1e-9, 4e-12]]))
FOUND = Alignment(
    map=LINE,
    # at 5 s 1e-6 + 2 * 1e-9 * 425 + 4e-12 * 425^2 = 2.5725e-6
    span_s=(5.0, 430.0),
    stretches=(Stretch(time_s=35.0, offset_s=0.39, std_s=0.001), Stretch(time_s=95.0, offset_s=0.39, std_s=0.001)),
    scatter=1.05,
)
SHAFT = LoggerClock(
    logger="shaft.nc",
    sha256="12" * 32,
    reference="bridge.nc",
    reference_sha256="34" * 32,
    channels=("PTM_1", "M_s"),
    alignment=FOUND,
)
ENGINE = replace(
    SHAFT,
    logger="engine.nc",
    channels=("X",),
    alignment=Alignment(
        map=ClockMap(offset_s=-12.25, drift=-80e-6, middle_s=0.0, covariance=np.diag([1e-8, 4e-12])), span_s=(0.0, 9.0)
    ),
)
NONE = ClockInfluence(
    logger="shaft.nc", std_s=1.6e-3, moved=(), line="S9", frequency_hz=2.0, phase_rad=0.0, delay_std_s=np.inf
)


def test_one_row_a_logger():
    assert clock_map_table([]).rows == ()
    first, second = clock_map_table([SHAFT, ENGINE]).rows
    assert first == ("shaft.nc", "PTM_1, M_s", "400.0 ± 1.0", "430.0", "30.0 ± 2.0", "−0.50", "1.6", "2", "1.05")
    offset = "−12\u202f250.00 ± 0.10"
    assert second == ("engine.nc", "X", offset, "0.0", "−80.0 ± 2.0", "0.00", "0.10", "0", "–")


def test_words_say_who_was_behind_and_how_well_that_is_known():
    words = clock_sentences(SHAFT, NONE)
    assert words.startswith(
        "PTM_1 and M_s were logged by shaft.nc, whose clock was 400.0 ± 1.0 ms behind that of bridge"
    )
    assert "at 430 s and ran 30.0 ± 2.0 ppm slow. The 2 minutes that were compared scatter 1.05" in words
    assert "known worse than to 1.6 ms" in words
    assert words.endswith(
        "The result does not depend on it: it moves none of set point, speed and torque against the others."
    )
    words = clock_sentences(ENGINE, NONE)
    assert words.startswith("X was logged by engine.nc")
    assert "ms ahead of that of bridge.nc at 0 s" in words
    assert "ppm fast. This was given, not found" in words
    short = replace(SHAFT, alignment=replace(FOUND, stretches=FOUND.stretches[:1]))
    assert "ppm slow. One stretch was compared; nowhere in" in clock_sentences(short, NONE)
    words = clock_sentences(replace(SHAFT, alignment=replace(FOUND, scatter=3.2)), NONE)
    assert (
        "3.20 times as far as their noise explains: the clock did not run evenly. Widened by as much, nowhere" in words
    )


def test_words_say_what_it_does_to_the_result():
    # 0.02 rad are 1.146 degrees; 1.6 ms of 4 ms are 0.4
    bad = replace(NONE, moved=("n", "M_s"), phase_rad=0.02, delay_std_s=4e-3)
    words = clock_sentences(SHAFT, bad)
    assert "turns the phase of n and M_s over the set point by 1.1° at S9 (2.00 Hz), the highest line" in words
    assert "determine such a delay to 4.0 ms, so that it moves no parameter by more than 0.40 of its standard" in words
    assert words.endswith("The standard deviations of this report do not hold it and are too small.")
    assert clock_sentences(SHAFT, replace(bad, std_s=1e-4)).endswith(
        "The standard deviations of this report do not hold it."
    )


@pytest.mark.slow
def test_a_report_of_a_merged_recording_shows_its_maps(tmp_path, survey, recording):
    held = replace(SHAFT, channels=("M_s",))
    merged = replace(recording, attributes=clock_attributes([held]))
    text = render_report(tmp_path / "merged", survey, recording=merged).read_text(encoding="utf-8")
    quality = text[text.index('id="quality"') :].partition("</section>")[0]
    assert "was logged by shaft.nc, whose clock was 400.0 ± 1.0 ms behind that of bridge.nc at 430" in quality
    assert "Clock maps of the other loggers" in quality
    assert ">30.0 ± 2.0<" in quality
    assert "of its standard deviation" in quality
    for sha256 in (SHAFT.sha256, SHAFT.reference_sha256):
        assert sha256 in text
    broken = replace(recording, attributes={"clock_maps": "[{}]"})
    with pytest.raises(RecordingError, match="attribute clock_maps"):
        render_report(tmp_path / "broken", survey, recording=broken)
    assert not (tmp_path / "broken").exists()
