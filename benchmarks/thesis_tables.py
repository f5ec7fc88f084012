"""Tables 5.2 and 5.3 of the thesis whole: printed, and what becomes of them; the tables of docs/thesis.md.

Each structure stands there as the thesis prints it; as it comes back when the printed set is put in as truth; as the
thesis' way finds it on a simulated recording, open loop also with the set point off by 0.85 %; and weighted by the
noise on shaftprint's signals. Run ``python benchmarks/thesis_tables.py``; with ``--write`` the tables go into the
document. Sailing takes a minute of a processor, everything else half a minute; ``--recording`` takes one that is there.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from benchmarks.thesis_case import FREQUENCY_HZ
from shaftprint.catalogue import structure
from shaftprint.identify import Identification, Settings, identify
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey import GAUGE, ThesisMode, Trial, load_trial, measure
from shaftprint.survey._thesis_mode import SET_POINT_OFF
from shaftprint.survey._thesis_way import thesis_way, weighted_fits
from shaftprint.tug import read_truth, sail, truth_path

DOCUMENT = ROOT / "docs" / "thesis.md"
BEGIN = "<!-- tables of benchmarks/thesis_tables.py: begin -->"
END = "<!-- tables of benchmarks/thesis_tables.py: end -->"
SEED = 1
NAMES = ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta")
OUTPUTS = ("n", "M_s")
NOTHING = "–"
# As printed on pages 43 and 45, with FitPercent of n and of M_s; OL1 is n / M_s, OL2 to OL5 are M_s / e.
OPEN_LOOP: Mapping[str, Mapping[str, str]] = {
    "OL1": {"tau_n": "0.3897", "n": "56.01"},
    "OL2": {"K_p": "1.003", "K_i": "4.2725", "M_s": "54.99"},
    "OL3": {"K_p": "3.4363", "K_i": "4.2639", "t_d": "0.4022", "M_s": "55.17"},
    "OL4": {"K_p": "2.902", "K_i": "4.2699", "omega_n": "8.2912", "zeta": "0.5616", "M_s": "55.17"},
    "OL5": {"K_p": "4.36", "K_i": "4.2664", "t_d": "0.1023", "omega_n": "8.202", "zeta": "0.88", "M_s": "54.88"},
}
CLOSED_LOOP: Mapping[str, Mapping[str, str]] = {
    "CL1": {"tau_n": "0.278", "K_p": "0.01", "K_i": "5.99", "n": "54.77", "M_s": "32.37"},
    "CL2": {"tau_n": "0.6027", "K_p": "0.01", "K_i": "5.0534", "n": "51.84", "M_s": "18.86"},
    "CL3": {
        "tau_n": "0.3537",
        "K_p": "1.1833",
        "K_i": "5.3967",
        "omega_n": "7.2133",
        "zeta": "0.4",
        "n": "67.93",
        "M_s": "40.07",
    },
    "CL4": {
        "tau_n": "0.3290",
        "K_p": "1.6004",
        "K_i": "4.4388",
        "t_d": "0.1161",
        "omega_n": "9.7705",
        "zeta": "0.4",
        "n": "74.50",
        "M_s": "62.10",
    },
}
# CL2 is fitted in time, to another signal: examples/long_chirp.py.
IN_TIME = "CL2"


def main() -> None:
    """Make both tables and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recording", type=Path, help="recording of campaign thesis, seed 1, instead of sailing one")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = tables(options.recording or sailed(Path(folder) / "thesis.nc"))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def sailed(path: Path) -> Path:
    """Sail the campaign of the thesis with the simulated tug and return the recording."""
    trial = _trial()
    sail(trial.vessel, trial.campaign, path, seed=SEED)
    return path


