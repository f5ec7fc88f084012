"""Rehearsals of a live test with random faults: is the envelope kept, does anything hang, is every reason named.

``python -m benchmarks.live_rehearsals --count 200``; with ``--kills 50`` the program that plays against a server is
killed at random points, with ``--stops 50`` stopped with its link open, and with ``--lost 100`` blocks are lost at
random and counted by what is said of them.
"""

import argparse
import asyncio
import json
import logging
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.live.rehearsed import ENVELOPE, TUG, VESSEL, leg

import shaftprint as sp
from shaftprint.live._block import DeviceMode
from shaftprint.live._engine import LiveTest
from shaftprint.live._envelope import SPEED, TORQUE
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._faults import LinkFaults, Spell
from shaftprint.live.counterparts._opcua import OpcUaCounterpart
from shaftprint.live.counterparts._opcua_server import SimulatedServer
from shaftprint.live.counterparts._simulated import SimulatedCounterpart

# A limit may last this long before a rule has seen it, and the ramp back takes its time [s].
SEEN_S = 0.5
HANGS_S = 120.0


def campaign():
    """Two legs of three periods at two speeds."""
    first = 3.0 + 1.0 + 3 * 2.0 + 0.1
    second = first + 3.0 + 1.0 + 3 * 2.0 + 0.1
    legs = (
        leg("M1", level_v=-5.0, start_s=3.0, settled_s=4.0, stop_s=first, period_s=2.0),
        leg("M2", level_v=-4.6, start_s=first + 3.0, settled_s=first + 4.0, stop_s=second, period_s=2.0),
    )
    content = {"name": "two legs", "duration_s": second + 4.0, "offset_v": -5.0, "ramp_s": 2.0}
    return sp.campaign.Campaign.model_validate({**content, "multisines": legs})


def drawn(rng):
    """Return a fault, and a ship that may be unsound."""
    at = Spell(start_s=float(rng.uniform(1.0, 40.0)))
    short = Spell(start_s=at.start_s, stop_s=at.start_s + float(rng.uniform(0.1, 3.0)))
    kinds = {
        "none": {},
        "frozen": {"frozen": short},
        "silent": {"silent": at},
        "stale": {"stale": short},
        "not a number": {"not_a_number": short},
        "stuck": {"stuck_set_point": at},
        "deaf": {"deaf": short},
        "lost": {"lost": tuple(int(k) for k in rng.choice(900, size=int(rng.integers(1, 20))))},
        "doubled": {"doubled": tuple(int(k) for k in rng.choice(900, size=3))},
        "clock": {"clock_step_at_s": at.start_s, "clock_step_s": float(rng.normal(0.0, 1.0))},
        "late revert": {"revert_s": float(rng.uniform(0.7, 5.0))},
        "no abort": {"ignores_abort": True, "stuck_set_point": at},
        "torque limit": {},
        "near unstable": {},
    }
    name = str(rng.choice(list(kinds)))
    tug, envelope = TUG, ENVELOPE
    if name == "near unstable":
        tug = replace(TUG, proportional_gain=float(rng.uniform(7.0, 12.0)))
    if name == "torque limit":
        high = float(rng.uniform(1700.0, 2300.0))
        bounds = tuple(replace(one, highest=high) if one.quantity == TORQUE else one for one in ENVELOPE.bounds)
        envelope = replace(ENVELOPE, bounds=bounds)
    return name, LinkFaults(**kinds[name]), tug, envelope


def violations(ship, envelope):
    """Return how often the true ship was beyond a bound for longer than its persistence and the time to see it."""
    trace = np.array([row[:4] for row in ship.trace])
    ruled = np.array([row[4] != DeviceMode.LEVER for row in ship.trace])
    found = 0
    for quantity, column in ((SPEED, 2), (TORQUE, 3)):
        bound = envelope.bound_of(quantity)
        # a bound is of the mean over a turn of the shaft; the ramp back of an abort takes two seconds more
        smooth = np.convolve(trace[:, column], np.ones(4) / 4.0, mode="same")
        beyond = ruled & ((smooth < bound.lowest) | (smooth > bound.highest))
        ends = np.flatnonzero(np.diff(np.concatenate([[0], beyond.astype(int), [0]])))
        longest_s = ship.span_s * max(
            (stop - start for start, stop in zip(ends[::2], ends[1::2], strict=True)), default=0
        )
        found += longest_s > bound.persistence_s + SEEN_S + 2.0
    return found


