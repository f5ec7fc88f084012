"""The noun of the room: what a model is worth on records that it has not seen."""

from dataclasses import dataclass

from shaftprint.arrays import FloatArray
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.validation._model import Model
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._step_comparison import StepNumber
from shaftprint.validation._validation_records import Excerpt
from shaftprint.validation.measures._delay import RemainingDelay
from shaftprint.validation.measures._misfit import Misfit, Outcome


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ExcerptTraces(Shown):
    """Data and model of one excerpt through the low-pass, for figures; deviations from the working point."""

    time_s: FloatArray
    """Time in the recording [s], shape (samples,)."""
    set_point: FloatArray
    """Set point, shape (samples,)."""
    measured: FloatArray
    """Speed and torque as measured, shape (2, samples)."""
    model: FloatArray
    """Speed and torque of the model, shape (2, samples)."""
    model_std: FloatArray
    """Standard deviation of the model by its parameters, shape (2, samples)."""
    noise_std: FloatArray
    """Standard deviation of the noise of speed and torque, shape (2,)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ExcerptComparison(Shown):
    """Model and data in one excerpt."""

    excerpt: Excerpt
    """What is compared."""
    misfits: tuple[Misfit, ...]
    """How well speed and torque are explained."""
    delays: tuple[RemainingDelay, ...]
    """Delay left over in speed and torque."""
    step_numbers: tuple[StepNumber, ...]
    """Overshoot, rise, settling and peak beside each other; empty where the excerpt is no single step."""
    traces: ExcerptTraces
    """What the numbers are made from."""

    @property
    def outcome(self) -> Outcome:
        """Fails if an output fails, passes if both pass."""
        outcomes = {misfit.outcome for misfit in self.misfits}
        return "fails" if "fails" in outcomes else "passes" if outcomes == {"passes"} else "undecided"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Validation(Shown):
    """What a model is worth on records that it was not identified from."""

    model: Model
    """What was validated."""
    settings: ValidationSettings
    """How."""
    comparisons: tuple[ExcerptComparison, ...]
    """Every excerpt, record by record."""
    outcome: Outcome
    """Fails if an excerpt that the model was not identified from fails; passes if all of them pass."""
    headline: str
    """Up to which step the model holds and what acts beyond, in one line."""
    sentences: tuple[str, ...]
    """The outcome in words, the verdict first."""
    findings: tuple[str, ...]
    """What the reader should know of how this was found."""

    def summary(self) -> Summary:
        """Return the outcome and the records that it rests on."""
        facts = {
            "outcome": self.headline,
            "excerpts": f"{len(self.comparisons)}, of which {len(self.failed)} fail",
            "records": shortened(dict.fromkeys(one.excerpt.record for one in self.comparisons)),
            "findings": str(len(self.findings)),
        }
        return Summary(title=f"Validation of {self.model.name}", facts=facts)

    @property
    def failed(self) -> tuple[ExcerptComparison, ...]:
        """Excerpts that fail, without those that the model was identified from."""
        return tuple(c for c in self.comparisons if c.outcome == "fails" and not c.excerpt.in_sample)

    def of(self, record: str, title: str) -> ExcerptComparison:
        """Return one excerpt by its record and the beginning of its title.

        Raises
        ------
        KeyError
            If there is none.
        """
        for comparison in self.comparisons:
            if comparison.excerpt.record == record and comparison.excerpt.title.startswith(title):
                return comparison
        raise KeyError(f"{record}, {title}")
