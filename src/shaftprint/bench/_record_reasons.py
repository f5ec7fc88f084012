"""What speaks against the numbers of a drive in how its records were taken: held values, a start in motion, offsets."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._held_values import kept_for
from shaftprint.digits import rounded, stated
from shaftprint.drive._signals import Signal
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._optima import WITHIN
from shaftprint.identify.judgement._data_contradictions import fails
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.reasons import Reason
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._record_fit import RecordFit
from shaftprint.units import zero_is_anywhere

REQUIREMENTS = Requirements(largest_excess=4.0)
"""What is asked of a fit of a drive. Its structure holds friction and whatever else acts, so that no misfit is taken
for granted: of 200 records that a structure holds in, none leaves more than 4 times the noise in any direction."""
# An offset is too large for the zero of a sensor from this share of the output's level on, ...
LARGEST_OFFSET = 0.1
# ... if it is no chance: so many standard deviations are exceeded by one offset of 200.
CERTAIN = 2.81


def held_outputs(one: EquippedDrive, records: Sequence[Record]) -> Iterator[Reason]:
    """Yield the outputs that keep each value for several samples."""
    for output in one.drive.outputs:
        for record in records:
            samples = kept_for(record.outputs[output.name][record.used])
            if samples > 1.0:
                seconds = samples / record.rate_hz
                yield Reason(
                    kind="record",
                    where=output.name,
                    sentence=(
                        f"In record {record.name} {output.name} keeps each value for {seconds:.3g} s "
                        f"({samples:.3g} samples), where a value of its own is expected in every sample: it "
                        f"shows motion late; use one sample of each value, or log {output.name} at the rate of its "
                        "instrument."
                    ),
                )
                break


def starts_in_motion(one: EquippedDrive, fit: Identification) -> Iterator[Reason]:
    """Yield the record that begins in other states than it is said to, and is explained with others."""
    if one.drive.fit.start == "found":
        return
    pairs = [
        (term, part)
        for term, part in zip(fit.objective.terms, fit.parts, strict=True)
        if isinstance(term, OutputError) and isinstance(part, RecordFit)
    ]
    begins = "steady running at its first inputs" if one.drive.fit.start == "steady" else "the states of [[start]]"
    for term, part in pairs:
        effects = term.start_effects(term.structure_values(fit.values))
        check = part.flexible.along("start", effects)
        if not fails(check, REQUIREMENTS, among=len(pairs)):
            continue
        freed = replace(part.flexible, nuisance=np.concatenate([part.flexible.nuisance, effects])).checks
        # its own numbers change with its start: that they do is no other cause
        others = [other for other in freed if other.kind != "other data"]
        if not any(fails(other, REQUIREMENTS, among=len(others)) for other in others):
            yield Reason(
                kind="record",
                where=part.record.name,
                sentence=(
                    f"Record {part.record.name} does not begin in {begins}: other states at its start explain "
                    f"{100.0 * check.share:.2g} % of the motion of {check.output} where the noise is "
                    f'{100.0 * check.noise:.2g} %; write start = "found" in [fit] of the drive file where it begins '
                    "in motion."
                ),
            )
            return


def large_offsets(one: EquippedDrive, fit: Identification) -> Iterator[Reason]:
    """Yield the outputs beside whose sensor the model stands further than a sensor's zero may lie off.

    Where friction and an offset do the same, another end of the search that fits as well may stand elsewhere: what
    counts is the one that stands nearest.
    """
    parts = [part for part in fit.parts if isinstance(part, RecordFit)]
    elsewhere: list[list[Estimate]] | None = None
    for output in one.drive.outputs:
        level = max(float(np.abs(part.record.outputs[output.name][part.record.used]).max()) for part in parts)
        found = [(part, offset) for part in parts for offset in part.offsets if offset.name == output.name]
        allowed = _allowed(output, level, one.factors[output.name])
        large = [
            (part, offset)
            for part, offset in found
            if abs(offset.value) - allowed > CERTAIN * offset.std  # false where nothing is known of it
        ]
        if not large:
            continue
        # each costs a simulation of all records
        elsewhere = list(_offsets_elsewhere(fit)) if elsewhere is None else elsewhere
        if any(
            all(abs(offset.value) <= allowed for offset in offsets if offset.name == output.name)
            for offsets in elsewhere
        ):
            continue
        part, offset = max(large, key=lambda pair: abs(pair[1].value))
        values = part.record.outputs[output.name][part.record.used]
        one_way = bool(values.min() >= -LARGEST_OFFSET * level or values.max() <= LARGEST_OFFSET * level)
        unit = one.units[output.name]
        more = (
            f"the motion of {part.record.name} goes one way, in which dry friction is a constant too; "
            if one_way
            else ""
        )
        yield Reason(
            kind="record",
            where=output.name,
            sentence=(
                f"In record {part.record.name} the model of {output.name} stands "
                f"{stated(offset.value, offset.std, unit)} beside the sensor, whose level is {rounded(level)} "
                f"{unit}: {more}look for dry friction or a steady load, fit a structure that has it to records of "
                f'both directions with offset = "none", or say by zero_std of {output.name} in the drive file how far '
                "the zero of the sensor may lie off."
            ),
        )


def _offsets_elsewhere(fit: Identification) -> Iterator[list[Estimate]]:
    """Yield the offsets of all records at each other end of the search within the 95 % interval of some number."""
    for cluster in fit.clusters:
        if 2.0 * (cluster.cost - fit.cost) < WITHIN and not np.array_equal(cluster.values, fit.values):
            parts = [term.assessed(cluster.values, number)[0] for number, term in enumerate(fit.objective.terms)]
            yield [offset for part in parts if isinstance(part, RecordFit) for offset in part.offsets]


def _allowed(output: Signal, level: float, factor: float) -> float:
    """Return how far the zero of a sensor may lie off, in the unit of the structure."""
    if output.zero_std is not None:
        return CERTAIN * output.zero_std * abs(factor)
    return np.inf if zero_is_anywhere(output.unit) else LARGEST_OFFSET * level
