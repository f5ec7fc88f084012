"""The clock of a log of messages, which come early or late: each counts at its own stamp, the first as any other."""

import numpy as np
import pytest
from tests.clocks.test_align import RATE_HZ, speed_of_a_test

from shaftprint.clocks import align
from shaftprint.errors import SignalError
from shaftprint.recording import Channel
from shaftprint.signals import Content, content_of

DURATION_S, OFFSET_S, PERIOD_S = 600.0, 2.0, 0.02


def messages(speed, *, jitter_s, first_late_s, sender_ppm, seed):
    """Return messages of a sender whose stamps tremble, with the logger's clock OFFSET_S behind the reference."""
    rng = np.random.default_rng(seed)
    sent_s = np.arange(round(0.9 * DURATION_S / PERIOD_S)) * PERIOD_S * (1.0 + 1e-6 * sender_ppm)
    stamps_s = 3.0 + sent_s + rng.uniform(-jitter_s, jitter_s, sent_s.size)
    stamps_s[0] = 3.0 + first_late_s
    values = speed(stamps_s + OFFSET_S)
    return Channel(
        name="EngineSpeed", unit="rpm", rate_hz=1.0 / (PERIOD_S * (1.0 + 1e-6 * sender_ppm)),
        start_s=float(stamps_s[0]), count=sent_s.size, source=lambda start, stop: values[start:stop],
        stamps=lambda start, stop: stamps_s[start:stop],
    )  # fmt: skip


@pytest.mark.parametrize(
    ("first_late_s", "sender_ppm", "seed"), [(0.002, 50.0, 3), (-0.002, -50.0, 11), (0.0015, 0.0, 12)]
)
def test_jitter_of_the_first_message_does_not_move_the_log(first_late_s, sender_ppm, seed):
    speed = speed_of_a_test(DURATION_S, seed=seed)
    time_s = np.arange(0.0, DURATION_S, 1.0 / RATE_HZ)
    rng = np.random.default_rng(seed)
    reference = Content(
        name="n", start_s=0.0, rate_hz=RATE_HZ, values=speed(time_s) + 2e-4 * rng.standard_normal(time_s.size)
    )
    channel = messages(speed, jitter_s=0.002, first_late_s=first_late_s, sender_ppm=sender_ppm, seed=seed)
    clock = align(content_of(channel, rate_hz=RATE_HZ), reference).map
    stamps_s = channel.stamps_s(0, channel.count)
    errors_s = clock.reference_s(stamps_s) - (stamps_s + OFFSET_S)
    assert np.abs(errors_s).max() < 1e-4
    assert np.all(np.abs(errors_s) < 4.0 * clock.std_s(stamps_s))
    # both logs have one clock, whatever the senders' do
    assert abs(clock.drift) < 4.0 * np.sqrt(clock.covariance[1, 1])


def test_messages_without_a_number_are_refused():
    channel = messages(lambda at: np.full(at.size, np.nan), jitter_s=0.002, first_late_s=0.0, sender_ppm=0.0, seed=1)
    with pytest.raises(SignalError, match="channel EngineSpeed: expected samples, found none"):
        content_of(channel, rate_hz=RATE_HZ)
