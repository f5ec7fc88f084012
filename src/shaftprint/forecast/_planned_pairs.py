"""The structure of ``predict`` with the planned lines that it will be fitted to, at each working point."""

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import StructureError
from shaftprint.forecast._test_noise import TestNoise
from shaftprint.identify.prediction._planned_legs import PlannedLeg, planned_beside, planned_legs
from shaftprint.identify.prediction._planned_response import expected_response, planned_response
from shaftprint.models._structure import Structure
from shaftprint.signals._moved_beside import EXCITATIONS, MovedBeside, moved_beside
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._leg_spectra import SPEED
from shaftprint.spectra._open_loop import open_loop
from shaftprint.survey._of_vessel import default_structure, expect_one_speed, of_vessel

Pair = tuple[Structure, FrequencyResponse]


def planned_pairs(chosen: Structure, campaign: Campaign, ship: TestNoise) -> list[Pair]:
    """Return the structure with the planned lines from its input to its outputs, at each working point.

    A structure with several inputs is taken apart by input, as for ``identify``: each has lines of its own. One that
    the campaign does not move has none.

    Raises StructureError if the lines of a campaign do not give these.
    """
    if ship.vessel is not None:
        expect_one_speed(campaign, ship.vessel)
    if chosen.inputs[0] != SPEED or len(chosen.inputs) == 1:
        return _pairs_of_speed(chosen, campaign, ship)
    further = _further(chosen, campaign, ship)
    legs = _legs(campaign, ship)
    pairs = _pairs_of_speed(chosen.of_input(SPEED), campaign, ship)
    for moved in further:
        part, noise = chosen.of_input(moved.symbol), ship.noise_beside[moved.symbol]
        alone = campaign.of_input(moved.input)
        if alone.sines:
            pairs.append((part, _shown(part, planned_response(alone, noise, excitation=moved.symbol))))
        for leg in legs:
            beside = campaign.beside(next(one for one in campaign.legs if one.name == leg.name))
            pairs += [
                (leg.structure(part), _shown(part, planned_beside(one, noise, excitation=moved.symbol)))
                for one in beside
                if one.input == moved.input
            ]
    return pairs


def _further(chosen: Structure, campaign: Campaign, ship: TestNoise) -> list[MovedBeside]:
    """Return what the campaign moves of the further inputs of a structure.

    Raises StructureError if an input is none that a campaign moves, or nothing is known of the noise under it.
    """
    there = () if ship.vessel is None else moved_beside(ship.vessel, campaign)
    known = {one.symbol: one for one in there if one.symbol in ship.noise_beside}
    for name in chosen.inputs[1:]:
        if name not in known and EXCITATIONS.get(name) in (None, *campaign.inputs):
            raise _not_known(chosen, ship.noise.outputs)
    return [known[name] for name in chosen.inputs[1:] if name in known]


def _legs(campaign: Campaign, ship: TestNoise) -> tuple[PlannedLeg, ...]:
    rises = ship.slope_rpm_per_v > 0.0
    return planned_legs(campaign, ship.noise_of_legs, rises=rises, first_share=ship.first_share)


def _pairs_of_speed(chosen: Structure, campaign: Campaign, ship: TestNoise) -> list[Pair]:
    """Return what the lines of the speed's set point tell."""
    loop, of_speed = shipped_structure(default_structure(ship.vessel)), campaign.of_input()
    if ship.vessel is not None:
        loop = of_vessel(loop, ship.vessel)
    if len(loop.inputs) > 1:
        loop = loop.of_input(SPEED)
    tests = [(chosen, loop, planned_response(of_speed, ship.noise))] if of_speed.sines or not of_speed.legs else []
    tests += [(leg.structure(chosen), leg.structure(loop), leg.response) for leg in _legs(campaign, ship)]
    return [(at_leg, _from_input(at_leg, loop_there, closed)) for at_leg, loop_there, closed in tests]


def _from_input(chosen: Structure, loop: Structure, closed: FrequencyResponse) -> FrequencyResponse:
    """Return planned lines from a structure's input to its outputs, of those from the set point."""
    responses = {SPEED: closed}
    if chosen.inputs in (("e",), ("M_s",)):
        shown = closed.of_outputs(*loop.outputs)
        governor, core = open_loop(expected_response(shown, loop))
        responses |= {"e": governor, "M_s": core}
    response = responses.get(chosen.input) if len(chosen.inputs) == 1 else None
    if response is None:
        raise _not_known(chosen, closed.outputs)
    return _shown(chosen, response)


def _shown(chosen: Structure, response: FrequencyResponse) -> FrequencyResponse:
    if not set(chosen.outputs) <= set(response.outputs):
        raise _not_known(chosen, response.outputs)
    return response


def _not_known(chosen: Structure, known: tuple[str, ...]) -> StructureError:
    return StructureError(
        f"structure {chosen.name} goes from {', '.join(chosen.inputs)} to {', '.join(chosen.outputs)}; expected the "
        f"noise of all its outputs under what the campaign moves, found that of {', '.join(known)} alone. Give a "
        "recording of the other channels with --from."
    )
