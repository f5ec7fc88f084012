"""What a verdict is judged from, each thing found once."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._line_quality import good_channels
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.judgement._search_report import SearchReport, report_search
from shaftprint.identify.uncertainty._profile import Profile
from shaftprint.models._delays import Delay
from shaftprint.models._margins import Margins

if TYPE_CHECKING:
    from shaftprint.spectra.lines._signal_to_noise import SignalToNoise


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Evidence:
    """A fit with what speaks for and against it."""

    identification: Identification
    """The fit."""
    profile: Profile | None
    """Its profile likelihood."""
    requirements: Requirements
    """What it must satisfy."""
    good: tuple[BoolArray, ...]
    """Which channels of which fitted lines are good, of every frequency response, shape (channels, lines)."""
    search: SearchReport
    """The optima of the search."""
    margins: Margins | None
    """Stability margins; None for a structure without feedback."""
    loop: Literal["ample", "small", "unstable"] | None
    """What they amount to."""

    @classmethod
    def of(
        cls,
        identification: Identification,
        profile: Profile | None,
        signal_to_noise: "SignalToNoise | None",
        requirements: Requirements,
    ) -> "Evidence":
        """Gather what the verdict needs."""
        margins = identification.margins
        return cls(
            identification=identification,
            profile=profile,
            requirements=requirements,
            good=tuple(
                good_channels(experiment, signal_to_noise, requirements)
                for experiment in identification.objective.experiments
            ),
            search=report_search(identification),
            margins=margins,
            loop=None if margins is None else _judged(margins, loop_delay_s(identification), requirements),
        )

    @property
    def good_lines(self) -> int:
        """Number of fitted lines of which some channel is good."""
        return sum(int(np.any(good, axis=0).sum()) for good in self.good)

    @property
    def good_omega_rad_s(self) -> FloatArray:
        """Frequencies of these lines, of all responses [rad/s], in order, shape (good lines,)."""
        experiments = self.identification.objective.experiments
        each = [one.s.imag[np.any(good, axis=0)] for one, good in zip(experiments, self.good, strict=True)]
        return np.sort(np.concatenate(each))

    @property
    def good_data(self) -> int:
        """Number of good data: two a channel of a line, and all of records, where noise is weighed by its colour."""
        records = sum(term.data_count for term in self.identification.objective.others)
        return 2 * sum(int(good.sum()) for good in self.good) + records


def loop_delay_s(identification: Identification) -> float:
    """Return the sum of the delays inside the feedback loop [s]."""
    loop = identification.structure.loop
    blocks = [] if loop is None else [node for node in loop.nodes() if isinstance(node, Delay)]
    return sum(identification.value(block.time.name) for block in blocks)


def gain_reserve(margins: Margins) -> float:
    """Return the factor by which the loop gain may grow, or shrink, before the loop hunts."""
    return max(margins.gain_margin, 1.0 / margins.gain_margin)


def _judged(margins: Margins, delay_s: float, requirements: Requirements) -> Literal["ample", "small", "unstable"]:
    if not margins.stable:
        return "unstable"
    small = (
        gain_reserve(margins) < requirements.gain_margin
        or np.degrees(abs(margins.phase_margin_rad)) < requirements.phase_margin_deg
        or margins.delay_margin_s < requirements.delay_margin_share * delay_s
    )
    return "small" if small else "ample"
