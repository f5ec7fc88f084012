"""A real browser for the report: Debian's chromium, driven by Playwright, with no way out to a network."""

import contextlib
import re
from dataclasses import dataclass, field
from typing import Any

import pytest

WAIT_MS, LOOK_MS = 60_000, 10


@dataclass
class Visit:
    """An opened page with what it said and asked for."""

    page: Any
    messages: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def wait_for(self, expression):
        """Wait until an expression is true; ``wait_for_function`` would need a policy that allows ``eval``."""
        for _ in range(WAIT_MS // LOOK_MS):
            if self.page.evaluate(expression):
                return
            self.page.wait_for_timeout(LOOK_MS)
        raise AssertionError(f"never true: {expression}; messages: {self.messages}")

    def show(self, name):
        """Scroll to a plot, unfold what it is in, and wait until it is drawn; return a handle of it."""
        place = self.page.locator(f"#plot-{name}")
        # Playwright's own way waits until nothing moves, which a busy machine may never see.
        place.evaluate(
            "element => { const part = element.closest('details'); if (part) part.open = true;"
            " element.scrollIntoView({block: 'center'}); }"
        )
        self.wait_for(f"document.getElementById('plot-{name}').dataset.state === 'drawn'")
        return place

    def sheets(self):
        """Return how many sheets of A4 it takes on paper."""
        return len(re.findall(rb"/Type\s*/Page\b", self.page.pdf(format="A4", prefer_css_page_size=True)))

    def axis(self, name, axis="xaxis"):
        """Return the ends of an axis as they are shown."""
        return self.page.evaluate(f"document.getElementById('plot-{name}')._fullLayout.{axis}.range.map(Number)")


@pytest.fixture(scope="module")
def visit(browser):
    """Give what opens a page of the disk in a fresh context."""
    return lambda path, **context: _visit(browser, path, **context)


@contextlib.contextmanager
def _visit(browser, path, **context):
    opened = browser.new_context(**({"viewport": {"width": 1280, "height": 900}} | context))
    try:
        found = Visit(page=opened.new_page())
        opened.on("request", lambda request: found.requests.append(request.url))
        found.page.on("console", lambda message: found.messages.append(f"{message.type}: {message.text}"))
        found.page.on("pageerror", lambda error: found.messages.append(f"error: {error}"))
        found.page.goto(path.as_uri())
        yield found
    finally:
        opened.close()
