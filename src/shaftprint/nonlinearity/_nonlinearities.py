"""The noun of the room: which nonlinearities a recording shows, with the evidence."""

from collections.abc import Mapping
from dataclasses import dataclass

from shaftprint.nonlinearity._harmonic_evidence import HarmonicEvidence
from shaftprint.nonlinearity._level_evidence import LevelEvidence
from shaftprint.nonlinearity._limit_evidence import LimitEvidence
from shaftprint.nonlinearity._step_evidence import StepEvidence
from shaftprint.nonlinearity._suspects import Kind


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """One number that belongs to a nonlinearity."""

    name: str
    """Symbol, such as ``m_max``."""
    value: float
    """Its value."""
    std: float
    """Standard deviation, from the curvature of the likelihood."""
    unit: str
    """Unit; ``-`` without one."""
    meaning: str
    """What it is, in words."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Finding:
    """One nonlinearity that is present."""

    kind: Kind
    """Which one."""
    evidence: str
    """What speaks for it, in words with numbers."""
    estimates: tuple[Estimate, ...] = ()
    """Its level, rate or width: start values of a nonlinear fit."""
    statistic: float
    """Fall of minus twice the log-likelihood."""
    p_value: float
    """Probability of such a fall by chance, for all that was tried together."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Suspicion:
    """One nonlinearity that was looked for, found or not."""

    kind: Kind
    """Which one."""
    statistic: float
    """Largest fall of minus twice the log-likelihood when it was looked for last."""
    p_value: float
    """Its probability by chance."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nonlinearities:
    """Which nonlinearities a recording shows beyond the quadratic propeller."""

    findings: tuple[Finding, ...]
    """What was found, in the order of strength; ``quadratic propeller only`` alone where there is nothing else."""
    sentence: str
    """All of it in a sentence."""
    suspicions: tuple[Suspicion, ...]
    """Everything that was looked for and not found."""
    false_alarm: float
    """Level of the tests: how often a linear line would show a finding."""
    governor: Mapping[str, float]
    """The governor behind the findings, normalised at the working point."""
    governor_std: Mapping[str, float]
    """Standard deviations of the fitted ones."""
    harmonics: HarmonicEvidence | None
    """Harmonics of the sines; nothing where the campaign has none."""
    levels: LevelEvidence
    """Gain and delay of governor and engine, test by test."""
    steps: StepEvidence
    """Numbers of each step against those of a linear governor on a quadratic propeller."""
    limits: LimitEvidence
    """Torque against speed while a limit acts."""

    @property
    def linear(self) -> bool:
        """Whether nothing but the propeller is nonlinear."""
        return self.findings[0].kind == "quadratic propeller only"

    @property
    def start_values(self) -> dict[str, float]:
        """Values of the estimates by symbol: where a nonlinear fit may begin."""
        return {estimate.name: estimate.value for finding in self.findings for estimate in finding.estimates}
