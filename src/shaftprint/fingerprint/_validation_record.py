"""What a model was worth on records that its fit had not seen, as a fingerprint keeps it."""

from typing import Literal

from shaftprint.records import Record

Outcome = Literal["passes", "fails", "undecided"]


class StretchRecord(Record):
    """Model and data in one stretch of a chirp or staircase."""

    record: str
    """Chirp or staircase."""
    title: str
    """What of it."""
    outcome: Outcome
    """Whether the error of speed and torque is surely below what is allowed, surely above, or hidden by noise."""
    error: dict[str, float]
    """Error of each output beyond noise, over its motion [-]."""
    interval_95: dict[str, tuple[float, float]]
    """Its 95 % interval."""


class ValidationRecord(Record):
    """What the model was worth on records that its fit had not seen."""

    model: str
    """Name of the structure that was held against them: with limits where they were looked for."""
    largest_error: float
    """Error over the motion up to which a stretch passes [-]."""
    outcome: Outcome
    """Fails if one stretch fails, passes if all pass."""
    headline: str
    """In one line."""
    stretches: tuple[StretchRecord, ...]
    """Every stretch."""

    @property
    def remark(self) -> str:
        """What whoever uses the model must know; empty where it passes."""
        counts = {outcome: sum(one.outcome == outcome for one in self.stretches) for outcome in ("fails", "undecided")}
        total = len(self.stretches)
        if self.outcome == "fails":
            return f"{self.model} fails its own validation in {counts['fails']} of {total} stretches: {self.headline}."
        if self.outcome == "undecided":
            return (
                f"Whether {self.model} holds is not proved: in {counts['undecided']} of the {total} steps and chirps "
                "on which it was validated noise is too large to tell; it fails on none."
            )
        return ""
