"""The page on fits in time runs as it stands, and what it prints is true."""

import re
from pathlib import Path

import pytest
from tests.measured_truth import as_measured

from shaftprint.tug import read_truth, truth_path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "time-domain.md").read_text(encoding="utf-8")
TRUTH = {"K": 12.0, "T": 0.8, "t_d": 0.13}


@pytest.fixture(scope="module")
def defined(tmp_path_factory):
    """Run all Python of the page in order, in a folder of its own; return what it defines, and the folder."""
    folder = tmp_path_factory.mktemp("page")
    names = {"__name__": "time_domain_page", "folder": folder}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
            exec(compile(block, "time-domain.md", "exec"), names)  # noqa: S102
    return names


@pytest.mark.slow
@pytest.mark.parametrize("name", ["fit", "again"])
def test_the_fan_is_found_from_all_three_tests(defined, name):
    fit = defined[name]
    assert len(fit.parts) == 3
    assert fit.p_value > 1e-3
    for estimate in fit.parameters:
        assert abs(estimate.value - TRUTH[estimate.name]) < 3.0 * estimate.std, estimate.name


@pytest.mark.slow
def test_every_record_has_its_own_noise(defined):
    """First coefficients 0.5 and 0.8, as they were put in."""
    chirp, steps = (part.noise for part in defined["fit"].parts[1:])
    assert chirp.coefficients[0, 0, 0] == pytest.approx(0.5, abs=0.1)
    assert steps.coefficients[0, 0, 0] == pytest.approx(0.8, abs=0.1)
    assert not defined["records"][1].used[700:760].any()


@pytest.mark.slow
def test_slow_lines_and_fast_records_give_the_ship(defined):
    """The inertia time is the tug's, at the working point that was measured in this recording."""
    ship = defined["ship"]
    truth = as_measured(read_truth(truth_path(defined["folder"] / "short.nc")), defined["signals"])
    assert next(part.name for part in ship.parts) == "response of n, M_s"
    assert len(ship.parts) == 8
    tau_dn = next(p for p in ship.parameters if p.name == "tau_dn")
    assert tau_dn.value == pytest.approx(truth["tau_dn"], abs=3.0 * tau_dn.std)
    assert tau_dn.std < 0.002


def test_links_of_the_page_exist():
    for link in re.findall(r"\]\(([^)]+)\)", PAGE):
        assert (ROOT / "docs" / link).exists(), link
