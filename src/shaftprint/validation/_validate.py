"""The verb of the room: hold a model against records that it was not identified from."""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import ValidationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._sensor import pick_up_values
from shaftprint.memory import give_back_memory
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.validation._model import Model, identified_model, model_of
from shaftprint.validation._prediction import Predict, linear_prediction
from shaftprint.validation._run import Data, Run, run_model
from shaftprint.validation._sentences import findings_of, outcome_sentences, rises_slower_and_lower
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._step_comparison import StepNumber, compare_steps
from shaftprint.validation._validation import ExcerptComparison, ExcerptTraces, Validation
from shaftprint.validation._validation_records import Excerpt, default_records, excerpts_of, whole_excerpts
from shaftprint.validation.measures._delay import LONGEST_S, RemainingDelay, remaining_delay
from shaftprint.validation.measures._misfit import Compared, Outcome, misfit_of


def _any(excerpt: Excerpt) -> bool:
    """Take every excerpt."""
    return True


@refusing_none(ValidationError)
def validate(
    model: Model | Identification | Structure,
    signals: Signals,
    campaign: Campaign,
    *,
    rng: np.random.Generator,
    records: Sequence[str] | None = None,
    used: Collection[str] = (),
    allow_in_sample: bool = False,
    predict: Predict = linear_prediction,
    quadratic_propeller: bool = True,
    chosen: Callable[[Excerpt], bool] = _any,
    settings: ValidationSettings | None = None,
) -> Validation:
    """Hold a model against chirps and staircases that it was not identified from.

    Parameters
    ----------
    model
        What is validated: a fit, a structure with its default values, or a ``Model`` with stated ones.
    signals
        The prepared recording.
    campaign
        What was asked of the ship.
    rng
        Source of the parameter sets that the bands of step numbers are drawn from.
    records
        Names of chirps and staircases; by default all staircases and the chirp with the widest sweep.
    used
        Names of tests that the model was identified from besides those that a fit names itself.
    allow_in_sample
        Whether records of the identification may be asked for; they are marked and do not count.
    predict
        How the model is taken through time: ``linear_prediction``, or ``simulated_prediction`` for one with limits.
    quadratic_propeller
        Whether the square of the speed is added to the torque, which a linear model of a propeller in bollard pull
        lacks; not for a structure that has the propeller's law itself.
    chosen
        Whether an excerpt is compared; all of them by default.
    settings
        How records are cut and compared.

    Raises
    ------
    ValidationError
        If the structure is not from ``n_set`` to ``n`` and ``M_s``, a record is not in the campaign or the recording or
        was used for the identification, or no noise can be measured.
    """
    settings = settings or ValidationSettings()
    validated = _with_sensor(_as_model(model, used), signals)
    names = default_records(campaign, validated.used) if records is None else tuple(dict.fromkeys(records))
    planned = excerpts_of(campaign, names, used=validated.used, allow_in_sample=allow_in_sample, settings=settings)
    planned = tuple(excerpt for excerpt in planned if chosen(excerpt))
    excerpts, lost = whole_excerpts(planned, signals.coverage, settings)
    linear = predict is linear_prediction
    data = Data.of(signals, campaign, settings)
    comparisons: list[ExcerptComparison] = []
    for name in names:
        of_record = [excerpt for excerpt in excerpts if excerpt.record == name]
        if not of_record:
            continue
        run = run_model(validated, data, of_record, settings, predict=predict, quadratic_propeller=quadratic_propeller)
        for excerpt in of_record:
            comparisons.append(_compared(excerpt, run, validated, settings, rng))
            give_back_memory()
        # its derivatives are gone before those of the next record are made
        del run
        give_back_memory()
    return Validation(
        model=validated,
        settings=settings,
        comparisons=tuple(comparisons),
        outcome=_outcome(comparisons),
        headline=headline_of(comparisons, linear=linear),
        sentences=outcome_sentences(validated, comparisons, settings, linear=linear),
        findings=(
            *lost,
            *findings_of(
                validated,
                comparisons,
                data.noise,
                quadratic_propeller=quadratic_propeller,
                linear=linear,
                # that of legs alone is drawn through their means
                line_of_stairs=bool(campaign.sines or not campaign.legs),
            ),
        ),
    )


def joined(validations: Sequence[Validation], model: Model) -> Validation:
    """Return several validations as one: the same line, each excerpt judged by the fit that has not seen it.

    Parameters
    ----------
    validations
        At least one, each of other excerpts, taken through time with limits.
    model
        The model that is used in the end, of which the outcome is stated.

    Raises
    ------
    ValidationError
        If there are none.
    """
    if not validations:
        raise ValidationError(f"{model.name}: expected at least one validation, found none.")
    comparisons = tuple(comparison for one in validations for comparison in one.comparisons)
    settings = validations[0].settings
    return Validation(
        model=model,
        settings=settings,
        comparisons=comparisons,
        outcome=_outcome(comparisons),
        headline=headline_of(comparisons, linear=False),
        sentences=outcome_sentences(model, comparisons, settings, linear=False),
        findings=tuple(dict.fromkeys(finding for one in validations for finding in one.findings)),
    )


def _as_model(model: Model | Identification | Structure, used: Collection[str]) -> Model:
    match model:
        case Model():
            return replace(model, used=(*model.used, *used))
        case Identification():
            return identified_model(model, used=used)
        case _:
            return replace(model_of(model), used=tuple(used))


