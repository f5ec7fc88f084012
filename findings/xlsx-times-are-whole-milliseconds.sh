#!/usr/bin/env bash
# About: XlsxWriter 3.3.1, openpyxl 3.1.5 and python-calamine 0.9.1: a log of 1024 Hz with a column of dates, as a sheet
# Guess: the readers give the times back as the file has them, to a microsecond or two.
# What happens: the file has them to 1.4 us, and both readers round to a whole millisecond: up to 0.5 ms off, more than half a step, and 24 of 1025 rows have the time of the row
#   before. In a column that is formatted as a number openpyxl gives all digits.
. "$(dirname "$0")/_setup.sh"
packages xlsxwriter==3.3.1 openpyxl==3.1.5 python-calamine==0.9.1
run <<'PY'
import datetime as dt

import openpyxl
import python_calamine
import xlsxwriter
from find import seen

BEGAN = dt.datetime(2026, 3, 5, 9)
times = [BEGAN + dt.timedelta(seconds=k / 1024) for k in range(1025)]
book = xlsxwriter.Workbook("log.xlsx")
sheet = book.add_worksheet()
form = book.add_format({"num_format": "yyyy-mm-dd hh:mm:ss.000"})
days = [(time - dt.datetime(1899, 12, 30)) / dt.timedelta(days=1) for time in times]
for row, (time, day) in enumerate(zip(times, days)):
    sheet.write_datetime(row, 0, time, form)
    sheet.write_number(row, 1, day)
book.close()
rows = list(openpyxl.load_workbook("log.xlsx").active.iter_rows(values_only=True))
stored = max(abs(86_400 * (number - day)) for (_, number), day in zip(rows, days))
seen(f"in the file, as a number: off by {1e6 * stored:.1f} us", stored < 2e-6)
others = python_calamine.CalamineWorkbook.from_path("log.xlsx").get_sheet_by_index(0).to_python()
for name, found in (("openpyxl", [row[0] for row in rows]), ("calamine", [row[0] for row in others])):
    off_s = max(abs((one - true).total_seconds()) for one, true in zip(found, times))
    doubled = len(found) - len(set(found))
    seen(f"{name}: off by {1e3 * off_s:.2f} ms, {doubled} of 1025 rows doubled", abs(off_s - 5e-4) < 2e-5 and doubled == 24)
PY
