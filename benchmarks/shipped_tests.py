"""The short tests that come with the package: designed for the shipped Stan Tug and written as campaign files.

Limits are those of its vessel file, and the set point moves by 1 V at most. The plan knows governor and engine of the
simulated tug; for a ship that is not known so well, plan its own test. Run ``python -m benchmarks.shipped_tests`` (a
few seconds each) to make the files again, with ``--output FOLDER`` elsewhere; with ``--sail 20`` to sail the files as
they are and to identify them (four seconds of processor time a recording), nothing of the builder known.
"""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.planned_tests import OFFSET_V, SLOPE_RPM_PER_V, TRUTH, VESSEL, Case, outcomes_of, planned
from benchmarks.planned_tests_tables import case_table
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.campaign._file_text import campaign_text
from shaftprint.design import campaign_of, limits_from_vessel

SHIPPED = Path(__file__).parent.parent / "src" / "shaftprint" / "campaign" / "shipped"
SET_POINT_RPM = 251.0
SPEEDS = (1.15, 0.78)
SAMPLE_RATE_HZ = 2000.0


@dataclass(frozen=True, kw_only=True, slots=True)
class ShippedTest:
    """One campaign file of the package."""

    name: str
    """Name of the campaign."""
    minutes: float
    """Length [min]."""
    words: Sequence[str]
    """What stands at the top of the file."""


TESTS: Mapping[str, ShippedTest] = {
    "12min": ShippedTest(
        name="12 minutes, two speeds",
        minutes=12.0,
        words=("Twelve minutes at two speeds, 1.15 and 0.78 of the working speed, for the Stan Tug 1205.",),
    ),
    "5min": ShippedTest(
        name="5 minutes, two speeds",
        minutes=5.0,
        words=(
            "Five minutes at two speeds, 1.15 and 0.78 of the working speed, for the Stan Tug 1205: what matters of a",
            "line, half as well known as after twelve minutes.",
        ),
    ),
}
REMARKS = (
    "Lines, amplitudes and phases were designed together (benchmarks/shipped_tests.py): they tell most of this line",
    "within 1 V of the set point and the limits of its vessel file, which are idle and rated speed, full load and",
    "motoring torque, with room for the noise. On another ship the torque swings otherwise: plan a test of its own.",
)


def case_of(test: ShippedTest) -> Case:
    """Return what the test is planned for."""
    limits = limits_from_vessel(VESSEL, set_point_rpm=SET_POINT_RPM)
    return Case(name=test.name, limits=limits, speeds=SPEEDS, minutes=test.minutes)


def campaign_of_test(test: ShippedTest) -> Campaign:
    """Return the campaign of a test, in tens of microvolts and of microradians."""
    campaign = campaign_of(planned(case_of(test)), name=test.name, offset_v=OFFSET_V, slope_rpm_per_v=SLOPE_RPM_PER_V)
    legs = tuple(
        one.model_copy(
            update={
                "amplitudes_v": tuple(round(value, 5) for value in one.amplitudes_v),
                "phases_rad": tuple(round(value, 5) for value in one.phases_rad),
            }
        )
        for one in campaign.multisines
    )
    return campaign.model_copy(update={"multisines": legs, "sample_rate_hz": SAMPLE_RATE_HZ})


def sail_file(file: str, test: ShippedTest, seeds: int) -> None:
    """Sail a shipped campaign and print its errors beside what was planned."""
    case, plan = case_of(test), planned(case_of(test))
    outcomes = list(outcomes_of(case, load_campaign(file), range(1, seeds + 1)))
    predicted = {name: plan.predicted.estimate(name).std for name in outcomes[0].error}
    print(case_table(case.name, outcomes, predicted, TRUTH, {}))


def main() -> None:
    """Design the tests and write their files."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=SHIPPED, help="folder of the files")
    parser.add_argument("--test", choices=list(TESTS), help="one of them alone")
    parser.add_argument("--sail", type=int, default=0, help="recordings to sail of each file, instead of making it")
    options = parser.parse_args()
    for file, test in TESTS.items():
        if options.test not in (None, file):
            continue
        if options.sail:
            sail_file(file, test, options.sail)
        else:
            text = campaign_text(campaign_of_test(test), remarks="\n".join((*test.words, *REMARKS)))
            (options.output / f"{file}.toml").write_text(text, encoding="utf-8")
            print(options.output / f"{file}.toml")


if __name__ == "__main__":
    main()
