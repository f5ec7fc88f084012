"""The section of a report on what the data say without physics, where the structure is refused."""

from functools import partial
from typing import TYPE_CHECKING

from shaftprint.digits import plain
from shaftprint.identify.comparison._black_box import EXPLAINS
from shaftprint.identify.judgement._phrases import probability
from shaftprint.plain_table import Symbol, Table, numbers, texts
from shaftprint.report.figures._black_box import black_box_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section, picture_name

if TYPE_CHECKING:
    from shaftprint.identify.comparison._black_box import BlackBox


def black_box_section(inputs: Inputs) -> list[Section]:
    """Return the flexible models beside a refused structure; nothing where there are none."""
    if not inputs.black_boxes:
        return []
    return [
        Section(
            key="black_box",
            title="What the data say without physics",
            paragraphs=[black_box_sentence(one) for one in inputs.black_boxes],
            tables=[_correlation_table(one) for one in inputs.black_boxes],
            pictures=[
                Picture(
                    name=picture_name("black_box", one.name),
                    caption=f"{one.name}: data, the flexible model with its 95 % band, and {one.structure}.",
                    alt="Bode diagram of data, a flexible model with its band, and the structure that is refused.",
                    chart=partial(black_box_chart, one),
                )
                for one in inputs.black_boxes
            ],
        )
    ]


def black_box_sentence(found: "BlackBox") -> str:
    """Return whether any linear model explains a response, and where the structure leaves it."""
    chance = probability(found.p_value)
    output, hertz, decibels, degrees = found.furthest
    where = (
        f"{found.structure} is furthest from it at {plain(hertz, 3)} Hz in {output}: {decibels:+.1f} dB and "
        f"{round(degrees):+d} deg."
    )
    model = f"a rational model of order {found.order} with a delay of {plain(1000.0 * found.delay_s, 0)} ms"
    if found.p_value >= EXPLAINS:
        return (
            f"{found.name}: {model} explains the response within its noise ({chance}), so one linear line made the "
            f"data, and the structure lacks something or was given something wrong. {where}"
        )
    return (
        f"{found.name}: not even {model} explains the response ({chance}): the line changed during the test, does not "
        f"act linearly, or the noise is larger than it seems; another structure does not help. {where}"
    )


def _correlation_table(found: "BlackBox") -> Table:
    return Table(
        title=f"Residuals of neighbouring test frequencies, {found.name}",
        columns=(*texts("residuals of"), *numbers("lines apart", found.structure, "flexible model", "95 % bound ±")),
        rows=tuple(
            (Symbol(what), str(lag), plain(structure, 2), plain(flexible, 2), plain(bound, 2))
            for what, lag, structure, flexible, bound in found.correlations()
        ),
        note="Correlation with themselves and with each other; beyond the bound a model misses what goes on over "
        "several frequencies.",
        symbols=True,
    )