def rehearsal(seed, folder):
    """Return what came out of one."""
    rng = np.random.default_rng(seed)
    name, faults, tug, envelope = drawn(rng)
    ship = simulated_ship_of(VESSEL, campaign(), seed=seed, faults=faults, tug=tug)
    counterpart = SimulatedCounterpart(ship)
    record = LiveRecord(folder / f"{seed}.nc", counterpart.channels, {})
    test = LiveTest(
        counterpart=counterpart,
        vessel=VESSEL,
        campaign=campaign(),
        envelope=envelope,
        record=record,
        slope_rpm_per_v=TUG.set_point_slope_rpm_per_v,
    )
    begun = time.monotonic()
    outcome = asyncio.run(asyncio.wait_for(test.run(), HANGS_S))
    record.close()
    # what the ship does when nobody looks any more
    for _ in range(60):
        ship.sail()
    readable = True
    with sp.recording.read_recording(record.journal_path) as recording:
        readable = recording.channel("M_s").count > 0
    record.journal_path.unlink()
    breach = "" if outcome.breach is None else str(outcome.breach.rule)
    return {
        "seed": seed,
        "fault": name,
        "word": outcome.word,
        "rule": breach,
        "reason": outcome.reason,
        "violations": int(violations(ship, envelope)),
        "lever": ship.device.mode == DeviceMode.LEVER,
        "readable": readable,
        "took_s": time.monotonic() - begun,
    }


def rehearsals(count, first, kept):
    """Play many, and keep each outcome as it comes."""
    done = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    known = {one["seed"] for one in done}
    with tempfile.TemporaryDirectory() as folder, kept.open("a") as file:
        for seed in range(first, first + count):
            if seed in known:
                continue
            try:
                one = rehearsal(seed, Path(folder))
            except TimeoutError:
                one = {
                    "seed": seed,
                    "fault": "?",
                    "word": "HUNG",
                    "rule": "",
                    "reason": "",
                    "violations": 0,
                    "lever": 0,
                }
            done.append(one)
            file.write(json.dumps(one) + "\n")
            file.flush()
    return done


def show(done):
    """Print the table."""
    print(f"{len(done)} rehearsals")
    for name in sorted({one["fault"] for one in done}):
        rows = [one for one in done if one["fault"] == name]
        words = Counter(f"{one['word']} {one['rule']}".strip() for one in rows)
        print(f"  {name:14} {len(rows):3}  {', '.join(f'{count} {word}' for word, count in words.most_common())}")
    print("violations of the envelope", sum(one["violations"] for one in done))
    print("hangs", sum(one["word"] == "HUNG" for one in done))
    print("lever at the end", sum(bool(one["lever"]) for one in done))
    print("without a reason", sum(one["word"] != "played" and not one["reason"] for one in done))


def lost_blocks(count):
    """Lose blocks at random, and compare with what is said of them."""
    right = 0
    for seed in range(count):
        rng = np.random.default_rng(seed)
        # after the channels were seen alive and before the end at 38 s, in rows of up to four
        lost = {
            int(k)
            for start in rng.choice(np.arange(300, 700), size=3)
            for k in range(start, start + int(rng.integers(1, 5)))
        }
        ship = simulated_ship_of(VESSEL, campaign(), seed=seed, faults=LinkFaults(lost=tuple(lost)), tug=TUG)
        counterpart = SimulatedCounterpart(ship)
        with tempfile.TemporaryDirectory() as folder:
            record = LiveRecord(Path(folder) / "t.nc", counterpart.channels, {})
            test = LiveTest(
                counterpart=counterpart, vessel=VESSEL, campaign=campaign(), envelope=ENVELOPE, record=record
            )
            outcome = asyncio.run(test.run())
            record.close()
            with sp.recording.read_recording(record.journal_path) as recording:
                torque = recording.channel("M_s")
                gaps = np.isnan(torque.values(0, torque.count)).reshape(-1, 100).all(axis=1)
        named = sum(int(one.sentence.split()[0]) for one in test.record.events if one.kind == "lost")
        missing = {int(k) + 1 for k in np.flatnonzero(gaps)}
        is_right = outcome.word == "played" and named == len(lost) and missing == lost
        right += is_right
        if not is_right:
            print(
                f"  {seed}: {outcome.word} {outcome.reason} lost {sorted(lost)}, named {named}, gaps {sorted(missing)}"
            )
    print(f"lost blocks named and left as gaps: {right} of {count} runs")


