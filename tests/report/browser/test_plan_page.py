"""The page of a planned test in a real browser: charts are drawn, hostile names stay text, nothing is too wide."""

from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import Effort, PlannedTest, SetPointLine, Wish, assumed_ship, design_campaign, limits_from_vessel
from shaftprint.report.plan._plan_page import render_plan
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.vessel import load_vessel

pytestmark = pytest.mark.slow

HOSTILE = "<img src=x onerror=alert(1)> {{7*7}} </script>"
CHARTS = ("set_point", "motion", "lines", "length")


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Four minutes at two speeds, of which one wish is met and the other not."""
    plan = design_campaign(
        assumed_ship(structure("GAUGE-CLOSED"), std={}),
        Wish(relative={"tau_dn": 0.05, "t_d": 0.001}),
        limits_from_vessel(load_vessel("stan-tug-1205"), set_point_rpm=200.0),
        STAN_TUG_NOISE,
        speeds=(1.15, 0.78),
        within_s=240.0,
        rng=np.random.default_rng(1),
        effort=Effort(steps=30, restarts=1),
    )
    test = PlannedTest(
        name=HOSTILE,
        vessel=HOSTILE,
        plan=plan,
        line=SetPointLine(slope_rpm_per_v=-251.0, offset_v=-5.0),
        created=datetime(2026, 11, 23, tzinfo=UTC),
        noise_source=HOSTILE,
        remarks=("Nobody has measured the noise of this ship. A first test of 90 s does.",),
    )
    return render_plan(tmp_path_factory.mktemp("planned") / "plan", test)


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_all_charts_are_drawn_and_nothing_is_too_wide(visit, page, width, scheme):
    with visit(page, viewport={"width": width, "height": 900}, color_scheme=scheme) as found:
        for name in CHARTS:
            found.show(name)
        assert found.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert found.messages == []
        assert all(request.startswith("file:") for request in found.requests)


def test_the_first_screen_says_what_is_missed_and_that_it_was_not_rehearsed(visit, page):
    with visit(page) as found:
        words = " ".join(found.page.locator("#found").inner_text().split())
        assert "do not meet the wish for t_d" in words
        assert "Was it rehearsed? No. Its numbers are predictions" in words
        assert (
            "What should you know before you sail it? ! Look at this. Nobody has measured the noise of this ship."
            in words
        )
        assert "Not known" not in words
        assert "not rehearsed" in found.page.locator("#top").inner_text()


def test_predicted_numbers_have_their_meaning_and_the_limits_of_speed_lie_inside_the_frame(visit, page):
    with visit(page) as found:
        # what stands in the title is not said again as a fact
        assert found.page.locator("#found dt").all_inner_texts() == ["Length", "Speeds", "Set point"]
        table = found.page.locator("section:has(#numbers) table").first
        assert table.locator("thead th").last.inner_text() == "meaning"
        assert "proportional gain of the governor" in table.inner_text()
        found.show("set_point")
        low, high = found.axis("set_point", "yaxis")
        assert low < 600.0
        assert high > 1800.0


def test_paper_has_the_card_for_the_bridge_on_its_first_sheet(visit, page):
    """What lies behind the first sheet is taken away: what is left still has the card."""
    with visit(page) as found:
        found.wait_for("document.readyState === 'complete'")
        found.page.evaluate("document.querySelectorAll('#found ~ section, footer').forEach(e => e.remove())")
        # with nothing behind it the break would make an empty sheet
        found.page.evaluate("document.getElementById('found').style.breakAfter = 'auto'")
        words = found.page.locator("#found").inner_text()
        assert words.count("Card for the bridge") == 1
        # before the questions
        assert words.index("To stop: hold") < words.index("Does it meet the wishes?")
        assert found.sheets() == 1


def test_hostile_names_are_shown_as_they_are(visit, page):
    with visit(page) as found:
        assert HOSTILE in found.page.locator("h1").inner_text()
        assert found.page.locator("img[src=x]").count() == 0
