"""Why numbers may not be trusted, and what to do about it, in words for the first page.

The verdict says the same with channels, test lines and numbers; it stands on the page after.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from shaftprint.reasons import Reason, ReasonKind

_WORDS: "Mapping[ReasonKind, tuple[str, str]]" = {
    "recording clock": (
        "The clock of the logger was wrong.",
        "Check the sample rate that the logger states, then identify once more.",
    ),
    "channel clock": (
        "The channels do not share one clock.",
        "Record all channels with one logger, or merge the files of both loggers anew.",
    ),
    "held samples": (
        "A channel stood still or was filtered while the ship moved.",
        "Check telemetry and logger for lost values, holds and filters, and repeat the test.",
    ),
    "set-point band": (
        "The recorded speed set point is slower than what was sent.",
        "Log the set point where it enters the governor, without a filter, mean or hold, and repeat the test.",
    ),
    "clipping": (
        "The torque reached the end of its measuring range.",
        "Set a larger range of the torque telemetry and repeat the test.",
    ),
    "gauge steadiness": (
        "The torque gauge or the load did not stay the same during the test.",
        "Check gauge and telemetry, and repeat the test in calm, deep water.",
    ),
    "engine limit": (
        "The engine was at its limit for a part of the test.",
        "Repeat the test with smaller moves of the set point or at a lower speed.",
    ),
    "legs apart": (
        "The line is not the same at all speeds of the test.",
        "Identify each speed alone; ask an engineer whether the governor has gains or delays that go with the speed.",
    ),
    "gauge scale": (
        "The scale of the torque gauge is in doubt.",
        "Calibrate the torque gauge, or correct its scale or the propeller's diameter in the vessel file; then "
        "identify once more.",
    ),
    "gauge zero": (
        "The torque gauge does not show nothing where there is no torque.",
        "Take its zero with the shaft standing free, correct it in the vessel file, then identify once more.",
    ),
    "gauge line": (
        "The torque gauge has a zero, or shows large torques by another factor than small ones.",
        "Take its zero with the shaft standing free, and test at two speeds; then identify once more.",
    ),
    "speed scale": (
        "The speed is off by one factor.",
        "Check how many pulses the pick-up gives in a turn, correct the vessel file, then identify once more.",
    ),
    "set-point shape": (
        "The speed set point was not recorded as it was sent.",
        "Log the set point where it enters the governor, without a filter, and repeat the test.",
    ),
    "late set point": (
        "The speed set point was logged late.",
        "Ask what delays its channel, such as a gateway; gains and margins do not depend on it.",
    ),
    "late pitch feedback": (
        "The pitch was logged late.",
        "State latency_s of the pitch feedback, or ask what delays its channel; gains and margins do not depend on it.",
    ),
    "set-point scale": (
        "The scale of the speed set point is in doubt.",
        "Add a staircase of speed steps to the test, or check the wiring of the set point.",
    ),
    "gauge latency": (
        "The delay of the torque telemetry is not what the vessel file says.",
        "Ask its maker for the delay and correct the vessel file, then identify once more.",
    ),
    "hidden inertia": (
        "The torque does not show the inertia of the propeller.",
        "Switch off the filter of the torque gauge, or check the masses in the vessel file; then repeat the test.",
    ),
    "prior": (
        "The measurement contradicts what was assumed of the ship.",
        "Check inertia, gear ratio and gauge in the vessel file, then identify once more.",
    ),
    "record": (
        "A record was not taken as it is said to be.",
        "Correct the file that describes it, then identify once more.",
    ),
    "gear ratio": (
        "The gear ratio is not what the vessel file says.",
        "Check gear ratio and pulses per revolution in the vessel file, then identify once more.",
    ),
    "propeller": (
        "The torque fits a propeller of another size than the vessel file says.",
        "Check diameter and pitch of the propeller in the vessel file, then identify once more.",
    ),
    "elastic coupling": (
        "The shaft line twists in a coupling, which the model does not know.",
        "Identify once more with the model of an elastic line; the next page names it.",
    ),
    "misfit": (
        "The model does not explain the measurements.",
        "Have an engineer compare other model structures, and look for what was changed during the test.",
    ),
    "contradicting data": (
        "Parts of the test contradict each other.",
        "Look for what was changed during the test; repeat it with the ship left as it is.",
    ),
    "suspect": (
        "The model may lack a part of the line.",
        "Have an engineer compare other model structures.",
    ),
    "too few data": (
        "Too few of the test frequencies could be measured well.",
        "Repeat the test with larger moves of the set point, or for longer.",
    ),
    "gap": (
        "No test frequency lies where the governor decides on hunting.",
        "Add frequencies there to the test; an engineer can plan them.",
    ),
    "unstable": (
        "The model that explains the measurements best hunts, and the ship did not.",
        "Do not use these numbers; have an engineer look at delays and sensors of the vessel file.",
    ),
    "not unique": (
        "Several different sets of numbers explain the measurements equally well.",
        "Repeat the test with more frequencies, or log the engine's control unit as well.",
    ),
    "lines left out": (
        "The model does not hold at the test frequencies that were left out.",
        "Have an engineer look at why they were left out.",
    ),
}


# Their sentences end with the field or sensor that mends them, which may be another than the usual one.
_TOLD: "frozenset[ReasonKind]" = frozenset(
    (
        "speed scale",
        "gauge scale",
        "gear ratio",
        "propeller",
        "set-point scale",
        "gauge zero",
        "recording clock",
    )
)


def words_of(reason: "Reason") -> tuple[str, str]:
    """Return what is in doubt and what to do, each in one sentence: what the verdict says to do where it does."""
    words, usual = _WORDS[reason.kind]
    _, parted, told = reason.sentence.rpartition("; ")
    if reason.kind not in _TOLD or not parted:
        return words, usual
    return words, f"{told[:1].upper()}{told[1:].removesuffix('.')}."
