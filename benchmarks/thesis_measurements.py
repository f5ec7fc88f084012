"""Tables 3.1 to 3.7, D.1 and E.1 of the thesis: printed, computed again, and simulated; docs/thesis-tables.md.

Run ``python benchmarks/thesis_measurements.py``; with ``--write`` the tables go into the document. Sailing takes a
minute of a processor, reading the recording in both ways half a minute; ``--recording`` takes one that is there.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from benchmarks.thesis_case import FREQUENCY_HZ
from benchmarks.thesis_tables import sailed
from shaftprint.campaign import Campaign
from shaftprint.catalogue import structure
from shaftprint.signals import Signals
from shaftprint.survey import Measurement, load_trial, measure
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import Vessel

DOCUMENT = ROOT / "docs" / "thesis-tables.md"
BEGIN = "<!-- tables of benchmarks/thesis_measurements.py: begin -->"
END = "<!-- tables of benchmarks/thesis_measurements.py: end -->"
NOTHING = "–"
SIMULATED = ("simulated, thesis' way", "simulated, shaftprint")
WAYS = ("printed", "computed again", *SIMULATED)
# Printed on pages 16 to 22, 73 and 75.
VOLTS = np.array([-3.031, -4.031, -5.035, -6.024, -7.022])
RPM = np.array([676.57, 927.94, 1182.60, 1428.50, 1676.61])
SET_POINT_S = np.array([58.9100, 119.5050, 178.5950, 239.0450, 298.6950, 358.5850])
SPEED_S = np.array([59.2500, 119.8450, 179.0400, 239.5300, 299.0600, 359.0200])
DELAY_S = ("0.34", "0.34", "0.445", "0.485", "0.365", "0.435")
STRIP_DEG = np.array([90.40, 87.24, 90.74, 91.64])
OVERALL = {"n_set": "0.9986", "n_e": "0.9451", "n_e1": "0.9475", "n_e4": "0.8610", "M_s": "0.5751"}
PERIODS = (4, 4, 6, 8, 11, 13, 18, 21, 41, 65, 139, 211, 240, 431, 450, 632)
START_S = (476.9, 1433.0, 1962.0, 2365.0, 2735.0, 3048.0, 3282.0, 3540.0, 3755.0, 4009.0, 4219.0, 4481.0, 4630.0)
START_S += (4840.0, 5020.0, 5234.0)
STOP_S = ("1385.99", "1867.78", "2272.88", "2655.91", "3006.61", "3264.67", "3494.26", "3730.91", "3985.60", "4183.36")
STOP_S += ("4396.89", "4609.89", "4699.91", "4899.94", "5049.98", "5253.97")
LOCAL_DB = {
    "n_set": (57.8, 59.2, 59.7, 63.8, 68.6, 26.5, 73.6, 73.8, 59.5, 52.7, 45.7, 59.1, 49.4, 43.9, 17.5, 16.1),
    "n_e": (40.6, 40.4, 44.9, 45.3, 45.7, 25.6, 38.0, 41.3, 38.5, 35.9, 31.9, 17.0, 7.8, -11.6, -18.3, -22.4),
    "n_e1": (40.6, 40.5, 45.2, 45.4, 45.8, 25.5, 37.8, 41.4, 38.5, 36.0, 31.7, 16.7, -4.1, -27.3, -13.5, -2.8),
    "n_e4": (40.6, 40.1, 44.9, 44.6, 44.9, 25.6, 37.9, 41.2, 38.0, 36.1, 31.8, 17.1, 7.4, -11.6, -31.1, -30.3),
    "M_s": (18.4, 25.3, 20.7, 22.7, 23.5, 24.2, 23.6, 27.2, 34.9, 34.3, 31.9, 17.2, 9.0, 4.6, -23.9, -23.0),
}
# Inertias that can be read in the copy at hand, rows 4 to 17 of table E.1 [kg m2]; rows 14 to 16 turn with the shaft.
READ = {4: 0.09395, 5: 0.09395, 6: 0.07030, 7: 0.09395, 8: 0.08838, 9: 1.800, 10: 0.590, 11: 0.08160, 12: 0.05400}
READ |= {13: 0.01000, 14: 0.513, 15: 0.281, 16: 12.290, 17: 0.05400}
E_1_NAMES = {4: "cylinder 3", 5: "cylinder 4", 6: "cylinder 5", 7: "cylinder 6", 8: "rear crank", 9: "flywheel"}
E_1_NAMES |= {
    10: "coupling, primary side",
    11: "coupling, secondary side",
    12: "clutch and transfer gear",
    13: "pinion",
}
E_1_NAMES |= {14: "output gear", 15: "flanges", 16: "propeller", 17: "reverse clutch and transfer gear"}


def main() -> None:
    """Make the tables and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recording", type=Path, help="recording of campaign thesis, seed 1, instead of sailing one")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = tables(options.recording or sailed(Path(folder) / "thesis.nc"))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def tables(recording: Path) -> str:
    """Return all tables, in Markdown."""
    trial = load_trial("stan-tug-1205", "thesis")
    thesis, standard = (measure(recording, trial, mode=mode) for mode in ("thesis", "shaftprint"))
    parts = [
        calibration(thesis.signals, standard.signals),
        working_point(thesis.signals, standard.signals),
        step_delays(thesis.signals, standard.signals),
        strips(standard.signals),
        windows(trial.campaign),
        overall_ratios(thesis, standard),
        local_ratios(thesis, standard),
        limits(),
        inertias(trial.vessel),
    ]
    return "\n".join(parts)


