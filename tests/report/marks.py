"""What a chart holds, for tests of figures."""

from shaftprint.report.charts._text import as_plain


def legend(chart):
    return [as_plain(name) for name in chart.legend]


def names(panel):
    """Return the names of the marks of a panel, in the order of drawing; nothing for those without one."""
    return [as_plain(getattr(mark, "name", "")) for mark in panel.marks]


def marks(panel, name, kind=object):
    """Return the marks whose name begins so."""
    return [
        mark
        for mark, full in zip(panel.marks, names(panel), strict=True)
        if full.startswith(name) and isinstance(mark, kind)
    ]


def mark(panel, name, kind=object):
    (only,) = marks(panel, name, kind)
    return only
