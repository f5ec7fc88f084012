"""What is kept of one test, whatever was tested: a line of a ship, or a drive on a bench.

A store, a history and the search for drift take this; what only a ship has is in ``Fingerprint``, what only a drive
has in ``DriveFingerprint``.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from pydantic import AwareDatetime, model_validator

from shaftprint.arrays import FloatArray, block_of
from shaftprint.errors import FingerprintError, NoSuchNumberError
from shaftprint.fingerprint._conditions import Tested
from shaftprint.fingerprint._covariance_check import covariance_fault
from shaftprint.fingerprint._joint_numbers import JointNumbers
from shaftprint.fingerprint._number import Number
from shaftprint.fingerprint._vessel_fields import FieldValue
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.judgement._verdict import Verdict
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.uncertainty._budget import BudgetRow
from shaftprint.notebook._shown import Shown
from shaftprint.records import Record
from shaftprint.spelling import meant


class SourceFile(Record):
    """A file that went into the fingerprint."""

    role: Literal["recording", "vessel", "campaign", "structure", "drive"]
    """What it is."""
    name: str
    """File name or the name of a shipped file."""
    sha256: str
    """SHA-256 of its content."""


class LineFingerprint(Shown, Record):
    """Numbers of one line with uncertainty, what they rest on, and whether they may be used."""

    noun: ClassVar[str]
    """What is tested, in a word."""

    schema_version: str
    """Version of this record's layout."""
    shaftprint_version: str
    """Version of shaftprint that made it."""
    created: AwareDatetime
    """When it was made, with time zone."""
    sources: tuple[SourceFile, ...]
    """Recordings and files of settings with their hashes."""
    structure: str
    """Name of the model structure."""
    parameters: tuple[Number, ...]
    """Free parameters."""
    held: dict[str, float]
    """Parameters that were held, with their values."""
    priors: dict[str, Prior]
    """Parameters of which something was known before the test; it counts in the standard deviations."""
    covariance: tuple[tuple[float, ...], ...]
    """Covariance of the free parameters, in their order."""
    combinations: tuple[Number, ...]
    """Combinations of parameters."""
    joint: JointNumbers | None = None
    """Covariance of the numbers of the line together, by which two tests are compared along causes; None in the file of
    an earlier version."""
    verdict: Verdict
    """Whether the numbers may be used, and which of them."""

    @model_validator(mode="after")
    def _expect_covariance(self) -> Self:
        fault = covariance_fault(self.covariance, [quantity.std for quantity in self.parameters])
        if fault:
            raise ValueError(f"covariance: {fault}")
        there = {quantity.name for quantities in self.numbers.values() for quantity in quantities}
        foreign = [] if self.joint is None else [name for name in self.joint.names if name not in there]
        if foreign:
            raise ValueError(f"joint: expected names of its numbers, found {foreign[0][:100]!r}")
        return self

    @property
    @abstractmethod
    def tested(self) -> Tested:
        """What was tested, when and where."""

    @abstractmethod
    def dated(self, at: datetime) -> Self:
        """Return it with another time of the test."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What the line is called."""

    @property
    @abstractmethod
    def numbers(self) -> dict[str, tuple[Estimate, ...]]:
        """All numbers, by what they are."""

    @property
    def stated_fields(self) -> Mapping[str, FieldValue]:
        """What the vessel file states, field by field; empty where there is none."""
        return {}

    @property
    def error_sources(self) -> Sequence[str]:
        """What the errors of the numbers come from, as far as it was stated beforehand."""
        return () if self.joint is None else tuple(self.joint.loadings)

    @property
    def budget_rows(self) -> Sequence[BudgetRow]:
        """Where the variance of each number comes from; empty where it was not looked for."""
        return ()

    @property
    def misfit(self) -> float:
        """By how much the residuals of the fit are larger than its noise, as a variance; 1 at least."""
        return 1.0

    @property
    def recording_sha256(self) -> str | None:
        """SHA-256 of the recording; None where the file does not say it."""
        return next((one.sha256 for one in self.sources if one.role == "recording"), None)

    @property
    def values(self) -> dict[str, float]:
        """Every parameter by its name, held ones too."""
        return self.held | {quantity.name: quantity.value for quantity in self.parameters}

    @property
    def by_name(self) -> dict[str, Estimate]:
        """All numbers by their names, those of the working point too."""
        every = [*self.working_point, *(quantity for kind in self.numbers.values() for quantity in kind)]
        return {quantity.name: quantity for quantity in every}

    @property
    def working_point(self) -> Sequence[Estimate]:
        """Speed and torque about which the numbers hold; empty for what has no such point."""
        return ()

    if not TYPE_CHECKING:  # or every attribute would be one for the type checker

        def __getattr__(self, name: str) -> Any:
            """Say where a number or a picture is that was looked for as an attribute."""
            try:
                return super().__getattr__(name)
            except AttributeError as error:
                if name in ("bode", "plot"):
                    raise AttributeError(f"{error}; sp.report.plot(fingerprint) draws it.") from None
                if not name.startswith("_") and name in self.by_name:
                    raise AttributeError(f"{error}; its numbers are items: fingerprint[{name!r}].") from None
                raise

    def __getitem__(self, name: str) -> Estimate:
        """Return one of its numbers, as ``quantity`` does."""
        return self.quantity(name)

    def __contains__(self, name: object) -> bool:
        """Return whether one of its numbers has a name."""
        return name in self.by_name

    def _ipython_key_completions_(self) -> list[str]:
        """Return what a session completes behind a bracket."""
        return [*self.by_name]

    def quantity(self, name: str) -> Estimate:
        """Return one of its numbers by its name, as tables have it; its ``doubt`` is what the verdict says of it.

        Raises NoSuchNumberError, which is a KeyError, if there is none of that name.
        """
        by_name = self.by_name
        if name in by_name:
            found = by_name[name]
            return replace(found, doubt=self.verdict.not_trusted.get(name, found.doubt))
        if name in self.held:
            raise NoSuchNumberError(
                f"expected one of the numbers that were found, found {name!r}, which was held at {self.held[name]:g}; "
                "take it from held."
            )
        raise NoSuchNumberError(f"the fingerprint has no {name!r}.{meant(name, by_name)} It has {', '.join(by_name)}.")

    def multiplied(self, number: Estimate) -> Estimate | None:
        """Return the parameter of which a physical value is a multiple; None where it is none."""
        return None

    def covariance_of(self, names: Sequence[str]) -> FloatArray:
        """Return the covariance of some of the parameters, shape (names, names).

        Raises FingerprintError if one of them is not a free parameter.
        """
        order = [quantity.name for quantity in self.parameters]
        foreign = [name for name in names if name not in order]
        if foreign:
            raise FingerprintError(f"the fingerprint has no parameter {foreign[0]!r}; it has {', '.join(order)}.")
        return block_of(self.covariance, order, names)
