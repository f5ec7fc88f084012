"""Pages in Debian's chromium: nothing too wide, contrast, keyboard, no other host; a job that goes on after a kill."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from datetime import UTC, datetime

import pytest

pytest.importorskip("starlette", reason="pages need starlette")
pytest.importorskip("sqlalchemy", reason="a store needs SQLAlchemy")

from benchmarks.store_documents import document
from tests.web.test_windows import recorded

from shaftprint import __version__
from shaftprint.store import (
    JobRequest,
    add_document,
    claim,
    create_store,
    enqueue,
    open_store,
    record_event,
    refuse,
    renew,
)
from shaftprint.web._kept import Kept, Making, Upload

pytestmark = pytest.mark.slow
NOW = datetime(2026, 11, 24, 12, tzinfo=UTC)
ADA = 9074729
# Contrast of WCAG 2.2, 1.4.3, of every text that is seen, against the first background behind it that is not clear.
CONTRAST = """() => {
  const linear = (c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
  const behind = (element) => {
    for (let one = element; one; one = one.parentElement) {
      const colour = numbers(getComputedStyle(one).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  const found = [];
  for (const element of document.querySelectorAll("body *")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own || !element.getClientRects().length) continue;
    const style = getComputedStyle(element);
    const svg = element instanceof SVGElement;
    if (svg && element.tagName === "title") continue;
    const one = luminance(numbers(svg ? style.fill : style.color)), two = luminance(behind(element));
    const ratio = (Math.max(one, two) + 0.05) / (Math.min(one, two) + 0.05);
    if (ratio < 4.5) found.push(`${element.tagName} ${element.textContent.trim().slice(0, 40)} ${ratio.toFixed(2)}`);
  }
  return found;
}"""


class Server:
    """A server of pages in a process of its own."""

    def __init__(self, folder, port=0):
        self.folder, self.port = folder, port
        self.begin()

    def begin(self):
        """Begin it, on the port that it had."""
        command = [sys.executable, "-m", "shaftprint", "serve", "--store", self.folder / "fleet.db", "--workers", "0",
                   "--state", self.folder / "state", "--listen", f"127.0.0.1:{self.port}"]  # fmt: skip
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
        line = self.process.stdout.readline()
        self.port = int(re.search(r":(\d+)/", line)[1])
        self.address = f"http://127.0.0.1:{self.port}"

    def kill(self):
        """End it and what it has begun, as a crash does."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.process.stdout.close()


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    ship = {"name": "Ada of a long name that no table has room for", "imo_number": ADA, "line": "port"}
    with create_store(str(folder / "fleet.db")) as store:
        for year in (24, 25, 26):
            when, recording = f"20{year}-03-01T10:00:00+01:00", f"{year:064x}"
            add_document(
                store, document(tested_at=when, recording=recording, ship=ship, seed=year), named="Ada", now=NOW
            )
        record_event(store, str(ADA), "docking", at=datetime(2025, 9, 1, tzinfo=UTC), note="note " * 30)
        args = {"recording": "/data/log.nc", "vessel": "stan-tug-1205", "campaign": "short"}
        enqueue(store, [JobRequest(key=f"{ADA:064x}", args=args, version=__version__)], now=NOW)
    return folder


@pytest.fixture(scope="module")
def server(store):
    """The one server of all these pages."""
    running = Server(store)
    yield running
    running.kill()


@pytest.fixture(scope="module")
def windows(server):
    """Give the address of the windows of an upload that was looked at."""
    number, kept = "00000000000000aa", Kept.at(server.folder / "state" / "server.db")
    folder = server.folder / "state" / "recordings" / number
    if not folder.exists():
        folder.mkdir()
        (folder / "log.nc").write_bytes(b"no recording")
        line = {"imo": ADA, "ship": "Ada of a long name that no table has room for", "line": "port"}
        kept.put_upload(
            Upload(id=number, name="log.nc", size=12, sha256="ab" * 32, person="x", at=NOW.isoformat(), **line)
        )
        key, args = f"windows {number} stan-tug-1205 short", {"answer": recorded()}
        kept.put_making(Making(key=key, kind="windows", args=args, state="done", sentence=""))
    kept.close()
    return f"{server.address}/recordings/{number}/windows?vessel=stan-tug-1205&campaign=short"


def paths_of(page, server):
    page.goto(f"{server.address}/ships/{ADA}/port")
    shas = page.eval_on_selector_all("a[href^='/trials/']", "links => links.map(one => one.getAttribute('href'))")
    a, b = (one.rpartition("/")[2] for one in (shas[-1], shas[0]))
    return (
        "/",
        f"/ships/{ADA}/port",
        shas[0],
        f"/compare?a={a}&b={b}",
        "/jobs",
        "/jobs/1",
        "/upload",
        "/recordings/00000000000000aa",
        "/recordings/00000000000000aa/windows?vessel=stan-tug-1205&campaign=short",
        "/kiosk",
        "/audit",
        "/nothing",
    )


@pytest.mark.parametrize("width", [375, 1440])
@pytest.mark.parametrize("look", ["light", "dark"])
@pytest.mark.usefixtures("windows")
def test_pages_fit_and_can_be_read(browser, server, width, look):
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=look)
    page, requests, messages = context.new_page(), [], []
    context.on("request", lambda request: requests.append(request.url))
    page.on("console", lambda message: messages.append(message.text))
    for path in paths_of(page, server):
        page.goto(f"{server.address}{path}", wait_until="domcontentloaded")
        page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
        assert page.evaluate("document.documentElement.scrollWidth") <= width, path
        assert page.evaluate(CONTRAST) == [], path
    assert {re.match(r"http://([^/]*)", url)[1] for url in requests} == {f"127.0.0.1:{server.port}"}
    # the page that is not there says so
    assert [one for one in messages if "404" not in one] == []
    context.close()


def test_pages_work_with_the_keyboard_and_without_scripts(browser, server):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{server.address}/")
    page.keyboard.press("Tab")
    # the first stop leads past what stands on every page
    page.keyboard.press("Enter")
    assert page.url.endswith("#content")
    page.get_by_role("searchbox").focus()
    page.keyboard.type("port")
    page.keyboard.press("Enter")
    page.wait_for_url("**/?q=port*")
    page.get_by_role("link", name="Ada").focus()
    page.keyboard.press("Enter")
    page.wait_for_url(f"**/ships/{ADA}/port")
    page.locator("summary", has_text="Note what was done").focus()
    page.keyboard.press("Enter")
    page.get_by_label("Note", exact=True).focus()
    page.keyboard.type("by hand")
    page.get_by_label("When").focus()
    page.get_by_label("When").fill("2026-05-01T08:00")
    page.get_by_role("button", name="Note it").focus()
    page.keyboard.press("Enter")
    page.wait_for_url("**#events")
    assert page.get_by_role("cell", name="by hand").is_visible()
    context.close()


def test_tables_are_sorted_and_rows_have_addresses(browser, server):
    page = browser.new_page()
    page.goto(f"{server.address}/ships/{ADA}/port")
    table = page.locator("table", has_text="Tests, the newest first")
    days = table.locator("tbody th")
    head = table.locator("thead th").first
    button = head.get_by_role("button")
    first = [text[:10] for text in days.all_inner_texts()]
    assert first == ["2026-03-01", "2025-03-01", "2024-03-01"]
    button.focus()
    page.keyboard.press("Enter")
    assert [text[:10] for text in days.all_inner_texts()] == sorted(first)
    assert head.get_attribute("aria-sort") == "ascending"
    button.click()
    assert [text[:10] for text in days.all_inner_texts()] == first
    link = table.get_by_role("link", name="Link to the row of 2025-03-01")
    link.focus()
    page.keyboard.press("Enter")
    page.wait_for_url("**#row-2025-03-01")
    page.reload()
    assert table.locator("tr.asked th").inner_text().startswith("2025-03-01")
    page.close()


def by_mouse(page, handle, seconds):
    """Drag a handle by so many seconds of a recording of 100 s."""
    box, wide = page.locator(handle).bounding_box(), page.locator(".course").bounding_box()["width"]
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 5.0, y)
    page.mouse.move(x + seconds / 100.0 * wide, y)
    page.mouse.up()


def file_of(page):
    """Return the campaign file that the page shows, once the server has told it."""
    page.locator(".course[data-state=shown]").wait_for()
    return page.locator("#text").inner_text()


def test_printed_tables_have_their_head_and_whole_dates(browser, server):
    page = browser.new_page(viewport={"width": 688, "height": 900})
    page.goto(f"{server.address}/")
    page.emulate_media(media="print")
    heads = page.locator("thead th")
    assert "newest test" in heads.all_inner_texts()
    assert all(box["height"] > 0.0 and box["width"] > 0.0 for box in (one.bounding_box() for one in heads.all()))
    seen = page.eval_on_selector_all("thead th *", "all => all.map(one => getComputedStyle(one).display)")
    assert "none" not in seen
    style = "document.querySelector('thead').computedStyleMap().get('display').toString()"
    assert page.evaluate(style) == "table-header-group"
    lines = page.eval_on_selector_all(
        "tbody time",
        "all => all.map(one => { one.closest('td').style.maxWidth = '1px'; return one.getClientRects().length; })",
    )
    assert lines
    assert set(lines) == {1}
    page.close()


def test_windows_moved_by_mouse_and_by_keys_give_the_same_campaign(browser, windows):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    texts = []
    page.goto(windows)
    as_it_was = file_of(page)
    assert "settled_s = 24.0" in as_it_was
    # the whole first test 1.2 s later, its window to end 3 s earlier; the second left out
    by_mouse(page, '[data-test="0"] [data-part="later"]', 1.2)
    by_mouse(page, '.lane [data-test="0"] [data-part="to"]', -3.0)
    page.get_by_label("use S2").click()
    texts.append(file_of(page))
    page.goto(windows)
    file_of(page)
    page.locator('.lane [data-test="0"] [data-part="later"]').focus()
    for key in ("Shift+ArrowRight", "ArrowRight", "ArrowRight"):
        page.keyboard.press(key)
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    for _ in range(3):
        page.keyboard.press("Shift+ArrowLeft")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Space")
    texts.append(file_of(page))
    assert texts[0] == texts[1]
    assert tuple(
        line for line in texts[0].splitlines() if line.partition(" ")[0] in ("start_s", "settled_s", "stop_s")
    ) == ("start_s = 21.2", "settled_s = 25.2", "stop_s = 38.2")
    assert "S2" not in texts[0]
    # what cannot be is not written: a window of less than a period, before its test, before the recording
    page.keyboard.press("Space")
    page.keyboard.press("ArrowUp")
    for key in ("PageDown", "PageDown"):
        page.keyboard.press(key)
    assert page.locator('[data-row="0"] [data-shown]').inner_text() == "25.2 to 28.2"
    # taken back and taken in again, it is the campaign that it was
    page.keyboard.press("Home")
    page.locator('.lane [data-test="0"] [data-part="later"]').focus()
    page.keyboard.press("Home")
    page.wait_for_function("(text) => document.getElementById('text').innerText === text", arg=as_it_was)
    page.get_by_role("button", name="Keep it for this line").click()
    page.wait_for_url("**#identify")
    assert (
        page.locator("form[action='/jobs'] select[name=campaign] option:checked").inner_text().startswith("log-by-eye")
    )
    page.close()


def test_an_open_page_shows_a_job_that_goes_on_after_the_server_was_killed(browser, server, store):
    page = browser.new_page()
    page.goto(f"{server.address}/jobs/1")
    page.get_by_text("Job 1 waits").wait_for()
    with open_store(str(store / "fleet.db")) as opened:
        job = claim(opened, owner="w", version=__version__)
        renew(opened, job, progress="Measuring the test lines")
        page.get_by_text("Measuring the test lines").wait_for()
        server.kill()
        page.get_by_text("The server does not answer").wait_for()
        renew(opened, job, progress="Fitting")
        server.begin()
        page.get_by_text("Fitting").wait_for()
        refuse(opened, job, "log.nc: expected a channel of torque, found none.")
    page.get_by_role("heading", name="Job 1 refused").wait_for()
    assert page.get_by_text("expected a channel of torque, found none").is_visible()
    # a second look needs no event
    time.sleep(0.1)
    page.close()
