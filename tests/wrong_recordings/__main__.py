"""Print what shaftprint answers to every wrong recording: ``python -m tests.wrong_recordings [part of a name]``."""

import sys
import time

from tests.wrong_recordings.cases import CASES
from tests.wrong_recordings.judged import answer

for case in CASES:
    if len(sys.argv) > 1 and not any(part in case.name for part in sys.argv[1:]):
        continue
    begin = time.process_time()
    found = answer(case)
    print(f"{'ok ' if found.passes else 'BAD'} {case.name}: {found.outcome} ({time.process_time() - begin:.1f} s)")
    if found.wrong:
        print("      wrong:", ", ".join(found.wrong))
    print("      ", found.words[:400], flush=True)
