"""The tutorial on two fingerprints: its Python runs as it stands, the example that it shows included."""

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow


ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "compare_fingerprints.py"
PAGE = (ROOT / "docs" / "tutorials" / "what-changed.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """Run the cells of the page in order, in a folder of their own; return what they define."""
    names = {"__name__": "two_fingerprints_page"}
    assert f"../../examples/{EXAMPLE.name}" in PAGE
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("page"))
        # what docs/conf.py says where the page is built
        patch.setenv("SHAFTPRINT_EXAMPLES", str(EXAMPLE.parent))
        for cell in re.findall(r"```\{code-cell\} ipython3\n(.*?)```", PAGE, flags=re.DOTALL):
            exec(compile(re.sub(r"^[:%]\w.*\n", "", cell, flags=re.M), "what-changed.md", "exec"), names)  # noqa: S102
    return names


def test_what_was_changed_stands_out(ran):
    defined = ran["ran"]
    deviations = defined["deviations"]
    # 1.5 kg m2 more and a fifth less integral gain stand out; what was left alone does not
    assert deviations["I_dn"] > 20.0
    assert deviations["K_p / K_i"] > 3.0
    assert all(abs(deviations[name]) < 3.0 for name in ("I_up", "k_q", "t_d + t_sp"))
    before, after = defined["before"].quantity("I_dn"), defined["after"].quantity("I_dn")
    assert (before.value, after.value) == (pytest.approx(17.0, rel=0.01), pytest.approx(18.5, rel=0.01))
    # the scale of the gauge, 2 %, is in the number but not in the change
    assert before.std == pytest.approx(0.02 * 17.0, rel=0.1)
    assert defined["own_std"](defined["before"], "I_dn") < 0.005 * 17.0


def test_the_scale_of_the_gauge_is_nearly_all_of_the_uncertainty(ran):
    """As the page says below its second cell: 2 % of the scale beside a test's own half per cent."""
    shares = ran["row"].shares
    assert max(shares, key=shares.get) == "gauge scale"
    assert shares["gauge scale"] > 0.95
    assert sum(shares.values()) == pytest.approx(1.0)