def _with_sensor(model: Model, signals: Signals) -> Model:
    """Return the model with the pick-up's held parameters at the values of the signals."""
    speed = signals.engine_speed
    values = model.values.copy()
    of_sensor = pick_up_values(
        model.structure, averaging_s=speed.averaging_s, hold_s=speed.hold_s, delay_s=speed.delay_s
    )
    for name, value in of_sensor.items():
        values[model.structure.names.index(name)] = value
    return replace(model, values=frozen_float(values))


def _compared(
    excerpt: Excerpt, run: Run, model: Model, settings: ValidationSettings, rng: np.random.Generator
) -> ExcerptComparison:
    """Return model and data in one excerpt."""
    pairs = run.compared(excerpt, settled_share=settings.settled_share)
    return ExcerptComparison(
        excerpt=excerpt,
        misfits=tuple(
            misfit_of(
                raw,
                smooth,
                model.covariance,
                largest_error=settings.largest_error,
                coverage=settings.coverage,
            )
            for raw, smooth in pairs
        ),
        delays=tuple(_delay(excerpt, run, model, smooth) for _, smooth in pairs),
        step_numbers=tuple(_step_numbers(excerpt, run, model, settings, [smooth for _, smooth in pairs], rng)),
        traces=_traces(excerpt, run, model),
    )


def _delay(excerpt: Excerpt, run: Run, model: Model, smooth: Compared) -> RemainingDelay:
    samples = run.excerpt(excerpt)
    # the run goes on behind every record, but not before one that begins with the recording
    margin = min(round(LONGEST_S * run.data.signals.rate_hz), samples.start, run.smooth.shape[1] - samples.stop)
    wide = run.excerpt(excerpt, margin)
    return remaining_delay(
        smooth.output,
        smooth.measured,
        run.smooth[smooth.place, wide],
        run.slopes[:, smooth.place, wide],
        model.covariance,
        smooth.autocovariance,
        rate_hz=run.data.signals.rate_hz,
        margin=margin,
    )


def _step_numbers(
    excerpt: Excerpt,
    run: Run,
    model: Model,
    settings: ValidationSettings,
    smooth: Sequence[Compared],
    rng: np.random.Generator,
) -> Iterator[StepNumber]:
    if excerpt.step_s is None:
        return
    time = run.time_s(excerpt) - excerpt.step_s
    for one in smooth:
        yield from compare_steps(
            one,
            time,
            model.covariance,
            settled_share=settings.settled_share,
            coverage=settings.coverage,
            draws=settings.draws,
            rng=rng,
        )


def _traces(excerpt: Excerpt, run: Run, model: Model) -> ExcerptTraces:
    there = run.excerpt(excerpt)
    by_output = [run.slopes[:, row, there] for row in range(len(run.smooth))]
    variance = np.stack([np.sum((model.covariance @ slopes) * slopes, axis=0) for slopes in by_output])
    return ExcerptTraces(
        time_s=frozen_float(run.time_s(excerpt)),
        # copies: views would keep the whole run in memory
        set_point=frozen_float(run.set_point[there].copy()),
        measured=frozen_float(run.measured_smooth[:, there].copy()),
        model=frozen_float(run.smooth[:, there].copy()),
        model_std=frozen_float(np.sqrt(np.maximum(variance, 0.0))),
        noise_std=frozen_float(run.noise_std(excerpt)),
    )


def _outcome(comparisons: Sequence[ExcerptComparison]) -> Outcome:
    outcomes = {comparison.outcome for comparison in comparisons if not comparison.excerpt.in_sample}
    return "fails" if "fails" in outcomes else "passes" if outcomes == {"passes"} else "undecided"


def headline_of(comparisons: Sequence[ExcerptComparison], *, linear: bool) -> str:
    """Return up to which step the model holds, and what acts beyond it; where no step fails, whether it holds at all.

    ``comparisons``: every excerpt. ``linear``: whether the model was taken through time without limits.
    """
    judged = [c for c in comparisons if not c.excerpt.in_sample]
    if not judged:
        return "nothing is proved"
    failed = [c for c in judged if c.outcome == "fails"]
    model = "the linear model" if linear else "the model"
    if not failed:
        undecided = sum(c.outcome == "undecided" for c in judged)
        if undecided == len(judged):
            return f"nothing is proved: noise hides how well {model} meets what was recorded"
        return f"{model} holds{' as far as the noise lets see' if undecided else ''}"
    heights = [c.excerpt.height_v for c in failed if c.excerpt.height_v is not None]
    if not heights:
        places = ", ".join(dict.fromkeys(f"{c.excerpt.record} ({c.excerpt.title})" for c in failed))
        return f"{model} does not hold in {places}"
    steps = [c.excerpt.height_v for c in judged if c.excerpt.height_v is not None]
    below = [height for height in steps if height < min(heights)]
    cause = _cause(failed, linear=linear)
    if not below:
        return f"{model} does not hold for steps, not for the smallest of {min(steps):g} V; {cause}"
    return f"{model} holds up to steps of {max(below):g} V; beyond, {cause}"


def _cause(failed: Sequence[ExcerptComparison], *, linear: bool) -> str:
    if linear and rises_slower_and_lower(failed):
        return "a limit of torque or of its rate acts"
    return "something acts that the model does not have; shaftprint limits looks for it"
