"""What ``inspect`` finds of a test, before anything is printed: its headline is made of it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from shaftprint.cli._inspect_headline import of_propeller
from shaftprint.cli.output._progress import progress
from shaftprint.errors import ForeignCampaignError, ShaftprintError, SignalError
from shaftprint.late import late
from shaftprint.reasons import Reason, doubt_scales

with late():
    from shaftprint.campaign._campaign import Campaign, load_campaign
    from shaftprint.cli._lying_files import lying_files
    from shaftprint.clocks._logger_clock import LoggerClock
    from shaftprint.design.operation._limit_use import LimitUse, limit_reasons, limit_uses, ratio_reasons, stated_limits
    from shaftprint.design.operation._recorded import recorded_operation
    from shaftprint.fingerprint._clock_influence import clock_findings, clock_influences
    from shaftprint.limits._limit_hints import limit_hints
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._channel_readings import ChannelReadings
    from shaftprint.signals._prepare import find_tests, prepare_signals
    from shaftprint.signals._signals import Signals
    from shaftprint.signals.excitation._found_test import FoundTest
    from shaftprint.signals.excitation._match import is_followed
    from shaftprint.spectra._spectra import Spectra, estimate_spectra
    from shaftprint.survey._legs import LegMeasurement, legs_of
    from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class InspectedTest:
    """What a recording shows of its test."""

    ship: Vessel
    """What was tested."""
    planned: Campaign
    """What was asked of the ship."""
    tests: tuple[FoundTest, ...]
    """Where each test is in the recorded set point; empty where they are not to be found."""
    signals: Signals | None
    """The prepared signals; None where they are refused."""
    spectra: Spectra | None
    """The test lines; None where they are refused."""
    legs: tuple[LegMeasurement, ...] = ()
    """The legs; empty where there are none."""
    uses: tuple[LimitUse, ...] = ()
    """How far the test went to the limits of ship and engine."""
    of_clocks: tuple[str, ...] = ()
    """What is found of the clocks of merged loggers."""
    hints: tuple[str, ...] = ()
    """What hints at limits of governor and engine."""
    refusal: ShaftprintError | None = None
    """Why the test cannot be used, if it cannot."""

    @property
    def parts(self) -> tuple[Spectra, ...]:
        """The spectra of the sines, or of every leg; empty where they are refused."""
        if self.spectra is None:
            return ()
        return (*([self.spectra] if self.planned.sines else []), *(leg.spectra for leg in self.legs))

    @property
    def reasons(self) -> tuple[Reason, ...]:
        """What speaks against its lines."""
        of_lines = tuple(reason for one in self.parts for reason in one.response.reasons)
        if self.signals is None or doubt_scales(of_lines):
            # a wrong scale makes the torque of the engine, which is at no limit
            return of_lines
        names = [*(one.name for one in self.planned.sines), *(leg.name for leg in self.legs)]
        of_gears = [one for one in of_propeller(self.signals, self.ship) if doubt_scales([one])]
        ratio = of_gears or ratio_reasons(self.uses, names, self.signals.working_point, self.ship)
        return (*of_lines, *(ratio or limit_reasons(self.uses, names)))


def tested(
    opened: Recording,
    ship: Vessel,
    asked: Campaign,
    readings: ChannelReadings,
    clocks: Sequence[LoggerClock],
    *,
    hidden: bool,
) -> InspectedTest:
    """Return all that is found of a test, before anything is printed: the headline is made of it."""
    tests: tuple[FoundTest, ...] = ()
    with progress(hidden=hidden) as steps:
        try:
            steps.begin("Preparing the signals")
            tests = find_tests(opened, ship, asked, readings=readings)
            signals = prepare_signals(opened, ship, asked, readings=readings)
            steps.begin("Measuring the test lines")
            legs = legs_of(signals, asked)
            spectra = estimate_spectra(signals, asked) if asked.sines else legs[0].spectra
            operation = recorded_operation(signals, asked, ship)
            return InspectedTest(
                ship=ship,
                planned=asked,
                tests=tests,
                signals=signals,
                spectra=spectra,
                legs=legs,
                uses=limit_uses(operation, stated_limits(ship)),
                of_clocks=clock_findings(clock_influences(clocks, spectra=spectra, signals=signals)),
                hints=limit_hints(spectra.harmonics) if asked.sines else (),
            )
        except ForeignCampaignError as error:
            fitting = _campaign_that_fits(opened, asked, readings)
            if fitting is None:
                return InspectedTest(ship=ship, planned=asked, tests=tests, signals=None, spectra=None, refusal=error)
            told = SignalError(
                f"{str(error).removesuffix(ForeignCampaignError.REMEDY)}; it is {fitting}, which fits: name that."
            )
            return InspectedTest(ship=ship, planned=asked, tests=(), signals=None, spectra=None, refusal=told)
        except ShaftprintError as error:
            # told below the tables too, which show what the campaign should be
            return InspectedTest(ship=ship, planned=asked, tests=tests, signals=None, spectra=None, refusal=error)


def _campaign_that_fits(opened: Recording, asked: Campaign, readings: ChannelReadings) -> Path | None:
    """Return the campaign file beside the recording, or in a folder of a plan there, that the set point follows."""
    if "n_set" not in readings.by_name:
        return None
    values, clock = readings.by_name["n_set"].values, readings.clock
    for path in reversed(lying_files(Path(opened.path).parent).campaigns):
        with suppress(ShaftprintError):
            campaign = load_campaign(path)
            if campaign != asked and is_followed(
                values, campaign.of_input(), rate_hz=clock.rate_hz, start_s=clock.start_s
            ):
                return path
    return None
