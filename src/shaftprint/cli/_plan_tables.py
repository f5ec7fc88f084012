"""A planned test on the terminal: the answer first, then what it would tell, its legs and the card for the bridge."""

from __future__ import annotations

from pathlib import Path

from shaftprint.cli._terminal import answer, echo, print_findings
from shaftprint.cli.output._fingerprint_file import REPORT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.design.files import _plan_folder, _plan_json, _set_point_files
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.views._abort_card import abort_card
    from shaftprint.tables._plan import abort_table, planned_leg_table, predicted_number_table, wish_table


def print_planned_test(planned: PlannedTest, folder: Path) -> None:
    """Print what a planned test reaches.

    ``planned``: the test. ``folder``: where its files are.
    """
    first, *others = planned.sentences
    answer(first)
    echo()
    card = abort_card(planned)
    print_tables([wish_table(planned)])
    print_findings("What to know of it", [*others, f"Planned with the {planned.noise_source}."])
    print_tables([predicted_number_table(planned), planned_leg_table(planned), abort_table(card)])
    give("duration_s", planned.campaign.duration_s)
    give("rehearsed", planned.rehearsal is not None)
    give("met", planned.plan.is_enough)
    give("predicted", list(planned.plan.promised.values()))
    give("wished_std", planned.plan.targets)
    give("remedies", planned.remedies)
    give("card", card)
    echo(f"Page:      {folder / REPORT}")
    echo(f"Campaign:  {folder / _plan_folder.CAMPAIGN}")
    files = (_set_point_files.CSV, _set_point_files.GENERATOR, _set_point_files.MAT)
    echo(f"Set point: {', '.join(str(folder / name) for name in files)}")
    echo(f"Plan:      {folder / _plan_json.PLAN}")
