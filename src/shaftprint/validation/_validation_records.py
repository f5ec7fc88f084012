"""Which records of a campaign a model is held against, and how they are cut.

A record is one chirp or staircase. A chirp is cut at the times at which it passes the band edges: its frequency is
``f_0 (f_1 / f_0)^(t / T)``, so that it passes ``f`` at ``t = T ln(f / f_0) / ln(f_1 / f_0)``. A staircase is taken
whole and step by step (thesis figures 5.6 to 5.11).
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Chirp, Staircase
from shaftprint.errors import ValidationError
from shaftprint.signals._gaps import Coverage
from shaftprint.validation._settings import ValidationSettings

_LOOKS_BEHIND_S = 2.0

Kind = Literal["chirp band", "staircase", "step"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Excerpt:
    """A stretch of a recording in which model and data are compared."""

    record: str
    """Name of the chirp or staircase in the campaign."""
    kind: Kind
    """What it shows."""
    title: str
    """What it is, in words."""
    start_s: float
    """When it begins [s]."""
    stop_s: float
    """When it ends [s]."""
    step_s: float | None = None
    """When the set point jumps [s]; None where nothing jumps, or more than once."""
    height_v: float | None = None
    """By how much the set point jumps there [V]; None where nothing jumps, or more than once."""
    lowest_hz: float | None = None
    """Slowest frequency that a chirp passes in it [Hz]; None for a staircase."""
    in_sample: bool = False
    """Whether the model was identified from it."""

    @property
    def duration_s(self) -> float:
        """Length [s]."""
        return self.stop_s - self.start_s


def default_records(campaign: Campaign, used: Collection[str]) -> tuple[str, ...]:
    """Return the names of the staircases and of the short chirp, without those that the model was identified from.

    The short chirp sweeps its whole range in one go: of all chirps it has the largest ratio of frequencies.
    """
    chirps = sorted(campaign.chirps, key=_sweep, reverse=True)[:1]
    names = (*(chirp.name for chirp in chirps), *(stairs.name for stairs in campaign.staircases))
    return tuple(name for name in names if name not in used)


def excerpts_of(
    campaign: Campaign,
    records: Sequence[str],
    *,
    used: Collection[str],
    allow_in_sample: bool,
    settings: ValidationSettings,
) -> tuple[Excerpt, ...]:
    """Return all excerpts of the named records in the order of the names.

    Raises ValidationError if a name is no chirp or staircase, there is none, or the model was identified from one and
    that is not allowed.
    """
    tests: tuple[Chirp | Staircase, ...] = (*campaign.chirps, *campaign.staircases)
    there = {test.name: test for test in tests}
    if not records:
        raise ValidationError(
            f"campaign {campaign.name}: expected a chirp or staircase that the model was not identified from, found "
            f"none; it has {', '.join(there) or ('legs only' if campaign.legs else 'sines only')}."
        )
    in_sample = [name for name in records if name in used]
    if in_sample and not allow_in_sample:
        raise ValidationError(
            f"record {', '.join(in_sample)}: the model was identified from it, so that it proves nothing; validate on "
            "another record, or allow records of the identification, which are then marked."
        )
    excerpts: list[Excerpt] = []
    for name in records:
        if name not in there:
            raise ValidationError(
                f"record {name}: expected a chirp or staircase of campaign {campaign.name}, one of "
                f"{', '.join(there) or 'none'}."
            )
        record = there[name]
        cut = _chirp(record, settings) if isinstance(record, Chirp) else _staircase(record, campaign, settings)
        excerpts += [replace(excerpt, in_sample=name in used) for excerpt in cut]
    return tuple(excerpts)


def whole_excerpts(
    excerpts: Sequence[Excerpt], coverage: Coverage, settings: ValidationSettings
) -> tuple[tuple[Excerpt, ...], tuple[str, ...]]:
    """Return the excerpts that the recording holds without a gap, and why the others are left out.

    A gap counts also shortly before an excerpt, where the model did not know the set point, and shortly behind it,
    where the low-pass and the search for a delay look.

    Raises ValidationError if none is left.
    """
    complete, lost = [], []
    gaps = Coverage(gaps=coverage.gaps)
    for excerpt in excerpts:
        reason = coverage.missing(excerpt.start_s, excerpt.stop_s) or gaps.missing(
            excerpt.start_s - settings.rest_s, excerpt.stop_s + _LOOKS_BEHIND_S
        )
        if reason:
            lost.append(f"{excerpt.record}, {excerpt.title}, was left out: {reason}")
        else:
            complete.append(excerpt)
    if not complete:
        records = ", ".join(dict.fromkeys(excerpt.record for excerpt in excerpts))
        begin, end = min(e.start_s for e in excerpts), max(e.stop_s for e in excerpts)
        raise ValidationError(
            f"record {records}: expected it in the recording, from {begin:.1f} to {end:.1f} s, but "
            f"{lost[0].split(': ', 1)[1]}; check the start_s of the campaign file, or choose another record."
        )
    return tuple(complete), tuple(lost)


def _sweep(chirp: Chirp) -> float:
    return abs(math.log(chirp.stop_frequency_hz / chirp.start_frequency_hz))


def _chirp(chirp: Chirp, settings: ValidationSettings) -> list[Excerpt]:
    """Return the bands of a chirp that it holds, and the stretch in which phases can be seen."""
    edges = settings.band_edges_rad_s
    low, high = settings.about_rad_s
    bands = [(0.0, edges[0], f"up to {edges[0]:g} rad/s")]
    bands += [(a, b, f"{a:g} to {b:g} rad/s") for a, b in pairwise(edges)]
    bands.append((edges[-1], math.inf, f"above {edges[-1]:g} rad/s"))
    bands.append((low, high, f"about {0.5 * (low + high):g} rad/s"))
    excerpts = []
    ends = sorted((chirp.start_frequency_hz, chirp.stop_frequency_hz))
    slowest, fastest = (2.0 * math.pi * end for end in ends)
    for lower, upper, title in bands:
        a, b = max(lower, slowest), min(upper, fastest)
        if a < b:
            start, stop = sorted(chirp.passes_s(omega / (2.0 * math.pi)) for omega in (a, b))
            excerpts.append(
                Excerpt(
                    record=chirp.name,
                    kind="chirp band",
                    title=title,
                    start_s=start,
                    stop_s=stop,
                    lowest_hz=a / (2.0 * math.pi),
                )
            )
    return excerpts


def _staircase(stairs: Staircase, campaign: Campaign, settings: ValidationSettings) -> list[Excerpt]:
    """Return a staircase whole and step by step; the first level is a step too where it is not that before."""
    excerpts = [
        Excerpt(
            record=stairs.name, kind="staircase", title="whole staircase", start_s=stairs.start_s, stop_s=stairs.stop_s
        )
    ]
    after = min(settings.zoom_after_s, stairs.dwell_s - settings.zoom_before_s)
    levels = (campaign.offset_v, *stairs.levels_v)
    for step, (before_v, after_v) in enumerate(pairwise(levels)):
        at = stairs.start_s + step * stairs.dwell_s
        if before_v == after_v:
            continue
        excerpts.append(
            Excerpt(
                record=stairs.name,
                kind="step",
                title=f"step at {at:.1f} s, {before_v:.3g} to {after_v:.3g} V",
                start_s=at - settings.zoom_before_s,
                stop_s=at + after,
                step_s=at,
                height_v=abs(after_v - before_v),
            )
        )
    return excerpts
