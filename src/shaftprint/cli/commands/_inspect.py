"""``shaftprint inspect``: what is in a recording, and whether it is good enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._found_tests import print_found_tests, write_proposal
from shaftprint.cli._inspect_headline import headline, is_good_enough, lines_of, lost_parts, of_torque
from shaftprint.cli._inspected_test import InspectedTest, tested
from shaftprint.cli._limit_uses import print_limit_uses
from shaftprint.cli._next import VESSEL_FILE, free, print_next, vessel_file_near
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import NAMES, READING_SECTION, hints_of, reading_options, reading_words
from shaftprint.cli._signal_tables import print_lines, print_signals, sensor_row
from shaftprint.cli._terminal import answer, details, echo, is_detailed, print_findings, say
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.errors import SignalError
from shaftprint.late import late
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.reasons import doubt_scales

with late():
    from shaftprint.campaign._campaign import load_campaign
    from shaftprint.clocks._logger_clock import LoggerClock, logger_clocks
    from shaftprint.recording._level_watch import LevelWatch, watch_levels
    from shaftprint.recording._levels import Levels
    from shaftprint.recording._messages import judge_messages
    from shaftprint.recording._read import read_recording
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._channel_readings import ChannelReadings, read_channels
    from shaftprint.signals._channels import other_ship
    from shaftprint.signals._contradictions import contradictions
    from shaftprint.signals._inspect import ChannelReport, channel_reports
    from shaftprint.spectra._spectra import Spectra
    from shaftprint.survey._legs import LegMeasurement
    from shaftprint.survey._proposed_sensors import Seen, proposed_sensors, uses_of
    from shaftprint.tables._legs import leg_table
    from shaftprint.tables._recording import clock_map_table
    from shaftprint.vessel._vessel import Vessel, load_vessel


_MOST_GAPS = 20
# Clocks of loggers differ by less.
_SAME_RATE = 0.01
# Rows of a table that is read, and not looked up.
_MOST_LINES = 40


@click.command(
    "inspect",
    cls=SectionedCommand,
    example="shaftprint inspect log.csv --vessel mine.toml --campaign test.toml",
    sections={"What the test was": ("--vessel", "--campaign"), **READING_SECTION},
)
@click.argument("recording", type=click.Path(path_type=Path))
@click.option("--vessel", help=f"Vessel file, {NAMES} stan-tug-1205: says what the channels are.")
@click.option("--campaign", help=f"Campaign file, {NAMES} thesis: says what was asked of the ship.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Campaign file to write with --campaign: its tests where the recorded set point shows them.",
)
@reading_options
@no_progress_option
def command(
    recording: Path, vessel: str | None, campaign: str | None, output: Path | None, no_progress: bool, **said: object
) -> None:
    """Show what is in a recording and whether it is good enough.

    Without a vessel file, the channels with rates, spans and levels, and a proposal for its sensors. With one, what in
    it contradicts the rest, and what each sensor shows: pulses, faults, outliers. With a campaign file too, the
    calibration, the signal-to-noise ratio of every test line, and where the test left the limits of ship and engine.
    """
    if campaign is not None and vessel is None:
        raise click.UsageError("--campaign needs --vessel, which says what each channel is.")
    if output is not None and campaign is None:
        raise click.UsageError("--output is the campaign of --campaign as the recording shows it: name that too.")
    ship = None if vessel is None else load_vessel(vessel)
    planned = None if campaign is None else load_campaign(campaign)
    is_impossible = ship is not None and vessel is not None and print_disagreements(ship, vessel, is_recorded=True)
    reading = reading_words(**said)
    with read_recording(recording, **hints_of(**said)) as opened:
        clocks = logger_clocks(opened)
        watch = watch_levels(opened)
        readings = None if ship is None else _read(watch, ship, partly=planned is None, hidden=no_progress)
        levels = _levels(watch, hidden=no_progress)
        if ship is None or readings is None:
            seen = _print_channels(opened, levels)
            _print_proposal(opened, seen, clocks)
            # a comment of the vessel file into which the proposal is pasted
            print_next(*_first_step(recording, reading, seen), label="# Next:")
            return
        test = None if planned is None else tested(opened, ship, planned, readings, clocks, hidden=no_progress)
        reports = channel_reports(readings, levels)
        good = _print_answer(test, reports, ship, missing=readings.missing, is_impossible=is_impossible)
        if other := _other_than_said(opened, ship):
            print_findings("Not as the vessel file says", other)
        _print_channels(opened, levels)
        _print_converted(opened, readings)
        print_tables([clock_map_table(clocks)])
        _print_sensors(reports)
        if test is not None and output is not None:
            write_proposal(test.tests, test.planned, output, recording)
        if test is not None:
            _print_test(test, recording)
    _print_next(recording, reading, ("--vessel", vessel), campaign, output, test, good=good)
    # with the campaign as recorded what was asked for is there
    if test is not None and output is None and not good:
        end_with_no()


def _first_step(recording: Path, reading: tuple[object, ...], seen: Sequence[Seen]) -> tuple[object, ...]:
    """Return the next command where there was no vessel file: one that lies there, or one to be made."""
    near = vessel_file_near(recording)
    if near is not None:
        return ("inspect", recording, *reading, "--vessel", near)
    if not {"set_point", "shaft_torque"} & set(uses_of(seen).values()):
        return ("new", "drive", "--from", recording, *reading, "-o", free(f"{recording.stem}.toml"))
    at = () if recording.parent == Path() else (recording.parent,)
    return ("start", *at, *reading) if recording.parent.is_dir() else ("new", "vessel", free(VESSEL_FILE))


def _print_next(
    recording: Path,
    reading: tuple[object, ...],
    vessel: tuple[object, ...],
    campaign: str | None,
    output: Path | None,
    test: InspectedTest | None,
    *,
    good: bool,
) -> None:
    """Print the next command; none where something has to be mended, or the recording made anew."""
    files = (recording, *reading, *vessel)
    if test is None or campaign is None:
        print_next("new", "campaign", free("campaign.toml"), "--from", recording, *reading, *vessel)
    elif output is not None:
        print_next("inspect", *files, "--campaign", output)
    elif any(one.is_found and one.differences for one in test.tests):
        print_next("inspect", *files, "--campaign", campaign, "-o", free("campaign-as-recorded.toml"))
    elif good:
        print_next("identify", *files, "--campaign", campaign, "-o", free("result"))


def _print_proposal(opened: Recording, seen: Sequence[Seen], clocks: Sequence[LoggerClock]) -> None:
    print_tables([clock_map_table(clocks)])
    print_findings("Left out", [f"{name}: {reason}" for name, reason in opened.left_out.items()])
    echo("Proposal for the vessel file; lines that begin with # are for you to fill in\n")
    for line in proposed_sensors(seen):
        echo(line)


def _print_answer(
    test: InspectedTest | None,
    reports: Sequence[ChannelReport],
    ship: Vessel,
    *,
    missing: Sequence[str] = (),
    is_impossible: bool = False,
) -> bool:
    """Print whether the recording is good enough, and what is wrong with its sensors; return whether it is.

    ``is_impossible``: whether the vessel file contradicts itself.
    """
    signals, asked = (None, None) if test is None else (test.signals, test.planned)
    is_good = False
    wrong = contradictions(reports, ship, signals=signals, campaign=asked)
    reasons = () if test is None else test.reasons
    against = dict.fromkeys(reason.sentence for reason in reasons)
    # what is said of a scale is no size of the propeller besides
    in_doubt = bool(wrong) or doubt_scales(reasons)
    held = [report.held for report in reports if report.held is not None and report.held not in against]
    problems = [
        *missing,
        *wrong,
        *(() if signals is None or in_doubt else of_torque(signals, ship)),
        *against,
        *held,
        *(report.problem for report in reports if report.problem is not None),
    ]
    if test is not None:
        refusal = "" if test.refusal is None else str(test.refusal)
        lost = () if test.signals is None else lost_parts(test.planned, test.signals, test.parts)
        of_file = "The vessel file contradicts itself, as said above: correct it first." if is_impossible else ""
        worst = next(iter((*wrong, *against)), "") or refusal or of_file
        is_good = is_good_enough(test.parts, worst=worst)
        answer(headline(test.parts, planned=lines_of(test.planned), worst=worst, lost=lost))
        echo()
        # said above
        problems = [problem for problem in problems if problem != worst]
        if worst and not problems:
            return is_good
    print_findings("Problems" if test is None or not worst else "Further problems", problems, is_answer=True)
    return is_good


def _read(watch: LevelWatch, ship: Vessel, *, partly: bool, hidden: bool) -> ChannelReadings:
    """Read the channels of the vessel file, counting their levels; where one is not there, the table says which are."""
    try:
        with progress(hidden=hidden) as steps:
            steps.begin("Reading the channels", total=1.0)
            return read_channels(watch.recording, ship, progress=steps.reach, partly=partly)
    except SignalError:
        _print_channels(watch.recording, _levels(watch, hidden=hidden))
        raise


def _levels(watch: LevelWatch, *, hidden: bool) -> dict[str, Levels]:
    with progress(hidden=hidden) as steps:
        steps.begin("Reading the other channels", total=1.0)
        return watch.levels(steps.reach)


def _print_channels(opened: Recording, levels_of: Mapping[str, Levels]) -> list[Seen]:
    rows, seen = [], []
    for name, channel in opened.channels.items():
        levels = levels_of[name]
        is_empty = levels.missing == channel.count
        seen.append(Seen(channel=channel, is_pulses=levels.is_pulses, is_empty=is_empty))
        values = [f"{value:.5g}" for value in (levels.lowest, levels.mean, levels.highest)]
        span = f"{channel.start_s:g} to {channel.start_s + channel.duration_s:g}"
        rows.append((channel.name, channel.unit, f"{channel.rate_hz:g}", span, *values, str(levels.missing)))
    say(f"{opened.path}: {opened.format}, SHA-256 {opened.sha256}\n")
    columns = (
        *(*texts("channel", "unit"), *numbers("rate [Hz]"), *texts("span [s]")),
        *numbers("lowest", "mean", "highest", "not a number"),
    )
    print_table(Table(title="Channels, raw", columns=columns, rows=tuple(rows)))
    _print_messages(opened)
    for title, sentences in (("Taken for granted", opened.remarks), ("Jumps of the clock", _jumps(opened))):
        if sentences:
            print_findings(title, sentences)
    if opened.began is not None:
        echo(f"Second 0 is {opened.began.isoformat(sep=' ')} by the logger's clock.\n")
    return seen


def _print_converted(opened: Recording, readings: ChannelReadings) -> None:
    """Print which channels the vessel file has in another unit than the recording."""
    units = {source.channel.name: source.channel.unit for source in readings.sources}
    sentences = [
        f"{name}: {opened.channel(name).unit} in the recording, {unit} in the vessel file; converted"
        for name, unit in units.items()
        if name in opened.channels and opened.channel(name).unit not in ("", unit)
    ]
    if sentences:
        print_findings("Other units", sentences)


def _other_than_said(opened: Recording, ship: Vessel) -> list[str]:
    """Return that the recording says another ship than the vessel file, or pulses come at another rate than it has."""
    other = other_ship(opened, ship.name)
    return [*([f"{other[:1].upper()}{other[1:]}."] if other else []), *_other_rate(opened, ship)]


def _other_rate(opened: Recording, ship: Vessel) -> list[str]:
    """Return that pulses were logged at another rate than the vessel file has; a plan and a simulation count on it."""
    stated_hz = None if ship.logger is None else ship.logger.sample_rate_hz
    pulses = [sensor.channel for sensor in ship.sensors.speed if sensor.gives_pulses]
    logged = [opened.channels[name] for name in pulses if name in opened.channels]
    rates = {channel.rate_hz for channel in logged if channel.stamps is None}
    if stated_hz is None or not rates or abs(max(rates) / stated_hz - 1.0) < _SAME_RATE:
        return []
    return [
        f"logger.sample_rate_hz: {stated_hz:g} in the vessel file, {max(rates):g} Hz in the recording; correct it, as "
        "`plan` and `sail` count on it, or read the recording at another rate, --sample-rate, if the file is right."
    ]


def _jumps(opened: Recording) -> list[str]:
    """Return where clocks of the file jump, the channels that jump together in one sentence."""
    channels: dict[tuple[float, float], list[str]] = {}
    for name, channel in opened.channels.items():
        for jump in channel.clock_jumps:
            at_s = channel.start_s + jump.sample / channel.rate_hz
            channels.setdefault((at_s, jump.jump_s), []).append(name)
    sentences = [
        f"At {at_s:.6g} s the times of {', '.join(names)} are set {'back' if jump_s < 0.0 else 'on'} by "
        f"{abs(jump_s):.4g} s. The samples go on one by one; what follows is on another clock."
        for (at_s, jump_s), names in channels.items()
    ]
    return _first_of(sentences)


def _first_of(sentences: list[str]) -> list[str]:
    """Return the first sentences, and how many there are more."""
    more = [f"{len(sentences) - _MOST_GAPS} more"] if len(sentences) > _MOST_GAPS else []
    return [*sentences[:_MOST_GAPS], *more]


def _print_messages(opened: Recording) -> None:
    """Print how the messages came of channels that have times of their own."""
    sentences = []
    for name, channel in opened.channels.items():
        if channel.stamps is None:
            continue
        messages = judge_messages(channel)
        steps = f", steps of {messages.step:.3g} {channel.unit}".rstrip() if messages.step else ""
        place = "" if channel.is_uneven else ", within half a step of a clock"
        sentences.append(f"{name}: {messages.sentence}{steps}{place}")
    if sentences:
        print_findings("Channels with times of their own", sentences)


def _print_sensors(reports: Sequence[ChannelReport]) -> None:
    columns = (
        *texts("channel", "used for", "levels"),
        *numbers("pulses [1/s]", "speed [rpm]"),
        *texts("strip angles [deg]", "faults"),
    )
    print_table(Table(title="Sensors of the vessel file", columns=columns, rows=tuple(map(sensor_row, reports))))
    gaps = [gap.sentence for report in reports for gap in report.gaps]
    if gaps:
        print_findings("Gaps, which cost the windows that they touch", _first_of(gaps))


def _print_lines(spectra: Spectra, legs: Sequence[LegMeasurement]) -> None:
    """Print the lines of the sines, or of the first leg, and those of the other legs."""
    print_lines(spectra)
    for leg in legs:
        if leg.spectra is not spectra:
            say(f"Leg {leg.name}")
            print_lines(leg.spectra)


def _print_test(test: InspectedTest, recording: Path) -> None:
    if test.tests:
        print_found_tests(test.tests, test.planned, recording)
    if test.signals is None or test.spectra is None:
        return
    print_signals(test.signals)
    if test.legs:
        print_table(leg_table(test.legs))
    lines = sum(len(one.response.lines) for one in test.parts)
    if lines <= _MOST_LINES:
        _print_lines(test.spectra, test.legs)
    else:
        with details():
            _print_lines(test.spectra, test.legs)
        if not is_detailed():
            say(f"Signal-to-noise ratios of {lines} lines: --verbose.\n")
    print_limit_uses(test.uses, is_expected=False)
    print_findings("Findings on the signals", [*test.signals.findings, *test.of_clocks])
    if test.planned.sines:
        print_findings("Limits", test.hints)
