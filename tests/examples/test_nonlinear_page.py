"""The page on limits runs as it stands, and what it prints is true."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "nonlinear.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def defined(tmp_path_factory):
    """Run all Python of the page in order, in a folder of its own; return what it defines."""
    names = {"__name__": "nonlinear_page"}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("page"))
        for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
            exec(compile(block, "nonlinear.md", "exec"), names)  # noqa: S102
    return names


@pytest.mark.long
def test_level_and_rate_are_found(defined):
    """The engine has the full-load curve of its vessel file, the rack 1.5 of its travel a second."""
    found = {number.name: number for number in defined["fit"].limits}
    truth = {"share": 1.0, "r_x": 1.5 / defined["truth"].normalised["X_0"], "T_aw": 0.5}
    for name, value in truth.items():
        assert abs(found[name].value - value) < 3.0 * found[name].std, name
        assert found[name].std < 0.06 * value, name


def test_links_of_the_page_exist():
    for link in re.findall(r"\]\(([^)]+)\)", PAGE):
        assert (ROOT / "docs" / link).exists(), link
