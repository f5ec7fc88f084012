"""Plans that are looked for with a tenth of the usual effort: they meet what is wished, and need not be the best.

``tests/design`` and ``benchmarks/planned_tests.py`` plan with all of it.
"""

import pytest

from shaftprint.design import Effort

LITTLE = {"steps": 60, "restarts": 1}


def with_little_effort(patch: pytest.MonkeyPatch) -> None:
    """Have every plan looked for with little effort while a patch holds."""
    for name, little in LITTLE.items():
        patch.setitem(Effort.__init__.__kwdefaults__, name, little)
