"""How soon a report shows its first figure, and its first chart: ``python -m benchmarks.first_plot FOLDER``.

Opens ``index.html`` of the folder from the disk in headless chromium, each time a new browser with nothing kept of the
one before, and prints when, after the start of the navigation, the page is first painted, the first figure can be
seen, static or not, and the first chart is drawn. Needs playwright and a chromium; not part of the other rows, which
need no browser.
"""

import argparse
import os
import time
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import sync_playwright

from benchmarks.timing import Spread, print_table

CHROMIUM = "/usr/bin/chromium"
ARGUMENTS = ("--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking")
LONGEST_S = 60.0
# Asked before each frame is painted, marked before the next: a picture that is loaded, or a chart that is drawn, in a
# box that is not empty.
WATCH = """(() => {
  const seen = element => element.checkVisibility({visibilityProperty: true}) && element.offsetWidth > 0;
  const shown = figure => [...figure.querySelectorAll('img, .plot')].some(part => seen(part)
    && (part.tagName === 'IMG' ? part.complete && part.naturalWidth > 0 : part.dataset.state === 'drawn'));
  const look = () => {
    const found = [...document.querySelectorAll('figure')].some(shown);
    requestAnimationFrame(found ? () => performance.mark('figure seen') : look);
  };
  requestAnimationFrame(look);
})()"""
MARKS = {"page painted": "first-contentful-paint", "first figure seen": "figure seen", "first chart": "plot drawn"}


@dataclass(frozen=True, slots=True)
class Opening:
    """One opening of a page: seconds from the start of the navigation, by what is seen."""

    seconds: dict[str, float]


def opened(page: Path) -> Opening:
    """Open a page in a new browser and return when its figures were there.

    Raises
    ------
    TimeoutError
        If the first chart is not drawn within a minute.
    """
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=list(ARGUMENTS))
        try:
            tab = browser.new_page(viewport={"width": 1280, "height": 900})
            tab.add_init_script(WATCH)
            tab.goto(page.as_uri(), wait_until="commit")
            end = time.monotonic() + LONGEST_S
            while time.monotonic() < end:
                # Asked seldom, so that asking costs the page nothing.
                tab.wait_for_timeout(300)
                names = list(MARKS.values())
                found = tab.evaluate("names => names.map(n => performance.getEntriesByName(n)[0]?.startTime)", names)
                if None not in found:
                    return Opening(seconds={name: ms / 1e3 for name, ms in zip(MARKS, found, strict=True)})
        finally:
            browser.close()
    raise TimeoutError(f"{page}: expected a first chart within {LONGEST_S:.0f} s, found none.")


def main() -> None:
    """Open a report again and again and print when its figures were there."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.first_plot", description=__doc__)
    parser.add_argument("folder", type=Path, nargs="+", help="folder of a report; several are opened in turn")
    parser.add_argument("--repetitions", type=int, default=10, help="how often each is opened")
    chosen = parser.parse_args()
    pages = [(folder / "index.html").resolve(strict=True) for folder in chosen.folder]
    turns = [[opened(page) for page in pages] for _ in range(chosen.repetitions)]
    rows = []
    for folder, found in zip(chosen.folder, zip(*turns, strict=True), strict=True):
        for name in MARKS:
            spread = Spread(tuple(one.seconds[name] for one in found))
            rows.append((str(folder), name, f"{spread.median:.2f}", f"{max(spread.values):.2f}"))
    load = f"load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "load unknown"
    title = f"Seconds after the start of the navigation, {chosen.repetitions} openings, {load}"
    print_table(title, ("report", "what", "median", "maximum"), rows)


if __name__ == "__main__":
    main()
