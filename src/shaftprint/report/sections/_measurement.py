"""The sections of a report on what was measured: campaign, calibration, responses, time signals."""

from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING

from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.figures._calibration import calibration_chart, strip_chart
from shaftprint.report.figures._campaign import campaign_chart
from shaftprint.report.figures._outliers import outlier_chart
from shaftprint.report.figures._responses import open_loop_chart
from shaftprint.report.figures._steps import delay_chart
from shaftprint.report.figures._time_series import excitation_chart, staircase_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section, picture_name
from shaftprint.spectra._open_loop import open_loop
from shaftprint.tables._signals import calibration_table, step_table, strip_table

if TYPE_CHECKING:
    from shaftprint.campaign._excitation import Excitation
    from shaftprint.signals._signals import Signals


def signal_section(inputs: Inputs) -> Section:
    """Return how the raw channels became signals: calibration, strips, delays."""
    signals = inputs.signals
    tables = [calibration_table(signals), strip_table(signals), step_table(signals)]
    pictures = [
        *_raw_pictures(inputs),
        Picture(
            name="calibration",
            caption="Line from voltage to engine speed through the steady levels, with residuals (thesis, figure 3.1).",
            alt="Straight line of engine speed over set-point voltage, and the distances of the levels from it.",
            chart=partial(calibration_chart, signals.calibration),
        ),
    ]
    if any(strip.angle_rev.size > 1 for strip in signals.strips):
        pictures.append(
            Picture(
                name="strips",
                caption=(
                    "Angles between the reflection strips against an even spacing (thesis, table 3.4). Which strip "
                    "is counted first differs between recordings: the angles of the vessel file are turned to fit."
                ),
                alt="Bars of the deviation of each strip angle from an even spacing.",
                chart=partial(strip_chart, signals.strips, inputs.vessel),
            )
        )
    if any(step.delay_s is not None for step in signals.step_delays):
        pictures.append(
            Picture(
                name="step_delays",
                caption="Steps of the set point, the speed that follows, and the level-crossing delay (thesis, figure "
                "3.3).",
                alt="Staircase of set point and speed, one step enlarged with its delay, and the delay of every step.",
                chart=partial(delay_chart, signals),
            )
        )
    return Section(
        key="signals",
        title="From raw channels to signals",
        points=signals.findings,
        tables=[table for table in tables if table.rows],
        pictures=pictures,
    )


def _raw_pictures(inputs: Inputs) -> list[Picture]:
    if inputs.recording is None:
        return []
    return [
        Picture(
            name="campaign",
            caption="Raw set-point voltage over the whole recording, with the tests named (thesis, figure 2.2).",
            alt="Set-point voltage over time in two rows, with a bar and a name above each test.",
            chart=partial(campaign_chart, inputs.recording, inputs.vessel, inputs.campaign),
        ),
        Picture(
            name="outliers",
            caption="Set point and shaft torque before and after the repair of outliers (thesis, figure 3.2).",
            alt="Set point and shaft torque over time; spikes of the raw signal stand out of the prepared one.",
            chart=partial(outlier_chart, inputs.recording, inputs.signals, inputs.vessel),
        ),
    ]


def response_section(inputs: Inputs) -> Section:
    """Return the measured responses in closed and open loop."""
    response, limit = inputs.spectra.response, inputs.aliasing_limit_hz
    governor, core = open_loop(response)
    pictures = [
        Picture(
            name="closed_loop",
            caption="Measured closed-loop response of speed and torque with 95 % intervals (thesis, figure 3.7).",
            alt="Bode diagram of measured engine speed and shaft torque over set point.",
            chart=partial(bode_chart, data=response, aliasing_limit_hz=limit),
        ),
        Picture(
            name="open_loop",
            caption="Open-loop responses calculated from it, with the covariance carried through (thesis, figure 3.8).",
            alt="Bode diagram of torque over speed error and of speed over torque.",
            chart=partial(open_loop_chart, governor, core, aliasing_limit_hz=limit),
        ),
    ]
    if inputs.line_selection:
        pictures.append(
            Picture(
                name="line_selection",
                caption="The same lines measured in several ways, points side by side (thesis, figure 3.5).",
                alt="Bode diagram with one set of points for each way to measure a sine.",
                chart=partial(bode_chart, data=inputs.line_selection, aliasing_limit_hz=limit),
            )
        )
    return Section(key="responses", title="Measured responses", pictures=pictures)


def time_section(inputs: Inputs) -> list[Section]:
    """Return chirps, neighbours of one name put end to end, and the last staircase, as far as they were recorded."""
    pictures = []
    recorded = [chirp for chirp in inputs.campaign.chirps if _is_recorded(chirp, inputs.signals)]
    for name, group in groupby(recorded, key=lambda chirp: chirp.name[:-1]):
        chirps = list(group)
        listed = ", ".join(chirp.name for chirp in chirps)
        pictures.append(
            Picture(
                name=picture_name("chirp", name),
                caption=f"Chirp {listed}: smallest and largest sample of each stretch (thesis, figures 3.9 and 3.10).",
                alt=f"Engine speed and shaft torque over time with the set point, chirp {listed}.",
                chart=partial(excitation_chart, inputs.signals, chirps),
            )
        )
    staircases = [stairs for stairs in inputs.campaign.staircases if _is_recorded(stairs, inputs.signals)]
    if staircases:
        last = staircases[-1].name
        pictures.append(
            Picture(
                name="staircase",
                caption=f"Staircase {last}: smallest and largest sample of each stretch (thesis, figure 3.11).",
                alt=f"Engine speed and shaft torque over time with the set point, staircase {last}.",
                chart=partial(staircase_chart, inputs.signals, inputs.campaign, name=last),
            )
        )
    return [Section(key="time", title="Time signals", pictures=pictures)] if pictures else []


def _is_recorded(test: "Excitation", signals: "Signals") -> bool:
    """Return whether the signals hold more than a second of a test: a recording may begin after it."""
    stop_s = signals.start_s + signals.samples / signals.rate_hz
    return min(test.stop_s, stop_s) - max(test.start_s, signals.start_s) > 1.0
