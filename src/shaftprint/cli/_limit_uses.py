"""The limits of ship and engine on the terminal: what a test leaves, and how near it comes to each."""

from __future__ import annotations

from collections.abc import Sequence

from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_table
from shaftprint.late import late

with late():
    from shaftprint.design.operation._limit_use import LimitUse
    from shaftprint.tables._limit_uses import limit_use_sentences, limit_use_table


def print_limit_uses(uses: Sequence[LimitUse], *, is_expected: bool) -> None:
    """Print which excitation leaves which limit of the vessel file, and the nearest instant to each.

    ``uses``: from ``limit_uses``. ``is_expected``: whether they are of a campaign that has not been sailed.
    """
    expected = "Expected with the assumed values, without noise and as if no limit acted."
    recorded = "Averaged over 0.1 s; the brake torque from torque and speed at the gauge and the upstream inertia."
    title = "The test would leave limits of ship and engine" if is_expected else "Limits that the test has left"
    print_findings(title, limit_use_sentences(uses))
    print_table(limit_use_table(uses, note=expected if is_expected else recorded))
    give("limits", uses)
