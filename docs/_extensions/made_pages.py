"""What is made from the code and kept in files of the repository, so that it is read there too.

Run ``python docs/_extensions/made_pages.py`` after a change of rooms, imports, roles, kinds of channels or heads of
decisions. It writes what stands between ``<!-- made -->`` and ``<!-- end -->`` of the pages, and the package's stub.
"""

import re

from decision_index import index
from feature_map import feature_map
from room_diagram import ROOT, SOURCE, rooms_page, stub
from wings import wing_table

MADE = re.compile(r"(?<=<!-- made -->\n\n).*?(?=\n\n<!-- end -->)", flags=re.DOTALL)


def house() -> str:
    """Return where features live, and the wings."""
    return f"{feature_map()}\n\n{wing_table()}"


PAGES = {
    ROOT / "docs" / "rooms.md": rooms_page,
    ROOT / "docs" / "decisions.md": index,
    ROOT / "docs" / "house.md": house,
}
"""Pages with a made part, and what makes it."""
STUB = SOURCE / "__init__.pyi"


def write() -> None:
    """Write all of it."""
    for page, make in PAGES.items():
        text = page.read_text(encoding="utf-8")
        page.write_text(MADE.sub(lambda _, make=make: make(), text), encoding="utf-8")
    STUB.write_text(stub(), encoding="utf-8")


if __name__ == "__main__":
    write()