def calibration(thesis: Signals, standard: Signals) -> str:
    """Return table 3.1: levels of the set point, the printed line and the line through the printed levels."""
    slope, intercept = np.polyfit(VOLTS, RPM, 1)
    rows = [
        (
            f"{volt:.3f} V",
            f"{rpm:.2f}",
            f"{slope * volt + intercept:.2f}",
            *(_line_at(s, volt) for s in (thesis, standard)),
        )
        for volt, rpm in zip(VOLTS, RPM, strict=True)
    ]
    lines = [_line(one) for one in (thesis, standard)]
    rows.append(("line, eq. 3.2", "-250.97 U - 83.467", f"{slope:.2f} U - {-intercept:.3f}", *lines))
    headings = ("level", "printed [rpm]", "least squares of the printed [rpm]", *SIMULATED)
    return _table("Table 3.1, page 16: volts to engine speed", headings, rows)


def _line(signals: Signals) -> str:
    slope, intercept = (
        rpm_from_rev_s(value) for value in (signals.calibration.slope_rev_s_per_v, signals.calibration.intercept_rev_s)
    )
    return f"{slope:.2f} U - {-intercept:.2f}"


def _line_at(signals: Signals, volt: float) -> str:
    return f"{rpm_from_rev_s(signals.calibration.slope_rev_s_per_v * volt + signals.calibration.intercept_rev_s):.2f}"


def working_point(thesis: Signals, standard: Signals) -> str:
    """Return table 3.2: engine speed and shaft torque at the working point."""
    points = [one.working_point for one in (thesis, standard)]
    speeds = [f"{rpm_from_rev_s(point.engine_speed_rev_s):.1f}" for point in points]
    torques = [f"{point.shaft_torque_nm:.0f}" for point in points]
    rows = [
        ("engine speed [rpm]", "1183.8", f"{250.97 * 5.0 - 83.467:.1f}, by the line at -5 V", *speeds),
        ("shaft torque [N m]", "1725", NOTHING, *torques),
    ]
    return _table("Table 3.2, page 17: working point", ("number", "printed", "computed again", *SIMULATED), rows)


def step_delays(thesis: Signals, standard: Signals) -> str:
    """Return table 3.3: time from set point to speed at the middle of six steps."""
    again = SPEED_S - SET_POINT_S
    simulated = [
        [step.delay_s for step in one.step_delays if step.staircase == "St1"][:6] for one in (thesis, standard)
    ]
    rows = [
        (str(i + 1), printed, f"{again[i]:.4f}", *(f"{values[i]:.3f}" for values in simulated))
        for i, printed in enumerate(DELAY_S)
    ]
    means = [f"{np.mean(values):.4f}" for values in simulated]
    rows.append(("mean", "0.4018", f"{again.mean():.4f}", *means))
    return _table("Table 3.3, page 17: delay of each step of St1 [s]", ("step", *WAYS), rows)


def strips(standard: Signals) -> str:
    """Return table 3.4: angles between the reflection strips; the thesis' way keeps them and corrects nothing."""
    angles = 360.0 * standard.strips[0].angle_rev
    # strips are numbered from the first that the recording shows
    turns = [np.roll(angles, turn) for turn in range(angles.size)]
    angles = min(turns, key=lambda turned: float(np.abs(turned - STRIP_DEG).sum()))
    errors = 100.0 * (STRIP_DEG / STRIP_DEG.sum() * STRIP_DEG.size - 1.0)
    rows = [
        (str(i + 1), f"{STRIP_DEG[i]:.2f}", f"{errors[i]:+.2f} % of 90", f"{angles[i]:.3f}")
        for i in range(STRIP_DEG.size)
    ]
    rows.append(("sum", "360", f"{STRIP_DEG.sum():.2f}", f"{angles.sum():.3f}"))
    headings = ("strip", "printed [deg]", "computed again", "simulated, shaftprint [deg]")
    return _table("Table 3.4, page 19: angles between the strips", headings, rows)


