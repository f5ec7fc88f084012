"""Tables of the thesis row by row: what needs no recording is made again, the rest is held to truth."""

import re
from pathlib import Path

import numpy as np
import pytest
from benchmarks.result_tables import whole_text
from benchmarks.thesis_measurements import BEGIN, END, inertias, limits, windows

from shaftprint.campaign import load_campaign
from shaftprint.vessel import load_vessel

PATH = Path(__file__).parents[2] / "docs" / "thesis-tables.md"
PAGE = whole_text(PATH, PATH.read_text(encoding="utf-8"))


def rows(table):
    """Return the cells of a table of the page by the first one."""
    part = PAGE[PAGE.index(f"## Table {table}") :]
    lines = part[: part.find("\n## ", 1)].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return {row[0]: row[1:] for row in cells[2:]}


def test_tables_without_a_recording_are_those_of_today():
    made = PAGE[PAGE.index(BEGIN) : PAGE.index(END)]
    assert windows(load_campaign("thesis")) in made
    assert inertias(load_vessel("stan-tug-1205")) in made
    assert limits() in made


def test_windows_are_whole_periods():
    """Thesis eq. 3.8, computed by hand from the printed frequency, number of periods and start."""
    assert float(rows("3.5")["S1"][3]) == pytest.approx(476.9 + 4 / 0.0044, abs=0.005)
    assert float(rows("3.5")["S16"][3]) == pytest.approx(5234.0 + 632 / 31.644, abs=0.005)
    for printed, again in ((float(row[2]), float(row[3])) for row in rows("3.5").values()):
        assert again == pytest.approx(printed, abs=0.0101)


def test_the_line_through_the_printed_levels_is_that_of_least_squares():
    levels = {float(name.removesuffix(" V")): row for name, row in rows("3.1").items() if name.endswith(" V")}
    volts, printed, fitted = (
        np.array(x) for x in zip(*((v, float(r[0]), float(r[1])) for v, r in levels.items()), strict=True)
    )
    # normal equations: residuals are orthogonal to one and to the volts
    assert np.sum(printed - fitted) == pytest.approx(0.0, abs=0.05)
    assert np.sum((printed - fitted) * volts) == pytest.approx(0.0, abs=0.1)


def test_delays_of_steps_are_differences_of_the_printed_times():
    again = [float(row[1]) for name, row in rows("3.3").items() if name != "mean"]
    assert again == pytest.approx([0.34, 0.34, 0.445, 0.485, 0.365, 0.435], abs=1e-4)
    assert float(rows("3.3")["mean"][1]) == pytest.approx(2.41 / 6, abs=1e-4)


def test_strips_are_found_again():
    """The simulated tug has the printed angles, closed to 360 degrees."""
    for name, (printed, _, found) in rows("3.4").items():
        if name != "sum":
            assert float(found) == pytest.approx(float(printed) * 360.0 / 360.02, abs=0.01)


def test_ratios_of_every_line_and_channel_are_there():
    table = rows("3.7")
    assert len(table) == 16
    assert all(len(re.findall(r" / ", cell)) == 2 for row in table.values() for cell in row)
    # 0 dB is as much noise as signal: the fast lines have none of it left in the printed table
    assert all(float(table[name][1].split(" / ")[0]) < 0.0 for name in ("S14", "S15", "S16"))
