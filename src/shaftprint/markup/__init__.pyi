from ._html import cell_html

__all__ = [
    "cell_html",
]
