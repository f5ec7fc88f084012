"""The page of a planned test."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.design.files._plan_folder import CAMPAIGN
from shaftprint.design.files._plan_json import PLAN
from shaftprint.design.files._set_point_files import CSV, GENERATOR, MAT
from shaftprint.design.views._line_worth import line_worths
from shaftprint.design.views._other_lengths import length_curve
from shaftprint.design.views._planned_motion import planned_motion
from shaftprint.digits import unit_text, with_deviation
from shaftprint.errors import ReportError
from shaftprint.plain_table import Symbol, Table, numbers, texts
from shaftprint.report._page import Page, write_page
from shaftprint.report.figures._plan import (
    length_chart,
    planned_line_chart,
    planned_motion_chart,
    planned_set_point_chart,
)
from shaftprint.report.plan._plan_cover import plan_cover
from shaftprint.report.sections._meanings import explained
from shaftprint.report.sections._sections import Picture, Section
from shaftprint.tables._plan import planned_leg_table, predicted_number_table

if TYPE_CHECKING:
    from shaftprint.design.inputs._lever import Lever
    from shaftprint.design.planned_test._planned_test import PlannedTest


@refusing_none(ReportError)
def render_plan(directory: str | Path, test: "PlannedTest") -> Path:
    """Write the page of a planned test, ``index.html`` with its charts; return its path.

    ``directory``: where the page goes; made if it does not exist. Other files there are left alone. ``test``: the
    planned test. Raises FileExistsError if there is a page already; ReportError if plotly is not installed.
    """
    page = Page(
        title=f"Planned test of {test.vessel}",
        subtitle=f"Test “{test.name}”, {'rehearsed' if test.rehearsal is not None else 'not rehearsed'}",
        created=test.created,
        version=test.version,
        cover=plan_cover(test),
        sections=(
            _legs(test),
            _numbers(test),
            _motion(test),
            _lines(test),
            _length(test),
            _words(test),
            _assumed(test),
        ),
        files=_files(test.line.lever),
        ending=(
            f"shaftprint {test.version}. ± is one standard deviation throughout, predicted to first order; intervals "
            "and bands hold 95 %."
        ),
    )
    return write_page(directory, page)


def _legs(test: "PlannedTest") -> Section:
    return Section(
        key="legs",
        title="What is asked of the ship",
        tables=(planned_leg_table(test),),
        pictures=(
            Picture(
                name="set_point",
                caption="The set point of the whole test, as the engine speed that it asks for.",
                alt="Set point over time with the lowest and highest allowed speed.",
                chart=partial(planned_set_point_chart, test),
            ),
        ),
    )


def _numbers(test: "PlannedTest") -> Section:
    structure = test.plan.ship.structure
    meanings = {one.name: one.meaning for one in structure.parameters}
    meanings |= {one.name: one.meaning for one in structure.combinations}
    section = Section(key="numbers", title="What it would tell", tables=(predicted_number_table(test),))
    return explained(section, meanings)


def _motion(test: "PlannedTest") -> Section:
    return _with_picture(
        title="Set point, speed and torque",
        words=(
            "One period of each leg after it has settled, of the ship as it is assumed. Other ships within the stated "
            "uncertainty swing more, and 98 of 100 of them keep the limits too."
        ),
        picture=Picture(
            name="motion",
            caption="Set point, speed and brake torque with their noise, and the limits of ship and engine.",
            alt="Set point and speed over one period above, brake torque below, with limits; a leg a column.",
            chart=lambda: planned_motion_chart(planned_motion(test.plan), test.plan),
        ),
    )


def _lines(test: "PlannedTest") -> Section:
    return _with_picture(
        title="Lines and what they tell",
        words=(
            "Above, the amplitude at each test frequency. Below, how much a sine of 1 rpm at each frequency would "
            "still reduce the joint uncertainty of all numbers, per hour (D-optimality). Without limits of the "
            "peaks the test frequencies lie where this curve is highest."
        ),
        picture=Picture(
            name="lines",
            caption="Amplitudes, and how much a sine of 1 rpm would still reduce the joint uncertainty, per hour.",
            alt="Amplitudes over frequency above the information that a line gives in an hour; a leg a column.",
            chart=lambda: planned_line_chart(line_worths(test.plan)),
        ),
    )


def _length(test: "PlannedTest") -> Section:
    return _with_picture(
        title="Longer or shorter",
        words="The same lines, sailed for another number of periods: deviations fall with the root of time.",
        picture=Picture(
            name="length",
            caption="Predicted standard deviations over the length of the test.",
            alt="Falling lines of predicted deviations over the length of the test, with this plan marked.",
            chart=lambda: length_chart(length_curve(test.plan), test.plan),
        ),
    )


def _with_picture(*, title: str, words: str, picture: Picture) -> Section:
    return Section(key=picture.name, title=title, paragraphs=(words,), pictures=(picture,))


def _words(test: "PlannedTest") -> Section:
    return Section(key="words", title="In words", points=test.sentences)


def _assumed(test: "PlannedTest") -> Section:
    ship, priors = test.plan.ship, test.plan.priors
    rows = []
    for place, parameter in enumerate(ship.structure.parameters):
        std = float(ship.covariance[place, place]) ** 0.5
        prior = priors.get(parameter.name)
        rows.append(
            (
                Symbol(parameter.name),
                with_deviation(float(ship.values[place]), std),
                "" if prior is None else with_deviation(prior.mean, prior.std),
                unit_text(parameter.unit),
                "yes" if parameter.held else "",
                parameter.meaning,
            )
        )
    table = Table(
        title=f"What is assumed: {ship.structure.name}",
        columns=(*texts("quantity"), *numbers("assumed ± std", "known to the fit"), *texts("unit", "held", "meaning")),
        rows=tuple(rows),
        note="Limits are held for the ships that are possible within these deviations.",
    )
    return Section(key="assumed", title="What was assumed", tables=(table,), folded=True)


def _files(lever: "Lever | None") -> Table:
    unit = None if lever is None else lever.unit
    # a generator that puts out the lever's own unit is told how far it is from these volts
    scale = "" if lever is None else f"; U = {lever.v_per_unit:g} V/{unit} * lever + {lever.v_at_zero:g} V"
    rows = (
        (CAMPAIGN, "the test, for shaftprint sail, predict, inspect and identify"),
        (CSV, f"set point over time, in {f'{unit}, volts' if unit not in (None, 'rpm') else 'volts'} and rpm"),
        (GENERATOR, f"voltages alone, one a line, for an arbitrary waveform generator{scale}"),
        (MAT, "the same for MATLAB and Octave"),
        (PLAN, "the plan with all digits, for shaftprint continue"),
    )
    return Table(title="Files beside this page", columns=texts("file", "what it is"), rows=rows)