def windows(campaign: Campaign) -> str:
    """Return table 3.5: the windows of whole periods."""
    rows = []
    for i, sine in enumerate(campaign.sines):
        stop_s = START_S[i] + PERIODS[i] / FREQUENCY_HZ[i]
        rows.append(
            (
                sine.name,
                f"{FREQUENCY_HZ[i]:g}",
                str(PERIODS[i]),
                STOP_S[i],
                f"{stop_s:.2f}",
                f"{sine.window_stop_s:.2f}",
            )
        )
    headings = ("sine", "Hz", "periods", "stop printed [s]", "start + periods / f [s]", "campaign `thesis` [s]")
    return _table("Table 3.5, page 20: windows", headings, rows)


def overall_ratios(thesis: Measurement, standard: Measurement) -> str:
    """Return table 3.6: overall signal-to-noise ratio of each channel."""
    rows = []
    for name, printed in OVERALL.items():
        ratios = [one.spectra.signal_to_noise for one in (thesis, standard)]
        rows.append((f"`{name}`", printed, *(f"{one.overall[one.channels.index(name)]:.4f}" for one in ratios)))
    return _table("Table 3.6, page 21: overall signal-to-noise ratio", ("channel", "printed", *SIMULATED), rows)


def local_ratios(thesis: Measurement, standard: Measurement) -> str:
    """Return table 3.7: signal-to-noise ratio of each line and channel."""
    ratios = [one.spectra.signal_to_noise for one in (thesis, standard)]
    rows = []
    for i, line in enumerate(ratios[0].lines):
        cells = [line]
        for name, printed in LOCAL_DB.items():
            ratios_db = [one.local_db[one.lines.index(line), one.channels.index(name)] for one in ratios]
            cells.append(" / ".join(f"{value:.1f}" for value in (printed[i], *ratios_db)))
        rows.append(tuple(cells))
    headings = ("line", *(f"`{name}`" for name in LOCAL_DB))
    caption = "Table 3.7, page 22: ratio of each line [dB], printed / simulated, thesis' way / simulated, shaftprint"
    return _table(caption, headings, rows)


def limits() -> str:
    """Return table D.1 with the numbers of CL1: the limits of the closed loop without lag and delay."""
    line = structure("CL1")
    gain, integral = 1.2, 4.0
    values = line.vector({"tau_n": 0.35, "K_p": gain, "K_i": integral})
    slow, fast = (line.response(values, 1j * omega)[:, 0] for omega in (1e-6, 1e6))
    rows = [
        ("`n / n_set`", "1, 0 dB", _limit(slow[0]), "0, -inf dB", _limit(fast[0])),
        (
            "`M_s / n_set`",
            "2, 0.3 dB",
            _limit(slow[1]),
            "`K_p`, log `K_p` dB",
            _limit(fast[1]) + f" for `K_p` = {gain:g}",
        ),
    ]
    headings = ("relation", "printed, s to 0", "computed again", "printed, s to infinity", "computed again")
    return _table("Tables 2.4 and D.1, pages 11 and 73: limits of the closed loop", headings, rows)


def _limit(value: complex) -> str:
    size = abs(value)
    return "0, -inf dB" if size < 1e-4 else f"{size:.3g}, {abs(round(20.0 * np.log10(size), 2)):.2f} dB"


def inertias(vessel: Vessel) -> str:
    """Return table E.1: rotating masses, at their own speed, beside those of the shipped vessel file."""
    shipped = [row.inertia_kg_m2 for row in vessel.inertia]
    rows = []
    for number, read in READ.items():
        near = min(shipped, key=lambda value: abs(value - read))
        rows.append((str(number), E_1_NAMES[number], f"{read:g}", f"{near:g}" if abs(near - read) < 1e-9 else NOTHING))
    total = 66.2960
    before = vessel.inertia_upstream_kg_m2
    rows.append(("sum", "all, at the propeller shaft", f"{total:.3f}", f"{before + 12.290:.3f}"))
    rows.append(("", "all but the propeller (eq. 5.1)", "54.006", f"{before:.3f}"))
    headings = ("row", "mass", "printed [kg m2]", "vessel file `stan-tug-1205` [kg m2]")
    return _table("Table E.1, page 75: inertias", headings, rows)


def _table(caption: str, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    return f"## {caption}\n\n" + "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)]) + "\n"


if __name__ == "__main__":
    main()
