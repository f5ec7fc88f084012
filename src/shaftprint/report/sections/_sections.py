"""What a report is made of: sections with words, tables and pictures."""

import hashlib
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shaftprint.plain_table import Table

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.clocks._logger_clock import LoggerClock
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.comparison._black_box import BlackBox
    from shaftprint.identify.comparison._comparison import StructureComparison
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.models._structure import Structure
    from shaftprint.recording._levels import Levels
    from shaftprint.recording._recording import Recording
    from shaftprint.report.charts._chart import Chart
    from shaftprint.signals._signals import Signals
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.spectra._spectra import Spectra
    from shaftprint.survey._legs import LegMeasurement, LegTest
    from shaftprint.survey._thesis_mode import ThesisMode
    from shaftprint.validation._validation import Validation
    from shaftprint.vessel._vessel import Vessel

# Words of which the name of a picture says all but capitals and marks between them.
_LONGEST = 60
_PLAIN = re.compile(rf"[A-Za-z0-9 ._-]{{0,{_LONGEST}}}")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Inputs:
    """Everything that a report may show; see ``render_report``."""

    fingerprint: "Fingerprint"
    identification: "Identification"
    signals: "Signals"
    spectra: "Spectra"
    vessel: "Vessel"
    campaign: "Campaign"
    recording: "Recording | None"
    fits: Mapping[str, "Identification"]
    thesis: "ThesisMode | None"
    truth: Mapping[str, float]
    line_selection: Mapping[str, "FrequencyResponse"]
    comparisons: Sequence["StructureComparison"]
    sensitivity: Sequence["Structure"]
    validations: Sequence["Validation"] = ()
    clocks: Sequence["LoggerClock"] = ()
    previous: "Fingerprint | None" = None
    levels: Mapping[str, "Levels"] = field(default_factory=dict)
    legs: Sequence["LegMeasurement"] = ()
    leg_tests: Sequence["LegTest"] = ()
    black_boxes: Sequence["BlackBox"] = ()

    @property
    def aliasing_limit_hz(self) -> float:
        """Half the pulse rate of the identified speed sensor [Hz]."""
        return self.signals.engine_speed.nyquist_hz


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Picture:
    """A figure of the report, drawn when it is needed."""

    name: str
    """File name without suffix."""
    caption: str
    """What the figure shows, below it."""
    alt: str
    """What the figure shows, for those who cannot see it."""
    chart: "Callable[[], Chart]"
    """Describes it when it is needed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Section:
    """A part of the report under one heading."""

    key: str
    """Anchor of the heading."""
    title: str
    """Heading."""
    paragraphs: Sequence[str] = ()
    """Text before all else."""
    points: Sequence[str] = ()
    """Findings, one a line."""
    tables: Sequence[Table] = ()
    """Tables."""
    pictures: Sequence[Picture] = ()
    """Figures."""
    folded: bool = False
    """Whether it belongs to the appendix, and is read when it is opened."""


def picture_name(*words: str) -> str:
    """Return words, some of them a user's, as the name of a picture: what an address could not hold is a hyphen.

    A word that is long or of other letters has a mark of its own besides: of two legs each has its picture.
    """
    return "_".join(map(_addressed, words))


def _addressed(word: str) -> str:
    plain = re.sub(r"[^a-z0-9-]+", "-", word.lower()).strip("-")
    if _PLAIN.fullmatch(word):
        return plain
    return f"{plain[:_LONGEST]}-{hashlib.sha256(word.encode('utf-8', 'replace')).hexdigest()[:8]}".strip("-")
