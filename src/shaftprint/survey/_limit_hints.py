"""Whether a recording hints at a limit that acts: by harmonics of sines and failed steps, or by what its legs reach."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain, plain_letters
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.late import late
from shaftprint.reasons import doubt_scales
from shaftprint.survey._measurement import Measurement
from shaftprint.survey._trial import Trial

with late():
    from shaftprint.design.operation._limit_use import (
        limit_cautions,
        limit_reasons,
        limit_uses,
        ratio_reasons,
        stated_limits,
    )
    from shaftprint.design.operation._recorded import recorded_operation
    from shaftprint.limits._limit_hints import limit_hints

if TYPE_CHECKING:
    from shaftprint.design.operation._limit_use import LimitUse
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.reasons import Reason


def hints_of(
    measurement: Measurement, trial: Trial, failed_steps: Sequence[str] | None, *, named: Sequence[str] = ()
) -> tuple[str, ...]:
    """Return whether a limit may have acted, in words.

    The lines of a leg have no harmonics of their own, so that what it reaches is held against the vessel file.

    ``failed_steps``: steps that a model does not predict; None where no model was held against them. ``named``: the
    limits that a search for them has found already, in words.
    """
    if not measurement.legs:
        return limit_hints(measurement.spectra.harmonics, failed_steps, named=named)
    names = {leg.name for leg in measurement.legs}
    uses = [use for use in _uses(measurement, trial) if use.excitation in names]
    of_sines = limit_hints(measurement.spectra.harmonics, failed_steps, named=named) if trial.campaign.sines else ()
    return (*_of_legs(uses), *of_sines)


def reasons_of_limits(
    fit: "Identification", measurement: Measurement, trial: Trial
) -> "tuple[tuple[Reason, ...], tuple[str, ...]]":
    """Return what an engine at a limit says against a fit, and what a reader must know of it all the same.

    A limit speaks against a fit that does not explain its data. Of one that does the vessel file is in doubt, and with
    it the numbers where both sides of the gears say that their ratio is wrong.
    """
    if doubt_scales(measurement.signals.reasons):
        # a wrong scale makes the torque of the engine, which is at no limit
        return (), ()
    names = [*(one.name for one in trial.campaign.sines), *(leg.name for leg in measurement.legs)]
    uses, signals = _uses(measurement, trial), measurement.signals
    ratio = ratio_reasons(uses, names, signals.working_point, trial.vessel)
    if fit.p_value is None or fit.p_value >= Requirements().lowest_p_value:
        return ratio, () if ratio else limit_cautions(uses, names)
    return ratio or limit_reasons(uses, names, failed=True), ()


def _uses(measurement: Measurement, trial: Trial) -> "tuple[LimitUse, ...]":
    operation = recorded_operation(measurement.signals, trial.campaign, trial.vessel)
    return limit_uses(operation, stated_limits(trial.vessel))


def _of_legs(uses: "Sequence[LimitUse]") -> tuple[str, ...]:
    reached = [_words(use) for use in uses if use.is_reached]
    if reached:
        return (
            f"Legs reach limits of the vessel file: {'; '.join(reached)}. What acts there bends the lines of the leg.",
        )
    nearest = min(uses, key=lambda use: use.left / abs(use.allowed))
    return (f"No leg reaches a limit that the vessel file states; nearest comes {_words(nearest)}.",)


def _words(use: "LimitUse") -> str:
    numbers = f"{plain(use.value, 0)} of {plain(use.allowed, 0)} {use.unit}"
    return plain_letters(f"{use.excitation} to {use.limit} at {use.time_s:.1f} s, {numbers}")
