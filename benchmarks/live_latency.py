"""How long an abort takes from the block that shows it to the device, over OPC UA with the server in another process.

``python -m benchmarks.live_latency --count 30``. Both processes read the same monotonic clock of the computer; the load
is whatever else runs, and is printed.
"""

import argparse
import asyncio
import json
import logging
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from tests.live.rehearsed import ENVELOPE, VESSEL

from benchmarks.live_rehearsals import campaign, run_beside
from shaftprint.live._engine import LiveTest
from shaftprint.live._outcome import Operator
from shaftprint.live._record import LiveRecord
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._opcua import OpcUaCounterpart

ADDRESS = "opc.tcp://127.0.0.1:48478"


async def aborted(folder, number, rng):
    """Abort one test at a random block; return when the block was there [s], by the monotonic clock."""
    counterpart = OpcUaCounterpart(ADDRESS, access=Access(is_insecure=True))
    await counterpart.connect()
    record = LiveRecord(folder / f"{number}.nc", counterpart.channels, {})
    operator, seen, after_s = Operator(), [], float(rng.uniform(0.2, 3.0))

    def shown(test, sight):
        if test.is_ruling and test.campaign_s > after_s and not operator.stops:
            operator.stops = "measured"
            seen.append(sight.block.received_s)

    test = LiveTest(
        counterpart=counterpart,
        vessel=VESSEL,
        campaign=campaign(),
        envelope=ENVELOPE,
        record=record,
        operator=operator,
        alive_s=1.0,
        shown=shown,
    )
    outcome = await test.run()
    record.close()
    await counterpart.close()
    if not seen:
        print(f"{number}: {outcome.word}, {outcome.reason}", flush=True)
    return (seen[0], outcome.is_back) if seen else None


def heard(server):
    """Return when the device heard the next abort [s]."""
    while True:
        said = json.loads(server.stdout.readline())
        if said.get("word") == "Abort":
            return said["at_s"]


def main():
    """Measure, and print the table."""
    logging.disable(logging.CRITICAL)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=30)
    asked = parser.parse_args()
    rng = np.random.default_rng(1)
    server = run_beside("--serve", ADDRESS, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    server.stdout.readline()
    took_ms, back, refused = [], 0, 0
    try:
        with tempfile.TemporaryDirectory() as folder:
            for number in range(asked.count):
                found = asyncio.run(aborted(Path(folder), number, rng))
                if found is None:
                    refused += 1
                    continue
                took_ms.append(1000.0 * (heard(server) - found[0]))
                back += found[1]
    finally:
        server.kill()
        server.wait()
    p50, p99 = np.percentile(took_ms, [50, 99])
    print(f"{len(took_ms)} aborts, {refused} refused before, load {os.getloadavg()[0]:.1f}")
    print(f"block to device [ms]: p50 {p50:.1f}, p99 {p99:.1f}, longest {max(took_ms):.1f}; lever seen again {back}")


if __name__ == "__main__":
    main()
