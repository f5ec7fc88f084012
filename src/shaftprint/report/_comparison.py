"""The report on two or more fingerprints: what differs by more than chance, and their responses over each other."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.catalogue._thesis import STRUCTURES, structure
from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.drift._differ import differ
from shaftprint.drift._finding import Finding
from shaftprint.drift._shared_errors import are_two_lines
from shaftprint.errors import ReportError
from shaftprint.plain_table import Table
from shaftprint.report._curve import fingerprint_curve
from shaftprint.report._page import Page, write_page
from shaftprint.report.comparison._cause_table import cause_table
from shaftprint.report.comparison._differences import Difference, differences
from shaftprint.report.comparison._tables import beside_table, condition_table, difference_table, source_table
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences, vessel_file_table
from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.figures._differences import difference_chart, shown_names
from shaftprint.report.sections._comparison_cover import comparison_cover, not_alike
from shaftprint.report.sections._sections import Picture, Section
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.models._structure import Structure
    from shaftprint.report._curve import Curve

FEWEST = 2


def render_comparison(
    directory: str | Path,
    fingerprints: "Mapping[str, Fingerprint]",
    *,
    structures: "Mapping[str, Structure] | None" = None,
    load_repeatability: float = LOAD_REPEATABILITY,
    remarks: Sequence[str] = (),
) -> Path:
    """Write a report on two or more fingerprints, ``index.html`` with its figures; return the path of the page.

    ``directory``: where the report goes; made if it does not exist. Other files there are left alone. ``fingerprints``:
    fingerprints by the name that the report gives them; the first is the one that others are compared with.
    ``structures``: structures of one's own by name; those that are shipped are known. ``load_repeatability``: as in
    ``differences``. ``remarks``: what else the tests say of the lines beside each other, in sentences. Raises
    FileExistsError if there is a report already; ReportError if there are fewer than two fingerprints, or plotly is not
    installed.
    """
    if len(fingerprints) < FEWEST:
        raise ReportError(
            f"comparison: expected two or more fingerprints, found {len(fingerprints)}; name another one."
        )
    (first_name, first), *others = fingerprints.items()
    comparisons = {name: differences(first, other, load_repeatability=load_repeatability) for name, other in others}
    findings = {name: differ(first, other, load_repeatability=load_repeatability) for name, other in others}
    page = Page(
        title="Fingerprints compared",
        subtitle=f"{', '.join(name for name, _ in others)} compared with {first_name}",
        created=max(fingerprint.created for fingerprint in fingerprints.values()),
        version=first.shaftprint_version,
        cover=comparison_cover(fingerprints, comparisons, findings),
        sections=[
            *([Section(key="beside", title="Beside each other", paragraphs=tuple(remarks))] if remarks else []),
            *_cause_sections(findings),
            *_sections(fingerprints, comparisons, structures or {}, load_repeatability),
        ],
        files=source_table(fingerprints),
        ending="± is one standard deviation throughout; bands, intervals and error bars hold 95 %.",
    )
    return write_page(directory, page)


def _cause_sections(findings: Mapping[str, Finding]) -> list[Section]:
    """Return what may have changed, a table for each comparison that could be judged along causes."""
    judged = {name: finding for name, finding in findings.items() if not finding.because}
    words = (
        "All numbers of the ship are judged together, along what may have changed: numbers of one test are known to a "
        "few per cent each and to a few per mille against each other. A cause counts where chance makes the largest "
        "score of all causes in fewer than one of twenty comparisons of an unchanged ship. Odds are how much more "
        "likely the difference is under the first cause than under another; what is not in the table may have changed "
        "too.",
    )
    not_judged = tuple(f"{name}: {finding.because}." for name, finding in findings.items() if finding.because)
    if not judged:
        return []
    return [
        Section(
            key="causes",
            title="What may have changed",
            paragraphs=(*words, *not_judged),
            tables=tuple(cause_table(name, finding) for name, finding in judged.items()),
        )
    ]


def _sections(
    fingerprints: "Mapping[str, Fingerprint]",
    comparisons: Mapping[str, Sequence[Difference]],
    structures: "Mapping[str, Structure]",
    load_repeatability: float,
) -> list[Section]:
    first = next(iter(fingerprints))
    changed = Section(
        key="differences",
        title="Differences",
        paragraphs=(
            "A number differs where the difference is more than chance makes in one of twenty comparisons, all numbers "
            "of the comparison considered; perhaps, where that holds for the number alone, which among so many numbers "
            "is common. An error that both tests share, since both vessel files state the same, counts only as far as "
            "it moves the two unequally. From day to day the torque of the propeller varies by "
            f"{PERCENT * load_repeatability:g} %, one standard deviation, beside what a test itself shows."
            f"{_of_two_lines(fingerprints)}",
            *_vessel_files(fingerprints),
        ),
        tables=_difference_tables(first, comparisons, normalised=False),
        pictures=_difference_pictures(comparisons),
    )
    moving = Section(
        key="normalised",
        title="Differences of normalised numbers",
        paragraphs=(
            "These are normalised with the speed and torque of their own test, and move with them. Where a physical "
            "value tells the same without the working point, they are not compared; the others are judged by "
            "themselves and are of the test and its sensors rather than of the ship.",
        ),
        tables=_difference_tables(first, comparisons, normalised=True),
    )
    side_by_side = Section(
        key="numbers",
        title="Numbers beside each other",
        paragraphs=_warnings(fingerprints),
        tables=beside_table(fingerprints),
    )
    files = vessel_file_table(fingerprints)
    conditions = Section(
        key="conditions",
        title="Under which conditions",
        tables=(condition_table(fingerprints), *((files,) if files.rows else ())),
    )
    return [changed, *_responses(fingerprints, structures), moving, side_by_side, conditions]


def _of_two_lines(fingerprints: "Mapping[str, Fingerprint]") -> str:
    """Return what else holds where lines of one ship are compared; nothing where one line is."""
    (_, first), *others = fingerprints.items()
    if not any(are_two_lines(first, other) for _, other in others):
        return ""
    return (
        " Two lines of one ship have drawings and engine type in common, but for a quarter of their error, which is of "
        "each piece, and no sensor."
    )


def _difference_tables(first: str, comparisons: Mapping[str, Sequence[Difference]], *, normalised: bool) -> list[Table]:
    chosen = {name: [one for one in rows if one.normalised == normalised] for name, rows in comparisons.items()}
    return [difference_table(first, name, rows) for name, rows in chosen.items() if rows]


def _difference_pictures(comparisons: Mapping[str, Sequence[Difference]]) -> list[Picture]:
    if not shown_names(comparisons):
        return []
    return [
        Picture(
            name="differences",
            caption="Difference of each number from the first fingerprint, in percent of it.",
            alt="Points with intervals, a row for each number, about a vertical line at zero difference.",
            chart=partial(difference_chart, comparisons),
        )
    ]


def _warnings(fingerprints: "Mapping[str, Fingerprint]") -> tuple[str, ...]:
    (_, first), *others = fingerprints.items()
    return tuple(sentence for name, other in others for sentence in not_alike(first, name, other))


def _vessel_files(fingerprints: "Mapping[str, Fingerprint]") -> tuple[str, ...]:
    (_, first), *others = fingerprints.items()
    return tuple(
        f"{name}: {' '.join(vessel_file_sentences(first, other))}"
        if len(others) > 1
        else " ".join(vessel_file_sentences(first, other))
        for name, other in others
    )


def _responses(fingerprints: "Mapping[str, Fingerprint]", structures: "Mapping[str, Structure]") -> list[Section]:
    """Return the responses of all models that describe what the first one does, over each other."""
    curves: dict[str, Curve] = {}
    unknown: list[str] = []
    for name, fingerprint in fingerprints.items():
        model = structures.get(fingerprint.structure)
        if model is None and fingerprint.structure in STRUCTURES:
            model = structure(fingerprint.structure)
        if model is None:
            unknown.append(name)
            continue
        curves[name] = fingerprint_curve(fingerprint, model, name)
    if not curves:
        return []
    channels = next(iter(curves.values())).structure.channels
    shown = [curve for curve in curves.values() if curve.structure.channels == channels]
    unknown += [name for name, curve in curves.items() if curve.structure.channels != channels]
    words = (f"Not drawn, since its structure is another or not known here: {', '.join(unknown)}.",) if unknown else ()
    picture = Picture(
        name="responses",
        caption="Identified models with their 95 % bands. Normalised with the working point of each test.",
        alt="Bode diagram of all identified models over each other, with bands.",
        chart=partial(bode_chart, shown),
    )
    return [Section(key="responses", title="Responses", paragraphs=words, pictures=(picture,))]
