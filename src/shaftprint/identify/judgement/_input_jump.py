"""Whether the input jumped in its channel alone, by lines that all came later from one instant on.

Where its channel lost samples, speed and torque did not follow; where the sines were halted, or the logger lost a piece
of all channels, they did, and nothing is wrong. By how much chi-square falls with the jump, whose size is known,
decides (see ``_clock_drift.py``): a fit makes delays and gains of it, and never all of it.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._clock_drift import LIKELY
from shaftprint.identify.judgement._suspects import misfit_of, whitened
from shaftprint.reasons import Reason
from shaftprint.units import MILLI


def jump_reasons(identification: Identification) -> tuple[Reason, ...]:
    """Return that the channel of the input jumped, where the other channels say that they did not follow."""
    effect = _effect(identification)
    if effect is None or not _fall(identification, effect) > LIKELY:
        return ()
    response = next(part.response for part in identification.experiments if np.any(part.response.input_jump_s))
    jump_s, late = response.input_jump_s, np.flatnonzero(response.input_jump_s)
    first, last_s = (
        response.lines[late[np.argmin(response.middle_s[late])]],
        float(jump_s[np.argmax(response.middle_s)]),
    )
    return (
        Reason(
            kind="channel clock",
            where=response.inputs[0],
            sentence=(
                f"The clock of {response.inputs[0]} is in doubt: from {first} on it comes "
                f"{MILLI * abs(last_s):.0f} ms {'later' if last_s > 0.0 else 'earlier'} than the campaign file asks, "
                "and the other channels do not; look for samples that its channel lost, and test once more."
            ),
        ),
    )


def _effect(identification: Identification) -> FloatArray | None:
    """Return what the jump does to the whitened rows; None where none is known, or records are fitted too."""
    if not identification.is_likelihood or identification.objective.others:
        return None
    parts, has_jumped = [], False
    for experiment in identification.objective.experiments:
        jump_s, model = experiment.response.input_jump_s, experiment.model(identification.values)
        late_s = jump_s[experiment.fitted] if jump_s.size else np.zeros(experiment.s.size)
        has_jumped |= bool(np.ptp(late_s))
        # a latency of the set point takes up what all have; of the fast lines, whose turn is large, all of it
        late_s = late_s - late_s[np.argmax(np.abs(experiment.s))]
        parts.append(whitened(experiment, model * np.expm1(experiment.s * late_s)))
    prior_rows = np.zeros(identification.objective.prior_rows.shape[0])
    return np.concatenate([*parts, prior_rows]) if has_jumped else None


def _fall(identification: Identification, effect: FloatArray) -> float:
    """Return by how much chi-square falls with the known jump."""
    misfit, basis = misfit_of(identification)
    across = effect - basis @ (basis.T @ effect)
    return float(2.0 * across @ misfit - across @ across)