def tables(recording: Path) -> str:
    """Return both tables of one recording, in Markdown."""
    trial, rng = _trial(), np.random.default_rng(SEED)
    measured = measure(recording, trial, mode="shaftprint")
    weighted = {fit.structure.name: fit for fit in weighted_fits(measured, trial, rng=rng)}
    thesis = thesis_way(measure(recording, trial, mode="thesis"), trial, rng=rng)
    truth = read_truth(truth_path(recording)).normalised
    known = [("GAUGE-CLOSED", *_found("shaftprint, weighted", weighted[GAUGE], tau="tau_dn"))]
    known.append(("truth", *_truth({**truth, "tau_n": truth["tau_dn"]})))
    blocks = []
    for caption, printed in (("Table 5.2", OPEN_LOOP), ("Table 5.3", CLOSED_LOOP)):
        rows = [row for name, values in printed.items() for row in _rows(name, values, thesis, weighted)]
        blocks.append(f"**{caption}**\n\n" + _table([*rows, *known]))
    return "\n".join(blocks)


def _trial() -> Trial:
    return load_trial("stan-tug-1205", "thesis")


def _rows(
    name: str, printed: Mapping[str, str], thesis: ThesisMode, weighted: Mapping[str, Identification]
) -> Iterator[tuple[str, ...]]:
    """Return the rows of one structure."""
    yield (name, "printed", *(printed.get(column, NOTHING) for column in (*NAMES, *OUTPUTS)))
    if name == IN_TIME:
        return
    yield ("", *_found("printed set put in", put_in(name, printed), digits=printed))
    yield ("", *_found("simulated, thesis' way", thesis.identifications[name]))
    if name in thesis.set_point_off:
        what = f"the same, set point off by {100.0 * SET_POINT_OFF:.2f} %"
        yield ("", *_found(what, thesis.set_point_off[name]))
    yield ("", *_found("simulated, shaftprint, weighted", weighted[name]))


def put_in(name: str, printed: Mapping[str, str]) -> Identification:
    """Return the fit of a structure to what it gives itself, without noise, with a printed set."""
    model = structure(name)
    values = model.vector({key: float(text) for key, text in printed.items() if key in NAMES})
    exact = model.response(values, 2j * np.pi * FREQUENCY_HZ)
    variance = np.tile((1e-3 * np.abs(exact)) ** 2, (2, 1)).T
    response = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=exact[:, None, :],
        covariance=variance[:, :, None] * np.eye(variance.shape[1]),
        inputs=(model.input,),
        outputs=tuple(model.outputs),
    )
    return identify(model, response, rng=np.random.default_rng(SEED), settings=Settings())


def _found(
    what: str, fit: Identification, *, tau: str = "tau_n", digits: Mapping[str, str] | None = None
) -> tuple[str, ...]:
    """Return what a fit found, as printed; a value at its bound is marked by a star."""
    estimates = {("tau_n" if e.name == tau else e.name): e for e in fit.parameters}
    cells = []
    for name in NAMES:
        if name not in estimates:
            cells.append(NOTHING)
            continue
        decimals = len(digits[name].partition(".")[2]) if digits else 3
        star = "*" if estimates[name].at_bound else ""
        cells.append(f"{estimates[name].value:.{decimals}f}{star}")
    # a rounded zero has no sign
    percent = (f"{round(fit.fit_percent[o], 1) + 0.0:.1f}" if o in fit.fit_percent else NOTHING for o in OUTPUTS)
    return (what, *cells, *percent)


def _truth(truth: Mapping[str, float]) -> tuple[str, ...]:
    return ("of the simulated tug", *(f"{truth[name]:.3f}" for name in NAMES), NOTHING, NOTHING)


def _table(rows: Sequence[Sequence[str]]) -> str:
    header = ("structure", "way", "`tau_n` [s]", "`K_p`", "`K_i` [1/s]", "`t_d` [s]", "`omega_n` [rad/s]", "`zeta`")
    header += ("FitPercent `n`", "FitPercent `M_s`")
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)]) + "\n"


if __name__ == "__main__":
    main()
