#!/usr/bin/env bash
# About: python-calamine 0.9.1, pandas 3.1.1 with odfpy 1.4.1, pyexcel-ods3 0.6.1: a column of times in a sheet of OpenDocument
# Guess: rows 0.25 s apart come back so in each; 25 h are 25 h.
# What happens: calamine gives them, and text where a time is beyond 24 h; pandas with odfpy reads what the cell shows, four times 00:00:00, and refuses the sheet beyond 24 h;
#   pyexcel-ods3 gives None for every time that has a fraction. Speeds come as stored in all three.
. "$(dirname "$0")/_setup.sh"
packages python-calamine==0.9.1 pandas==3.1.1 odfpy==1.4.1 pyexcel-ods3==0.6.1
run <<'PY'
import datetime

import pandas as pd
import pyexcel_ods3
from find import seen
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import Table, TableCell, TableRow
from odf.text import P
from python_calamine import CalamineWorkbook


def row(*cells):
    line = TableRow()
    for shown, stored in cells:
        cell = TableCell(**stored)
        cell.addElement(P(text=shown))
        line.addElement(cell)
    return line


def written(name, times):
    """Write a sheet of times and speeds, as text shown and value stored."""
    document, sheet = OpenDocumentSpreadsheet(), Table(name="log")
    sheet.addElement(row(*((title, {"valuetype": "string"}) for title in ("time", "speed"))))
    for number, (shown, stored) in enumerate(times):
        speed = (f"{1500 + number}", {"valuetype": "float", "value": 1500.25 + number})
        sheet.addElement(row((shown, {"valuetype": "time", "timevalue": stored}), speed))
    document.spreadsheet.addElement(sheet)
    document.save(name)
    return CalamineWorkbook.from_path(name).get_sheet_by_index(0).to_python()[1:]


calamine = written("log.ods", [("00:00:00", f"PT00H00M00.{25 * number:02d}0000000S") for number in range(4)])
odf = pd.read_excel("log.ods", engine="odf", dtype={"time": str})
pyexcel = pyexcel_ods3.get_data("log.ods")["log"][1:]
seen(f"calamine:     {[str(one[0]) for one in calamine]}", [one[0] for one in calamine] == [datetime.time(microsecond=250_000 * number) for number in range(4)])
seen(f"pandas, odf:  {odf['time'].tolist()}", odf["time"].tolist() == ["00:00:00"] * 4)
seen(f"pyexcel-ods3: {[one[0] for one in pyexcel]}", [one[0] for one in pyexcel] == [None] * 4)
speeds = [1500.25, 1501.25, 1502.25, 1503.25]
seen(f"speeds in all: {speeds}", [one[1] for one in calamine] == speeds == odf["speed"].tolist() == [one[1] for one in pyexcel])
day = written("day.ods", [("25:00:01", "PT25H00M01.500000000S")])
try:
    found = str(pd.read_excel("day.ods", engine="odf")["time"].tolist())
except ValueError as error:
    found = str(error)
seen(f"25 h: calamine {day[0][0]!r}, pandas {found}", day[0][0] == "PT25H00M01.500000000S" and "hour must be in" in found)
PY
