"""One record with what the model makes of it: data and model, raw and through the low-pass."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign
from shaftprint.signals import Signals, deviation
from shaftprint.validation._model import Model
from shaftprint.validation._prediction import OUTPUTS, Predict, with_quadratic_torque
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._validation_records import Excerpt
from shaftprint.validation.measures import LEAST_LOAD, Compared, QuietNoise, low_pass, quiet_noise

# Time behind a record that is predicted too: the low-pass and the search for a delay look beyond its end.
_BEHIND_S = 5.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Data:
    """A recording as deviations from its working point, with its noise."""

    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float
    """Time of the first sample [s]."""
    set_point: FloatArray
    """Set point, shape (samples,)."""
    raw: FloatArray
    """Speed and torque, shape (2, samples)."""
    smooth: FloatArray
    """The same through the low-pass, shape (2, samples)."""
    raw_noise: QuietNoise
    """Noise of all frequencies."""
    noise: QuietNoise
    """Noise through the low-pass."""

    @classmethod
    def of(cls, signals: Signals, campaign: Campaign, settings: ValidationSettings) -> "Data":
        """Return the data of a recording.

        Raises
        ------
        ValidationError
            If no noise can be measured.
        """
        point = signals.working_point
        raw = np.stack(
            [
                deviation(signals.engine_speed.speed_rev_s, point.engine_speed_rev_s),
                deviation(signals.shaft_torque_nm, point.shaft_torque_nm),
            ]
        )
        smooth = low_pass(raw, signals.rate_hz, settings.highest_hz)
        grid = {"rate_hz": signals.rate_hz, "start_s": signals.start_s}
        raw_noise, noise = (
            quiet_noise(outputs, campaign, signals.coverage, **grid, rest_s=settings.rest_s)
            for outputs in (raw, smooth)
        )
        return cls(
            rate_hz=signals.rate_hz,
            start_s=signals.start_s,
            set_point=deviation(signals.set_point_rev_s, point.engine_speed_rev_s),
            raw=raw,
            smooth=smooth,
            raw_noise=raw_noise,
            noise=noise,
        )

    def places(self, begin_s: float, end_s: float) -> slice:
        """Return the samples between two times, as far as they are in the recording."""
        first, last = (round((time - self.start_s) * self.rate_hz) for time in (begin_s, end_s))
        return slice(max(first, 0), min(last, self.raw.shape[1]))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Run:
    """A stretch of the recording around one record, with what the model makes of it."""

    data: Data
    """The recording."""
    first: int
    """Sample of the recording with which it begins."""
    raw: FloatArray
    """Speed and torque of the model, shape (2, samples)."""
    smooth: FloatArray
    """The same through the low-pass, shape (2, samples)."""
    slopes: FloatArray
    """Derivatives of the latter to the free parameters, shape (free, 2, samples)."""

    def excerpt(self, excerpt: Excerpt, margin: int = 0) -> slice:
        """Return the samples of the run that an excerpt takes, with a margin at either end."""
        samples = self.data.places(excerpt.start_s, excerpt.stop_s)
        return slice(samples.start - self.first - margin, samples.stop - self.first + margin)

    def compared(self, excerpt: Excerpt) -> list[tuple[Compared, Compared]]:
        """Return data and model of speed and of torque in an excerpt, raw and through the low-pass."""
        in_model, in_data = self.excerpt(excerpt), self.data.places(excerpt.start_s, excerpt.stop_s)
        # the median: a step spends most of its excerpt at the level that it ends at
        load = max(1.0 + float(np.median(self.data.smooth[1, in_data])), LEAST_LOAD)
        pairs = []
        for measured, model, noise in (
            (self.data.raw, self.raw, self.data.raw_noise),
            (self.data.smooth, self.smooth, self.data.noise),
        ):
            like = noise.like(in_data.stop - in_data.start, load)
            pairs.append(
                [
                    Compared(
                        output=output,
                        place=row,
                        measured=measured[row, in_data],
                        model=model[row, in_model],
                        slopes=self.slopes[:, row, in_model],
                        noise=like,
                        offset_variance=load**2 * float(noise.offset_variance[row]),
                    )
                    for row, output in enumerate(OUTPUTS)
                ]
            )
        return list(zip(*pairs, strict=True))


def run_model(
    model: Model,
    data: Data,
    excerpts: Sequence[Excerpt],
    settings: ValidationSettings,
    *,
    predict: Predict,
    quadratic_propeller: bool,
) -> Run:
    """Return what a model makes of the record that some excerpts are cut from.

    Raises
    ------
    ValidationError
        If the structure is not from ``n_set`` to ``n`` and ``M_s``.
    """
    begin, end = min(e.start_s for e in excerpts), max(e.stop_s for e in excerpts)
    there = data.places(begin - settings.lead_s, end + _BEHIND_S)
    raw, slopes = predict(
        model.structure,
        model.values,
        data.set_point[there],
        rate_hz=data.rate_hz,
        wanted=[p.name for p in model.structure.free] if model.has_uncertainty else [],
    )
    if quadratic_propeller:
        raw, slopes = with_quadratic_torque(raw, slopes)
    if not model.has_uncertainty:
        slopes = np.zeros((len(model.structure.free), *raw.shape))
    smooth, slopes = (low_pass(values, data.rate_hz, settings.highest_hz) for values in (raw, slopes))
    return Run(data=data, first=there.start, raw=raw, smooth=smooth, slopes=slopes)
