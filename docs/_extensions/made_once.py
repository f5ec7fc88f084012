"""What Sphinx and its extensions make anew for each page or name, made once; on the pages nothing changes."""

import functools
import gc
from typing import Any

from numpydoc import docscrape_sphinx
from pydata_sphinx_theme import toctree
from sphinx.application import Sphinx
from sphinx.search.en import SearchEnglish


class Stems(SearchEnglish):
    """English whose words are brought to their stems once for all pages, not once for each of them."""

    def __init__(self, options: dict[str, str]) -> None:
        super().__init__(options)
        self.stem = functools.cache(super().stem)  # type: ignore[method-assign]


def keep_templates(app: Sphinx) -> None:
    """Take templates as they were when they were first loaded, and that of docstrings once for all names."""
    app.builder.templates.environment.auto_reload = False  # type: ignore[attr-defined]
    made, kept = docscrape_sphinx.SandboxedEnvironment, {}

    def environment(loader: Any) -> Any:
        return kept.setdefault(type(loader), made(loader=loader, auto_reload=False))

    docscrape_sphinx.SandboxedEnvironment = environment


def share_contents(app: Sphinx) -> None:
    """Let pages that stand side by side in a folder share the contents beside them.

    The theme does so where everything is unfolded. Here only the way to a page is, which is the same for all pages of
    the folder of a room or of the decisions: none of them has pages below it.
    """
    plain = toctree._sidebar_cache_key

    def key(
        kind: str, depth: int, ancestor: str | None, address: str, level: int, more: dict[str, Any]
    ) -> tuple[Any, ...] | None:
        folder, _, _ = address.rpartition("/")
        is_leaf = folder == "decisions" or folder.startswith("reference/generated/")
        return plain(kind, depth, ancestor, address, level, more | {"collapse": False} if is_leaf else more)

    toctree._sidebar_cache_key = key


def setup(app: Sphinx) -> dict[str, bool]:
    """Put these in the place of what makes all anew, and search for garbage as seldom as the program does."""
    gc.set_threshold(100_000)
    share_contents(app)
    app.add_search_language(Stems)
    app.connect("builder-inited", keep_templates)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
