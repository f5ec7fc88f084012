"""The page inside an FMU that says what it is: the file of FMI's standard, ``documentation/index.html``."""

from collections.abc import Iterable, Sequence

from shaftprint.digits import plain_letters, stated
from shaftprint.escape import html_text
from shaftprint.export._fmu_description import FmuDescription
from shaftprint.export._model import ExportedModel

_STYLE = "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse}"
_CELLS = "th,td{text-align:left;padding:.2em 1em .2em 0;border-bottom:1px solid #ccc;vertical-align:top}"


def documentation(model: ExportedModel, d: FmuDescription, *, internal_step_s: float, largest_step_s: float) -> str:
    """Return a page in HTML: what it is of, inputs and outputs, parameters with deviations, step size, source.

    ``internal_step_s``: step of co-simulation [s]. ``largest_step_s``: longest step that stays stable [s]; 0 where any
    does.
    """
    signals = [
        (one.name, one.causality, one.unit or "-", one.meaning)
        for one in d.variables
        if one.causality in ("input", "output")
    ]
    std = model.std
    parameters = [
        (
            p.name,
            stated(float(value), std[p.name], "") if p.name in std else f"{value:.6g}",
            p.unit or "-",
            p.meaning,
        )
        for p, value in zip(model.structure.parameters, model.values, strict=True)
    ]
    stable = f" Steps of more than {1e3 * largest_step_s:.2g} ms are unstable." if largest_step_s else ""
    about = (
        f"About {model.engine_speed_rpm:.1f} rpm of the engine and {model.shaft_torque_nm:.0f} N m at the gauge; "
        "inputs and outputs are whole values, not deviations from there."
        if model.is_of_a_ship
        else "Inputs and outputs are whole values."
    )
    use = (
        "Co-simulation and model exchange; choose co-simulation where the tool has it."
        if d.model_exchange
        else "Co-simulation only."
    )
    parts = [
        f"<h1>{html_text(d.title)}</h1>",
        *_paragraphs([f"{model.structure.title}, {model.structure.name}.", model.remark, about, use]),
        "<h2>Inputs and outputs</h2>",
        _table(("name", "is", "unit", "what it is"), signals),
        "<h2>Parameters</h2>",
        *_paragraphs(["Values with one standard deviation, of those that were identified; all of them can be tuned."]),
        _table(("name", "value", "unit", "what it is"), parameters),
        "<h2>Step</h2>",
        *_paragraphs([f"In co-simulation it takes steps of {1e3 * internal_step_s:g} ms by itself.{stable}"]),
        "<h2>Where it is from</h2>",
        *_paragraphs([model.source or "Not said."]),
    ]
    body = "\n".join(plain_letters(part) for part in parts)
    head = f'<meta charset="utf-8"><title>{html_text(d.title)}</title><style>{_STYLE}{_CELLS}</style>'
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head>\n<body>\n{body}\n</body></html>\n'


def _paragraphs(sentences: Iterable[str]) -> list[str]:
    return [f"<p>{html_text(sentence)}</p>" for sentence in sentences if sentence]


def _table(titles: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    head = "".join(f"<th>{html_text(one)}</th>" for one in titles)
    lines = ["".join(f"<td>{html_text(cell)}</td>" for cell in row) for row in rows]
    return f"<table><tr>{head}</tr>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"
