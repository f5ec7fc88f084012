"""The noun of the room: what is kept of one test, as a JSON record."""

import math
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, ClassVar, Final, Literal, Self

import numpy as np
from pydantic import Field, NonNegativeFloat

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.fingerprint._conditions import Conditions
from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum
from shaftprint.fingerprint._line_fingerprint import LineFingerprint
from shaftprint.fingerprint._line_with_limits import LineWithLimits
from shaftprint.fingerprint._number import Number
from shaftprint.fingerprint._validation_record import ValidationRecord
from shaftprint.fingerprint._vessel_fields import FieldValue
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.uncertainty._budget import Budget, BudgetRow
from shaftprint.notebook._labelled import Labelled, LabelledData
from shaftprint.notebook._labelled_rows import labelled_rows
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.records import Record

SCHEMA_VERSION: Final = "2.2"
"""Version of the layout: the second number grows with what is added to it, see ``docs/fingerprint-file.md``."""


class Quality(Record):
    """How well the model explains the data, and how good the data were."""

    weighting: str
    """How the lines were weighed against each other, ``MaximumLikelihood`` or ``Unweighted``."""

    fit_percent: dict[str, float]
    """FitPercent of each output (thesis eq. 2.41)."""
    fit_ceiling: dict[str, float]
    """FitPercent that the noise allows."""
    chi_square: float | None
    """Sum of squared weighted residuals, of the order of ``degrees_of_freedom`` when the model explains the data; None
    for a fit that was not weighted by the covariance."""
    p_value: float | None
    """Probability of a sum that large or larger if the model holds; None where there is nothing to test."""
    degrees_of_freedom: int
    """Number of data and priors minus the number of free parameters."""
    starts: int
    """Starts of the search."""
    starts_at_optimum: int
    """How many of them reached the result."""
    snr_overall: dict[str, float]
    """Overall signal-to-noise ratio of each channel (thesis eq. 3.9)."""
    snr_local_db: dict[str, dict[str, float]]
    """Local signal-to-noise ratio by channel and line [dB] (thesis eq. 3.10)."""
    repairs: dict[str, int]
    """Number of repairs by channel and kind."""
    remarks: tuple[str, ...]
    """What was found on the signals, and on test lines that were fitted all the same."""


