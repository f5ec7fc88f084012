"""What comes after a test that was identified: its validation, and the next test."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from shaftprint.cli._next import first_plan, plan_after, read_by_all
from shaftprint.errors import FingerprintError, ShaftprintError
from shaftprint.late import late

with late():
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.design.files import _plan_folder, _plan_json
    from shaftprint.design.plan._plan import Plan
    from shaftprint.design.planned_test import _hidden
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel


# Of these reasons another test is the cure, or another structure.
_LACKS_LINES, _OTHER_STRUCTURE = {"too few data", "gap"}, {"misfit", "suspect"}


def after_test(
    files: tuple[object, str | Path, str | Path],
    found: tuple[object, Fingerprint],
    ship: Vessel,
    asked: Campaign,
    *,
    reading: Sequence[object] = (),
    own: Sequence[object] = (),
    is_undecided: bool = False,
) -> list[tuple[object, ...]]:
    """Return the next commands of a test, the first to be done first; none where something has to be mended before.

    A test that cannot be used is made anew where it lacks lines, and other structures are tried where one does not
    explain it; else its verdict says what to mend. Another one is validated, where there is what it can be validated
    on and noise does not hide it; then its plan goes on where wishes of it are not met, or the next test is planned.

    ``files``: recording, vessel and campaign file. ``found``: where the result is, and its fingerprint. ``ship``,
    ``asked``: what is in the vessel and the campaign file. ``reading``: options with what the recording does not say
    itself. ``own``: the option that names a structure of somebody's own. ``is_undecided``: whether it was held against
    its steps already, and noise hid how well it meets them.
    """
    recording, vessel, campaign = files
    result, fingerprint = found
    if not fingerprint.verdict.trustworthy:
        kinds = {reason.kind for reason in fingerprint.verdict.reasons[:1]}
        if kinds & _OTHER_STRUCTURE:
            readable, steps = read_by_all(recording, reading)
            return [*steps, ("compare-structures", readable, "--vessel", vessel, "--campaign", campaign)]
        return [first_plan(vessel, ship, reach_of(campaign, asked))] if kinds & _LACKS_LINES else []
    plan = _plan_of(Path(campaign))
    goes_on = plan is not None and any(_is_open(fingerprint, *target) for target in plan.targets.items())
    tells = not is_undecided and not (plan is not None and _hidden.stairs_sentences(plan))
    is_validated = tells and bool(asked.staircases or asked.chirps)
    readable, steps = read_by_all(recording, reading if is_validated or goes_on else ())
    if is_validated:
        steps += [("validate", readable, "--vessel", vessel, "--campaign", campaign, "--fingerprint", result, *own)]
    if not goes_on:
        return [*steps, (*plan_after(result, vessel, ship, reach_of(campaign, asked)), *own)]
    return [*steps, ("continue", readable, "--plan", Path(campaign).parent, "--vessel", vessel, *own)]


def reach_of(campaign: str | Path, asked: Campaign) -> str:
    """Return how far the set point may go from its levels, such as ``60rpm``; empty where no plan says it.

    It is the limit of the plan that the campaign is of; of a campaign alone that was planned, as far as it goes itself.
    ``campaign``, ``asked``: the campaign file, and what is in it.
    """
    plan = _plan_of(Path(campaign))
    if plan is not None:
        return _rpm(plan.limits.set_point_rpm)
    if not asked.legs or asked.slope_rpm_per_v is None:
        return ""
    deviations_v = [abs(end - leg.level_v) for leg in asked.legs for end in leg.extremes_v]
    return _rpm(abs(asked.slope_rpm_per_v) * max(deviations_v))


def _rpm(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}rpm"


def _plan_of(campaign: Path) -> Plan | None:
    """Return the plan in the folder of a campaign file; None where there is none, or none that can be read."""
    folder = campaign.parent
    if campaign.name == _plan_folder.CAMPAIGN and (folder / _plan_json.PLAN).is_file():
        # a plan that cannot be read, or of a structure of somebody's own, is no reason to refuse what was identified
        with suppress(ShaftprintError):
            return _plan_json.read_plan(folder).plan
    return None


def _is_open(fingerprint: Fingerprint, name: str, target: float) -> bool:
    try:
        return not fingerprint.quantity(name).std <= target
    except FingerprintError:
        return True
