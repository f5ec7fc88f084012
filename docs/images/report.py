"""Pictures of page one, light and dark: run ``shaftprint demo``, then ``python docs/images/report.py demo``."""

import argparse
from pathlib import Path

from playwright.sync_api import sync_playwright

HERE = Path(__file__).parent
CHROMIUM = "/usr/bin/chromium"
WIDTH_PX, SCALE = 1060, 1.25


def main() -> None:
    """Take both pictures of a report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report", type=Path, help="folder of the report, such as demo")
    page_of = parser.parse_args().report / "index.html"
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for look, name in (("light", "report"), ("dark", "report-dark")):
            size = {"width": WIDTH_PX, "height": 900}
            page = browser.new_page(viewport=size, device_scale_factor=SCALE, color_scheme=look)
            page.goto(page_of.resolve().as_uri())
            end = page.locator("#found").bounding_box()
            whole = {"x": 0, "y": 0, "width": WIDTH_PX, "height": end["y"] + end["height"] + 12}
            page.screenshot(path=str(HERE / f"{name}.png"), clip=whole, full_page=True)
        browser.close()


if __name__ == "__main__":
    main()