class Fingerprint(Labelled, LineFingerprint):
    """Physical and normalised parameters of one propulsion line with uncertainty, margins and conditions."""

    noun: ClassVar[str] = "ship"

    schema_version: Literal["2.2"] = SCHEMA_VERSION
    """Version of this record's layout."""
    conditions: Conditions
    """Where it holds."""
    legs: tuple[LegRecord, ...] = ()
    """Legs of the test that were fitted, in order of time; empty for a test of sines."""
    noise: tuple[NoiseSpectrum, ...] = ()
    """Noise under the test lines at each engine speed; empty where it was not measured."""
    torque_ripple: NonNegativeFloat | None = None
    """Torque of orders and noise at the gauge over the load, which one raw sample in a hundred passes; None where it
    was not measured."""
    physical: tuple[Number, ...]
    """Physical values, each with what was expected."""
    margins: tuple[Number, ...]
    """Stability margins; empty for a structure without feedback."""
    budget: Budget
    """Which source contributes how much to the variance of parameters, combinations, physical values and margins; a
    number of which the test says nothing is left out."""
    vessel_fields: dict[str, FieldValue] = Field(default_factory=dict)
    """What the vessel file states, field by field, so that two tests know which errors they share; empty in the file of
    an earlier version."""
    calibration: tuple[Number, ...]
    """What the recording itself told of its sensors: the set-point line and the angles of the strips."""
    quality: Quality
    """Fit and data quality."""
    with_limits: LineWithLimits | None = None
    """The same line with its limits, for large moves; None where limits were not looked for."""
    validation: ValidationRecord | None = None
    """What the model was worth on records that its fit had not seen; None where it was held against none."""
    findings: tuple[str, ...]
    """What a reader must know, in words."""

    def summary(self) -> Summary:
        """Return of what it is, the verdict, and which numbers may be used."""
        verdict, test = self.verdict, self.conditions
        facts = {
            "test": f"{test.campaign}, structure {self.structure}",
            "place": test.place or "",
            "date": "" if test.tested_at is None else f"{test.tested_at:%Y-%m-%d}",
            "made": f"{self.created:%Y-%m-%d %H:%M %Z}, shaftprint {self.shaftprint_version}",
            "verdict": verdict.reason,
            "known well enough": f"{len(verdict.trusted)} of {len(verdict.trusted) + len(verdict.not_trusted)}: "
            + shortened(verdict.trusted),
            "findings": str(len(self.findings)),
        }
        return Summary(title=f"Fingerprint of {test.vessel}", facts=facts)

    @property
    def tested(self) -> Conditions:
        """The conditions."""
        return self.conditions

    def dated(self, at: datetime) -> Self:
        """Return it with another time of the test."""
        return self.model_copy(update={"conditions": self.conditions.model_copy(update={"tested_at": at})})

    @property
    def title(self) -> str:
        """Name of the vessel and shaft line."""
        return self.conditions.vessel

    @property
    def stated_fields(self) -> Mapping[str, FieldValue]:
        """What the vessel file states, field by field; empty in the file of an earlier version."""
        return self.vessel_fields

    @property
    def error_sources(self) -> Sequence[str]:
        """What the errors of the numbers come from, in the order of the budget."""
        return self.budget.sources

    @property
    def budget_rows(self) -> Sequence[BudgetRow]:
        """Where the variance of each number comes from."""
        return self.budget.rows

    @property
    def misfit(self) -> float:
        """By how much the residuals of the fit are larger than its noise, as a variance; 1 at least."""
        quality = self.quality
        if quality.chi_square is None or quality.degrees_of_freedom <= 0:
            return 1.0
        return max(quality.chi_square / quality.degrees_of_freedom, 1.0)

    @property
    def numbers(self) -> dict[str, tuple[Estimate, ...]]:
        """All numbers, by what they are."""
        return {
            "parameter": self.parameters,
            "combination": self.combinations,
            "physical value": self.physical,
            "margin": self.margins,
            "calibration": self.calibration,
        }

    @property
    def working_point(self) -> Sequence[Estimate]:
        """Engine speed and shaft torque about which the numbers hold."""
        return (self.conditions.engine_speed, self.conditions.shaft_torque)

    @property
    def noise_at_speeds(self) -> dict[float, NoiseLevels]:
        """The noise by engine speed [rpm], as planning takes it."""
        return {spectrum.engine_speed_rpm: spectrum.levels() for spectrum in self.noise}

    def labelled(self) -> LabelledData:
        """Return a row for each number, with its interval and what was expected; and the covariance of parameters."""
        facts = {"vessel": self.conditions.vessel, "campaign": self.conditions.campaign, "structure": self.structure}
        facts |= {"created": self.created.isoformat()}
        return labelled_numbers(self.numbers, np.array(self.covariance), facts, doubts=self.verdict.not_trusted)

    def multiplied(self, number: Estimate) -> Estimate | None:
        """Return the parameter of which a physical value is a multiple; None where it is none.

        A gain on a logged rack is none: its physical value is multiplied by the slope of the rack, which is found too.
        """
        role = number.role
        if role is None or role.physical is None or role.physical.name != number.name:
            return None
        by_role = {parameter.role: parameter for parameter in self.parameters}
        return None if role.rack_power and ShipRole.ENGINE_RACK_SLOPE in by_role else by_role.get(role)


def labelled_numbers(
    numbers: Mapping[str, Sequence[Estimate]],
    covariance: FloatArray,
    facts: Mapping[str, str],
    *,
    doubts: Mapping[str, str],
) -> LabelledData:
    """Return a row for each number; what is not known is nan.

    ``numbers``: the numbers by what they are. ``covariance``: covariance of the parameters, shape (parameters,
    parameters). ``facts``: on the whole. ``doubts``: why numbers are not to be used, by name.
    """
    kinds = [kind for kind, quantities in numbers.items() for _ in quantities]
    rows = [quantity for quantities in numbers.values() for quantity in quantities]
    ends = [quantity.ends_95 for quantity in rows]
    doubted = [doubts.get(quantity.name, quantity.doubt) for quantity in rows]
    columns: dict[str, tuple[Sequence[Any], str]] = {
        "value": ([one.value for one in rows], "estimate"),
        "std": ([_number(one.stated_std) for one in rows], "standard deviation"),
        "lower_95": ([lower for lower, _ in ends], "lower end of the 95 % interval"),
        "upper_95": ([upper for _, upper in ends], "upper end of the 95 % interval"),
        "lower_at_bound": ([one.interval_open[0] for one in rows], "whether the lower end is a bound of the search"),
        "upper_at_bound": ([one.interval_open[1] for one in rows], "whether the upper end is a bound of the search"),
        "at_bound": ([one.at_bound for one in rows], "whether the search stopped at a bound"),
        "expected": ([_number(one.expected) for one in rows], "value from the vessel file"),
        "expected_std": ([_number(one.expected_std) for one in rows], "standard deviation of that value"),
        "trusted": ([not doubt for doubt in doubted], "whether the number may be used"),
    }
    texts = {
        "number": [one.name for one in rows],
        "kind": kinds,
        "unit": [one.unit for one in rows],
        "meaning": [one.meaning for one in rows],
        "doubt": doubted,
    }
    uncertain = [one.name for one in numbers["parameter"]]
    return labelled_rows("number", texts, columns, uncertain=uncertain, covariance=covariance, facts=facts)


def _number(value: float | None) -> float:
    return math.nan if value is None else value
