"""The pictures of docs/serve.md: pages of a small fleet in chromium. Run ``python docs/images/serve.py FINGERPRINT``.

FINGERPRINT is the file of a fingerprint, such as that of ``shaftprint demo --short``; the histories are drawn from it.
"""

import argparse
import json
import sys
import tempfile
import threading
import time
import urllib.request
from datetime import UTC, datetime
from pathlib import Path

from playwright.sync_api import sync_playwright

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))

from benchmarks.served_fleet import LIVES, fill  # noqa: E402

from shaftprint.store import create_store  # noqa: E402
from shaftprint.web import Listen, Serving, serve  # noqa: E402

CHROMIUM = "/usr/bin/chromium"
NOW = datetime(2026, 11, 24, 12, tzinfo=UTC)
PICTURES = {"serve": ("/", 860), "serve-line": ("/ships/9074729/port", 1150)}
WIDTH_PX = 1200


def main() -> None:
    """Fill a store, serve it, and take the pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("fingerprint", type=Path)
    base = json.loads(parser.parse_args().fingerprint.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder, "fleet.db")
        with create_store(str(store)) as opened:
            fill(opened, base, now=NOW)
        serving = Serving(
            store=str(store), state=Path(folder, "state"), listen=Listen(host="127.0.0.1", port=0), workers=0
        )
        begun: list[str] = []
        arguments = {"begun": begun.append, "now": lambda: NOW}
        threading.Thread(target=serve, args=(serving,), kwargs=arguments, daemon=True).start()
        while not begun or not all_judged(begun[0]):
            time.sleep(0.5)
        take(begun[0])


def all_judged(address: str) -> bool:
    """Return whether every line has its word."""
    with urllib.request.urlopen(f"{address}api/v1/ships") as answer:  # noqa: S310
        lines = json.load(answer)["lines"]
    return len(lines) == len(LIVES) and not any(one["kind"] == "being judged" for one in lines)


def take(address: str) -> None:
    """Take the pictures."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for name, (path, height) in PICTURES.items():
            page = browser.new_page(viewport={"width": WIDTH_PX, "height": height})
            page.goto(address + path.removeprefix("/"))
            page.screenshot(path=str(HERE / f"{name}.png"))
        browser.close()


if __name__ == "__main__":
    main()