async def _serve(address):
    ship = simulated_ship_of(VESSEL, campaign(), seed=1, faults=LinkFaults(), tug=TUG)
    ship.sail()
    async with SimulatedServer(ship, address) as server:
        print("ready", flush=True)
        while True:
            await asyncio.sleep(0.02)
            for word, at_s in server.heard:
                print(json.dumps({"word": word, "at_s": at_s, "mode": ship.device.mode}), flush=True)
            server.heard.clear()
            if ship.trace:
                print(json.dumps({"mode": ship.device.mode, "time_s": asyncio.get_running_loop().time()}), flush=True)


async def _play(address, path):
    counterpart = OpcUaCounterpart(address, access=Access(is_insecure=True))
    await counterpart.connect()
    record = LiveRecord(Path(path), counterpart.channels, {})
    test = LiveTest(
        counterpart=counterpart, vessel=VESSEL, campaign=campaign(), envelope=ENVELOPE, record=record, alive_s=1.0
    )
    print("begun", flush=True)
    outcome = await test.run()
    print(outcome.word, outcome.reason, flush=True)
    await counterpart.close()


def run_beside(*arguments, **options):
    """Start this benchmark in another process."""
    return subprocess.Popen([sys.executable, "-m", "benchmarks.live_rehearsals", *arguments], text=True, **options)


def kills(count, *, stops=False):
    """Kill the program that plays, at random points: when the lever rules again, and whether the journal reads.

    ``stops``: it is stopped while it rules, and its link stays open: the heartbeat alone is missing.
    """
    address, rng = f"opc.tcp://127.0.0.1:{48478 if stops else 48477}", np.random.default_rng(1)
    what, first_s = ("heartbeats stopped", 5.0) if stops else ("kills", 0.5)
    took, readable = [], 0
    with tempfile.TemporaryDirectory() as folder:
        # a file: a pipe that nobody empties stops who writes into it
        with (Path(folder) / "said").open("w") as says:
            server = run_beside("--serve", address, stdout=says, stderr=subprocess.DEVNULL)
        said = (Path(folder) / "said").open()
        try:
            while not _lines(said):
                time.sleep(0.5)
            while len(took) < count:
                path = Path(folder) / f"{rng.integers(10**12)}.nc"
                player = run_beside("--play", address, str(path), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                player.stdout.readline()
                # alive 1 s, revert 2 s, taken over, then two legs
                time.sleep(rng.uniform(first_s, 14.0))
                _lines(said)
                os.kill(player.pid, signal.SIGSTOP if stops else signal.SIGKILL)
                after_s = _until_lever(said, time.monotonic())
                player.kill()
                player.wait()
                player.stdout.close()
                if stops and not after_s:
                    print("it did not rule yet", flush=True)
                    continue
                took.append(after_s)
                journal = path.with_name(path.name + ".journal")
                is_there = journal.exists()
                if is_there:
                    with sp.recording.read_recording(journal) as recording:
                        is_there = recording.channel("M_s").count > 0
                readable += is_there
                print(f"{len(took)}: lever after {after_s:.2f} s, journal {'reads' if is_there else 'not'}", flush=True)
        finally:
            server.kill()
            server.wait()
            said.close()
    ruled = sum(one > 0.0 for one in took)
    print(f"{count} {what}, {ruled} while it ruled: lever after at most {max(took):.2f} s; journals read: {readable}")


def _lines(said):
    """Return what a server has said since the last time."""
    return [json.loads(line) for line in said.read().splitlines() if line.startswith("{")]


def _until_lever(said, killed):
    """Return how long after a kill the lever ruled [s]; 0 where it did already."""
    last = 0.0
    while time.monotonic() - killed < 5.0:
        time.sleep(0.1)
        for one in _lines(said):
            if one.get("time_s", 0.0) < killed:
                continue
            if one["mode"] == DeviceMode.LEVER:
                return last
            last = one["time_s"] - killed
    return math.inf


def main():
    """Run what was asked for."""
    logging.disable(logging.CRITICAL)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--kept", type=Path, default=Path("build/live_rehearsals.jsonl"))
    parser.add_argument("--lost", type=int, default=0)
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--stops", type=int, default=0)
    parser.add_argument("--serve")
    parser.add_argument("--play", nargs=2)
    asked = parser.parse_args()
    if asked.serve:
        asyncio.run(_serve(asked.serve))
    elif asked.play:
        asyncio.run(_play(*asked.play))
    else:
        asked.kept.parent.mkdir(parents=True, exist_ok=True)
        if asked.count:
            show(rehearsals(asked.count, asked.first, asked.kept))
        if asked.lost:
            lost_blocks(asked.lost)
        if asked.kills:
            kills(asked.kills)
        if asked.stops:
            kills(asked.stops, stops=True)


if __name__ == "__main__":
    main()
