"""One test, written as each logger would write it, and the fingerprint from each.

The simulated Stan Tug 1205 sails the shipped campaign ``short`` once. Its recording is written in each format that
`shaftprint sail` writes, identified from there, and each number is held against that from the native container: how far
it lies off, in the deviations that the fit states. Two recordings are sailed: that of a logger that samples voltages at
2000 Hz, and that of a CAN bus on which torque comes every 10 ms, speed and demand every 20 ms, with 15 % of jitter and
one in a hundred lost. ``python -m benchmarks.written_logs --outcomes FOLDER --write`` makes the table of the page on
formats; what the folder holds is not done again.
"""

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.can_log import ALL_MESSAGES, CYCLE_S, JITTER, LOST, TORQUE_CYCLE_S
from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import load_campaign
from shaftprint.errors import ShaftprintError
from shaftprint.recording import read_recording, write_by_ending
from shaftprint.survey import run
from shaftprint.tug import Noise, Tug, sail
from shaftprint.tug._in_messages import in_messages
from shaftprint.vessel import Vessel, load_vessel

ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs" / "formats.md"
BEGIN, END = "<!-- table of benchmarks/written_logs.py: begin -->", "<!-- table of benchmarks/written_logs.py: end -->"
CAMPAIGN, SEED = load_campaign("short"), 23
# What the order of a sum changes is no difference.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class Test:
    """A recording that is sailed."""

    name: str
    """What it is."""
    vessel: Vessel
    """What the vessel file says."""
    tug: Tug
    """Who sails."""
    forms: Sequence[tuple[str, str]]
    """Name of each format, and ending."""


TESTS: Mapping[str, Test] = {
    "logger": Test(
        name="Voltages at 2000 Hz",
        vessel=load_vessel("stan-tug-1205"),
        tug=Tug(),
        forms=(
            ("native", ".nc"),
            ("nmea2000", ".blf"),
            ("tdms-appended", ".tdms"),
            ("uff", ".uff"),
            ("lvm", ".lvm"),
            ("can", ".blf"),
            ("can", ".asc"),
            ("can", ".log"),
        ),
    ),
    "bus": Test(
        name="Messages of a bus",
        vessel=ALL_MESSAGES,
        tug=in_messages(
            # a log of 10 Hz would not show one, and keep a line that the others lose
            Tug(noise=Noise(torque_dropout_interval_s=0.0)),
            ALL_MESSAGES,
            rates_hz={"torque": 1.0 / TORQUE_CYCLE_S, "speed": 1.0 / CYCLE_S, "set-point": 1.0 / CYCLE_S},
            jitter=JITTER,
            lost=LOST,
        ),
        forms=(
            ("native", ".nc"),
            ("mdf4", ".mf4"),
            ("lvm", ".lvm"),
            ("uff", ".uff"),
            ("can", ".blf"),
            ("can", ".asc"),
            ("can", ".log"),
            ("nmea2000", ".blf"),
        ),
    ),
}


def sailed(test: Test, folder: Path) -> Path:
    """Return the native recording of a test, which is sailed where it is not there."""
    path = folder / "sailed.nc"
    if not path.exists():
        sail(test.vessel, CAMPAIGN, path, tug=test.tug, seed=SEED)
    return path


def outcome(test: Test, native: Path, form: tuple[str, str]) -> dict[str, Any]:
    """Write a recording in a form and identify it from there: values and deviations by name, or why not."""
    name, ending = form
    with tempfile.TemporaryDirectory(dir=native.parent) as folder:
        path = Path(folder) / f"test{ending}"
        with read_recording(native) as recording:
            remarks = write_by_ending(path, recording.channels.values(), format=name)
        beside = path.with_name(f"{path.name}.dbc")
        megabytes = path.stat().st_size / 1e6
        try:
            survey = run(
                path,
                test.vessel,
                CAMPAIGN,
                rng=np.random.default_rng(SEED),
                judge=False,
                hints={"dbc": beside} if beside.exists() else {},
            )
        except ShaftprintError as error:
            return {"remarks": remarks, "megabytes": megabytes, "refused": str(error).replace(str(path), path.name)}
    fit = survey.fits[0]
    return {
        "remarks": remarks,
        "megabytes": megabytes,
        "values": {one.name: one.value for one in fit.parameters},
        "deviations": {one.name: one.std for one in fit.parameters},
        "p_value": fit.p_value,
        "lines": int(np.count_nonzero(fit.fitted)),
        "findings": list(survey.signals.findings),
        "verdict": survey.fingerprint.verdict.reason,
    }


def rows(outcomes: Mapping[tuple[str, str], Mapping[str, Any]]) -> list[str]:
    """Return the rows of a table."""
    native = outcomes["native", ".nc"]
    lines = [
        "| written as | MB | lines | differs most, in deviations that its fit states | widest beside the native one |",
        "|---|---|---|---|---|",
    ]
    for (name, ending), one in outcomes.items():
        begin = f"| `{name}` ({ending}) | {one['megabytes']:.1f} |"
        if "refused" in one:
            lines.append(f"{begin} | refused: {one['refused']} | |")
            continue
        off, wider = {}, {}
        for key, deviation in one["deviations"].items():
            if key in native["values"] and deviation > 0.0:
                off[key] = abs(one["values"][key] - native["values"][key]) / deviation
                wider[key] = deviation / native["deviations"][key]
        worst, widest = max(off, key=lambda key: off[key]), max(wider, key=lambda key: wider[key])
        lines.append(
            f"{begin} {one['lines']} | `{worst}`: {off[worst]:.1g} | `{widest}`: {wider[widest]:.3g} times |"
            if off[worst] > _ROUNDING
            else f"{begin} {one['lines']} | nothing | |"
        )
    return lines


def main() -> None:
    """Sail, write, identify, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--outcomes", type=Path, required=True, help="folder of what is done already")
    parser.add_argument("--test", choices=tuple(TESTS), help="only this one")
    parser.add_argument("--write", action="store_true", help="write the tables into docs/formats.md")
    chosen = parser.parse_args()
    text: list[str] = []
    for key, test in TESTS.items():
        if chosen.test not in (None, key):
            continue
        folder = chosen.outcomes / key
        folder.mkdir(parents=True, exist_ok=True)
        native = sailed(test, folder)
        outcomes = {
            form: kept(folder / f"{form[0]}{form[1]}.json", partial(outcome, test, native, form)) for form in test.forms
        }
        part = [f"#### {test.name}", "", *rows(outcomes), ""]
        print("\n".join(part), flush=True)
        text += part
    if chosen.write:
        write_between_marks(DOCUMENT, "\n".join(text), BEGIN, END)


if __name__ == "__main__":
    main()
