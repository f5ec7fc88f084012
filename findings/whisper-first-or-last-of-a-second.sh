#!/usr/bin/env bash
# About: whisper 1.1.10, the files of Graphite
# Guess: two samples in one slot of a second are averaged, as "aggregationMethod" says; writing one by one or at once is the same; what is fetched from a time on begins with it.
# What happens: written one by one the last of a slot stays, written at once (update_many) the first: two records of one log. The slot at the first time asked for is left out.
. "$(dirname "$0")/_setup.sh"
packages whisper==1.1.10
run <<'PY'
import time

import whisper
from find import seen

now = int(time.time()) // 10 * 10
start = now - 30
samples = [(start + number / 2, 1500.0 + number) for number in range(8)]


def stored(name, write):
    whisper.create(name, [(1, 60)], aggregationMethod="average")
    write(name)
    (begin, _, _), values = whisper.fetch(name, start, start + 3, now=now)
    return begin - start, values


def one_by_one(name):
    for stamp, value in samples:
        whisper.update(name, value, stamp, now=now)


last = stored("one.wsp", one_by_one)
first = stored("many.wsp", lambda name: whisper.update_many(name, samples, now=now))
seen(f"written: 0 s {samples[0][1]}, 0.5 s {samples[1][1]}, ... 3.5 s {samples[-1][1]}", True)
seen(f"one by one, from 0 s on: begins at {last[0]} s, {last[1]}", last == (1, [1503.0, 1505.0, 1507.0]))
seen(f"at once, from 0 s on:    begins at {first[0]} s, {first[1]}", first == (1, [1502.0, 1504.0, 1506.0]))
PY
