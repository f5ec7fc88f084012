import subprocess
import sys

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import ResponseError
from shaftprint.spectra import plan_windows, whole_period_window

# Thesis (Fingerprinting II), table 3.5: i and stop [s]; T is stop minus start.
TABLE_3_5 = {
    "S1": (4, 1385.99), "S2": (4, 1867.78), "S3": (6, 2272.88), "S4": (8, 2655.91), "S5": (11, 3006.61),
    "S6": (13, 3264.67), "S7": (18, 3494.26), "S8": (21, 3730.91), "S9": (41, 3985.60), "S10": (65, 4183.36),
    "S11": (139, 4396.89), "S12": (211, 4609.89), "S13": (240, 4699.91), "S14": (431, 4899.94),
    "S15": (450, 5049.98), "S16": (632, 5253.97),
}  # fmt: skip


def test_windows_of_the_thesis():
    windows = {window.line: window for window in plan_windows(load_campaign("thesis"))}
    assert list(windows) == list(TABLE_3_5)
    for name, (periods, stop_s) in TABLE_3_5.items():
        window = windows[name]
        assert window.periods == periods
        # S5 is rounded twice in the table: T to 271.605 s, then the sum
        rounded_twice = name == "S5"
        assert round(window.stop_s, 2) == pytest.approx(stop_s - 0.01 * rounded_twice, abs=1e-6)
        assert window.duration_s == pytest.approx(stop_s - window.start_s, abs=0.0051)


def test_exact_multiples_lose_no_period(make_campaign):
    # 0.1 * 30 is 3.0000000000000004 or 2.9999999999999996 according to how it is reached
    window = whole_period_window(make_campaign(("S1", 0.1, 0.3, 30.3)).sines[0])
    assert window.periods == 3
    assert window.stop_s == pytest.approx(30.3)


def test_lines_come_in_order_of_frequency(make_campaign):
    campaign = make_campaign(("fast", 2.0, 0.0, 50.0), ("slow", 0.1, 60.0, 160.0))
    assert [window.line for window in plan_windows(campaign)] == ["slow", "fast"]


def test_one_period_is_too_few(make_campaign):
    with pytest.raises(ResponseError, match=r"S1: expected at least 2 whole periods of 0.01 Hz .* found 1.50 in 150 s"):
        plan_windows(make_campaign(("S1", 0.01, 0.0, 150.0)))


def test_two_lines_of_one_frequency(make_campaign):
    campaign = make_campaign(("S1", 0.1, 0.0, 100.0), ("S2", 0.1, 200.0, 300.0))
    with pytest.raises(ResponseError, match=r"S1 and S2 both have 0.1 Hz"):
        plan_windows(campaign)


def test_a_campaign_without_sines():
    campaign = load_campaign("thesis").model_copy(update={"sines": ()})
    with pytest.raises(ResponseError, match="expected at least one sine, found none"):
        plan_windows(campaign)


def test_the_room_needs_numpy_alone():
    code = (
        "import sys, shaftprint.spectra; "
        "print(*{'scipy', 'pydantic', 'numba', 'h5py', 'shaftprint.signals', 'shaftprint.campaign'} & set(sys.modules))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == ""
