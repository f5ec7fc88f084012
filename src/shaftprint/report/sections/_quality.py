"""The section of a report on the quality of the data: levels, clocks, signal-to-noise ratios, aliasing, repairs."""

from functools import partial
from typing import TYPE_CHECKING

from shaftprint.digits import plain
from shaftprint.fingerprint._clock_influence import clock_influences
from shaftprint.markup._symbols import name_parts
from shaftprint.report.figures._signal_to_noise import THESIS_LIMIT_DB, signal_to_noise_chart
from shaftprint.report.sections._clocks import clock_sentences
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables._recording import clock_map_table, clock_table, level_table
from shaftprint.tables._signals import local_ratio_table, overall_ratio_table, repair_table, window_table

if TYPE_CHECKING:
    from shaftprint.plain_table import Table


def quality_section(inputs: Inputs) -> Section:
    """Return levels, clocks, windows, signal-to-noise ratios, aliasing and repairs."""
    spectra = inputs.spectra
    tables: list[Table] = []
    if inputs.recording is not None:
        tables += [level_table(inputs.recording, inputs.levels), clock_table(inputs.recording)]
    tables += [
        clock_map_table(inputs.clocks),
        window_table(spectra),
        overall_ratio_table(spectra),
        local_ratio_table(spectra),
        repair_table(inputs.signals),
    ]
    limit = inputs.aliasing_limit_hz
    return Section(
        key="quality",
        title="Data quality",
        paragraphs=(_aliasing(inputs), _weakest(inputs), *_clocks(inputs)),
        tables=[table for table in tables if table.rows],
        pictures=(
            Picture(
                name="signal_to_noise",
                caption="Local signal-to-noise ratio of each line and channel; lines that are not used are hollow.",
                alt="Signal-to-noise ratio over frequency, one line a channel; it falls towards high frequencies.",
                chart=partial(signal_to_noise_chart, spectra, aliasing_limit_hz=limit),
            ),
        ),
    )


def _clocks(inputs: Inputs) -> list[str]:
    """Return what is known of the clock of every logger that was merged into the recording."""
    influences = clock_influences(inputs.clocks, spectra=inputs.spectra, signals=inputs.signals)
    return [clock_sentences(clock, influence) for clock, influence in zip(inputs.clocks, influences, strict=True)]


def _aliasing(inputs: Inputs) -> str:
    """Return which lines lie above half the pulse rate of the speed sensor, where a speed cannot be told any more."""
    limit = inputs.aliasing_limit_hz
    sensor = inputs.signals.engine_speed.channel
    above = [window.line for window in inputs.spectra.windows if window.frequency_hz > limit]
    words = f"Speeds of {sensor} are resolved up to {plain(limit, 2)} Hz, half its pulse rate"
    if not above:
        return f"{words}: all test lines lie below."
    return f"{words}: {', '.join(above)} {'lies' if len(above) == 1 else 'lie'} above, aliased, and cannot be used."


def _weakest(inputs: Inputs) -> str:
    """Return the used line and channel with the lowest signal-to-noise ratio."""
    ratios, response = inputs.spectra.signal_to_noise, inputs.spectra.response
    used = {line for line, is_used in zip(response.lines, response.used, strict=True) if is_used}
    # the output n of the response is the speed of the pick-up that was identified
    wanted = {*response.inputs, *response.outputs, inputs.spectra.speed}
    used_ratios = [
        (float(value), line, channel)
        for line, values in zip(ratios.lines, ratios.local_db, strict=True)
        for channel, value in zip(ratios.channels, values, strict=True)
        if line in used and channel in wanted
    ]
    if not used_ratios:
        return "No signal-to-noise ratio is known of the lines that were used."
    value, line, channel = min(used_ratios)
    weak = sum(1 for other, _, _ in used_ratios if other < THESIS_LIMIT_DB)
    name = "".join(f"{before}{base}{f'_{index}' if index else ''}" for before, base, index in name_parts(channel))
    few = "none" if not weak else str(weak)
    return (
        f"Of the lines that were used, {line} of {name} stands out of the noise least, by {plain(value, 1)} dB; {few} "
        f"of {len(used_ratios)} ratios {'are' if weak != 1 else 'is'} below {THESIS_LIMIT_DB:g} dB."
    )
