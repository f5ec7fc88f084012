"""When the best possible test would find slow wear, beside which ``benchmarks/histories.py`` shows when ``drift`` does.

How well one test knows the size of a cause is what pairs of the kept tests state, over the root of two. With that
deviation, noise that is independent from test to test and the level of the ship unknown, a ramp of known cause, sign
and beginning has a score that is normal about a known mean. Two limits follow. *Asked once*: whoever looks at this one
ramp after this one test alone, wrong in 5 % of sound ships; no test can find it earlier in as many ships (J. Neyman,
E. Pearson, "On the problem of the most efficient tests of statistical hypotheses", Philosophical Transactions of the
Royal Society A 231, 1933). *Asked after every test*: whoever looks at this one ramp after each of twenty tests with one
limit, wrong in 5 % of sound ships in five years; drawn. Run ``python benchmarks/history_limits.py FOLDER``, half a
minute; ``--write`` puts the table into docs/watching-measured.md.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.histories import DOCUMENT, SEED
from benchmarks.result_tables import write_between_marks
from benchmarks.sailed_histories import SOUND, TESTS
from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.drift._along import whitened
from shaftprint.drift._pair import pair_of
from shaftprint.fingerprint import Fingerprint, read_fingerprint

BEGIN, END = (
    "<!-- table of benchmarks/history_limits.py: begin -->",
    "<!-- table of benchmarks/history_limits.py: end -->",
)
UNLIKELY, ONE_SIDED_95, ONE_SIDED_90 = 0.05, 1.6448536269514722, 1.2815515655446004
DRAWS = 20_000
HEADER = (
    "wear", "one test knows its size to", "asked once: median", "nine of ten", "asked after every test: median",
    "nine of ten",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, slots=True)
class Wear:
    """A course whose cause, sign, speed and beginning are known."""

    name: str
    """In words."""
    cause: str
    """Name of the cause."""
    per_year: float
    """Share by which it grows in a year."""
    sound: int = 0
    """Tests of the sound ship before it."""


WEARS = (
    Wear(name="fouling of 3 % a year", cause="propeller", per_year=0.03),
    Wear(name="the same, after three tests of the sound ship", cause="propeller", per_year=0.03, sound=SOUND),
    Wear(name="injection wears 1 % a year", cause="injection or turbocharger", per_year=0.01),
    Wear(
        name="the same, after three tests of the sound ship", cause="injection or turbocharger", per_year=0.01,
        sound=SOUND,
    ),
)  # fmt: skip


def std_of_one_test(kept: Sequence[Fingerprint], cause: str) -> float:
    """Return the standard deviation with which a test knows the size of a cause, as its pairs state it."""
    variances = []
    for first, other in combinations(kept, 2):
        pair = pair_of(first, other, load_repeatability=LOAD_REPEATABILITY)
        if pair is None:
            raise ValueError("expected fingerprints with a joint covariance, found one without")
        white = whitened(pair.difference, pair.covariance, pair.directions)
        at = [one.name for one in pair.causes].index(cause)
        variances.append(float(white.sizes((at,))[1][0]) ** 2)
    return float(np.sqrt(0.5 * np.mean(variances)))


def growth(wear: Wear) -> np.ndarray:
    """Return what has grown at each test, in years of wear."""
    return np.maximum(np.arange(TESTS) - max(wear.sound - 1, 0), 0) / 4.0


def asked_once(wear: Wear, std: float, beyond: float) -> int | None:
    """Return the first test, from the first with the changed ship, at which a score is as far beyond the limit."""
    grown = wear.per_year * growth(wear) / std
    for tests in range(2, TESTS + 1):
        apart = grown[:tests] - grown[:tests].mean()
        if np.sqrt(apart @ apart) >= ONE_SIDED_95 + beyond:
            return tests - wear.sound
    return None


def asked_after_every(wear: Wear, std: float) -> tuple[float, float]:
    """Return at which test it is found in half and in nine of ten ships, by one limit for all tests; drawn."""
    grown = wear.per_year * growth(wear) / std
    noise = np.random.default_rng(SEED).standard_normal((DRAWS, TESTS))
    scores, means = np.full((DRAWS, TESTS + 1), -np.inf), np.zeros(TESTS + 1)
    for tests in range(2 + max(wear.sound - 1, 0), TESTS + 1):
        apart = grown[:tests] - grown[:tests].mean()
        means[tests] = np.sqrt(apart @ apart)
        scores[:, tests] = noise[:, :tests] @ apart / means[tests]
    limit = np.quantile(scores.max(axis=1), 1.0 - UNLIKELY)
    seen = scores + means >= limit
    late = np.where(seen.any(axis=1), seen.argmax(axis=1) - wear.sound, np.inf)
    return float(np.median(late)), float(np.quantile(late, 0.9, method="higher"))


def row(kept: Sequence[Fingerprint], wear: Wear) -> tuple[str, ...]:
    """Return the limits of one course."""
    std = std_of_one_test(kept, wear.cause)
    once = [asked_once(wear, std, beyond) for beyond in (0.0, ONE_SIDED_90)]
    every = asked_after_every(wear, std)
    return (wear.name, f"{100.0 * std:.2f} %", *(f"{at}" for at in once), *(f"{at:.0f}" for at in every))


def main() -> None:
    """Work out the limits and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="fingerprints that benchmarks/watching.py has kept")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    paths = sorted(options.folder.glob("short-*.json"), key=lambda path: int(path.stem.rpartition("-")[2]))
    unchanged = [path for path in paths if int(path.stem.rpartition("-")[2]) < 1000]
    kept = [one for one in map(read_fingerprint, unchanged) if one.verdict.trustworthy]
    lines = ["| " + " | ".join(HEADER) + " |", "|" + "---|" * len(HEADER)]
    lines += ["| " + " | ".join(row(kept, wear)) + " |" for wear in WEARS]
    text = "\n".join(lines) + "\n"
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
