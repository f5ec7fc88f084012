#!/usr/bin/env bash
# About: python-can 4.6.1, MessageSync, with which can_player and every replay of a log send at the times of the log
# Guess: replayed, a log takes as long as it did: a pause of 100 s between two messages is 100 s. One whose stamp goes back is sent at once.
# What happens: a pause of more than 60 s (skip=60) is 60 s, without a word, and all behind it is 40 s early by the clock of the log; a test that is timed against the replay shifts.
#   The clock of the program is replaced here, so that nothing waits.
. "$(dirname "$0")/_setup.sh"
packages python-can==4.6.1
run <<'PY'
import can
import can.io.player as player
from find import seen


class Clock:
    now = 1000.0

    def perf_counter(self):
        return self.now

    def sleep(self, seconds):
        self.now += max(seconds, 1e-4)


clock = Clock()
player.time = clock
stamps = (0.0, 0.2, 59.0, 159.0, 159.2, 159.1, 160.0)
messages = [can.Message(timestamp=stamp, arbitration_id=1, data=[number]) for number, stamp in enumerate(stamps)]
sent = [round(clock.now - 1000.0, 1) for _ in can.MessageSync(messages)]
print("stamps", list(stamps))
seen(f"sent   {sent}", sent == [0.0, 0.2, 59.0, 119.0, 119.2, 119.2, 120.0])
clock.now = 1000.0
sent = [round(clock.now - 1000.0, 1) for _ in can.MessageSync(messages, skip=1000)]
seen(f"with skip=1000 {sent}", sent == [0.0, 0.2, 59.0, 159.0, 159.2, 159.2, 160.0])
PY
