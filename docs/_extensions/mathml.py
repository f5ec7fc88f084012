"""Formulas as MathML, made when the pages are built: browsers draw it themselves, without script, font or request."""

from html import escape
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx


def markup(latex: str, display: str) -> str:
    """Return the MathML of a formula, with its LaTeX as the text that a reader without MathML gets."""
    made: str = convert(latex, display=display)
    return made.replace("<math ", f'<math alttext="{escape(latex.strip(), quote=True)}" ', 1)


def inline(self: Any, node: nodes.math) -> None:
    """Write a formula within a sentence."""
    self.body.append(markup(node.astext(), "inline"))
    raise nodes.SkipNode


def block(self: Any, node: nodes.math_block) -> None:
    """Write a formula on a line of its own, with its number where it has a label."""
    anchor = f' id="{node["ids"][0]}"' if node["ids"] else ""
    number = f'<span class="formula-number">({node["number"]})</span>' if node.get("number") else ""
    self.body.append(f'<div class="formula"{anchor}>{markup(node.astext(), "block")}{number}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the renderer ``mathml``."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
