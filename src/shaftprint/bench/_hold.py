"""Whether inputs hold from sample to sample or go straight: found from the records, or held against them.

The two differ by half a sample of delay, which a structure with a free delay or lag takes for its own. Where an input
jumps within one sample they differ in what they explain too, and both are fitted.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._per_record import with_structures
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.reasons import Reason
from shaftprint.time_domain._identify_in_time import TimeSettings, identify_in_time
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record

# Squared changes of the changes over squared changes: 2 of a jump, 0.5 of a sine of nine samples.
JUMPS = 0.5
# Deviance by which one way is the better: e^5, 150 times more likely.
BETTER = 10.0
# Where neither is, numbers that differ by more of their standard deviations rest on which it is.
APART = 1.0
WAYS = {True: "hold from sample to sample", False: "go straight from sample to sample"}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class InputWay:
    """How inputs go between samples, and the fit with that."""

    fit: Identification
    """The fit."""
    hold: bool
    """Whether inputs hold."""
    reasons: tuple[Reason, ...] = ()
    """What speaks against it."""
    assumptions: tuple[str, ...] = ()
    """What was found of it, in a sentence."""


def jump_within_a_sample(record: Record) -> bool:
    """Return whether some input jumps from one sample to the next."""
    return any(jumps(values) for values in record.inputs.values())


def input_way(
    one: EquippedDrive, fit: Identification, records: Sequence[Record], *, settings: Settings, time: TimeSettings
) -> InputWay:
    """Return how inputs go between samples: as the drive file says, or as explains the records better.

    ``fit``: the fit to records as they were read. ``settings``, ``time``: how it was searched and compared.
    """
    hold, says = records[0].hold, one.drive.fit.inputs_hold
    if not any(jump_within_a_sample(record) for record in records):
        return InputWay(fit=fit, hold=hold)
    try:
        other = _fitted_otherwise(one, fit, records, settings=settings, time=time)
    except IdentificationError:
        # it runs away from there: no way to be told
        return InputWay(fit=fit, hold=hold)
    gain = _deviance(fit) - _deviance(other)
    if says is None and abs(gain) >= BETTER:
        fit, hold = (other, not hold) if gain > 0.0 else (fit, hold)
        found = f"the inputs {WAYS[hold]}, which explains the records better than the other way by {abs(gain):.0f}"
        return InputWay(fit=fit, hold=hold, assumptions=(f"{found} of deviance.",))
    if says is not None and gain >= BETTER:
        sentence = (
            f"Inputs that {WAYS[not hold]} explain the records better than those that {WAYS[hold]}, as the drive file "
            f"says, by {gain:.0f} of deviance; write inputs_hold = {str(not hold).lower()} in [fit], or leave it out."
        )
        return InputWay(fit=fit, hold=hold, reasons=(Reason(kind="record", where="inputs", sentence=sentence),))
    apart = _apart(fit, other)
    if says is None and apart:
        sentence = (
            f"The records do not tell whether inputs hold from sample to sample or go straight, and {apart} rests on "
            "it; write inputs_hold = true in [fit] where a computer or drive put them out, false where they were "
            "sampled."
        )
        return InputWay(fit=fit, hold=hold, reasons=(Reason(kind="record", where="inputs", sentence=sentence),))
    return InputWay(fit=fit, hold=hold)


def jumps(values: FloatArray) -> bool:
    """Return whether a signal jumps from one sample to the next."""
    changes = np.diff(values)
    return bool(np.sum(np.diff(changes) ** 2) > JUMPS * np.sum(changes**2))


def _fitted_otherwise(
    one: EquippedDrive, fit: Identification, records: Sequence[Record], *, settings: Settings, time: TimeSettings
) -> Identification:
    """Return the fit, from its optimum, with inputs that go the other way."""
    turned = with_structures(one, [replace(record, hold=not record.hold) for record in records])
    values = {p.name: p.value for p in fit.parameters}
    settings = replace(settings, starts=1, draw=GivenStarts(np.array([list(values.values())])))
    return identify_in_time(turned, rng=np.random.default_rng(0), settings=settings, time=time, start=values)


def _deviance(fit: Identification) -> float:
    """Return the deviance of a fit with the noise that it found itself: what chi-square leaves out is its size."""
    return 2.0 * fit.cost + noise_left(fit)


def noise_left(fit: Identification) -> float:
    """Return the logarithm of what the noise models hold, the determinant of innovations over all samples."""
    terms = [term for term in fit.objective.terms if isinstance(term, OutputError)]
    return float(sum(term.record.used.sum() * np.linalg.slogdet(term.whitening.noise.covariance)[1] for term in terms))


def _apart(fit: Identification, other: Identification) -> str:
    """Return the number that differs most between two fits, in its standard deviations; empty where none differs."""
    differences = {
        one.name: abs(one.value - two.value) / one.std
        for one, two in zip(fit.parameters, other.parameters, strict=True)
        if np.isfinite(one.std) and one.std > 0.0
    }
    name = max(differences, key=differences.__getitem__, default="")
    return name if name and differences[name] > APART else ""
