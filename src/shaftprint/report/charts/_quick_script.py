"""plotly's script made to start in half the time: without the kinds of traces that no report draws.

plotly's package has one script with all of its 47 kinds, maps and surfaces among them. Most of the time that a
browser needs to start it goes into kinds that a report never draws: each is a function that runs when a list of kinds
asks for it. Taken out of that list it lies idle. What is not recognised stays as it is, and only starts slower.
"""

import re

from shaftprint.report.charts._plotly import TRACE_TYPES

_NAME = r"[\w$]+"
# Functions that wait until somebody asks for what they export.
_MODULE = re.compile(rf"var ({_NAME})={_NAME}\((?:\({_NAME},{_NAME}\)|{_NAME})=>{{")
_LIST = re.compile(rf"(?<=\.register\(\[)(?:{_NAME}\(\),)+{_NAME}\(\)(?=\]\))")
_TYPE = re.compile(r'moduleType:"trace",name:"(\w+)"')
_HANDED_ON = re.compile(rf"\.exports=({_NAME})(\(\))?\}}")
# A kind of trace is exported by one module, and handed on by one or two.
_STEPS = 4
_WRAPPER = 'self : this, () => {\n"use strict";'
_END = "}));"


def quick_script(script: bytes) -> bytes:
    """Return plotly's script with the kinds of traces of reports alone, and with its one function in parentheses.

    A browser reads a function in parentheses once, while the script is loading; another one a second time when it is
    called.
    """
    # a character a byte: what is looked for is ASCII, and a copy takes half of the memory
    text = script.decode("latin-1")
    return _in_parentheses(_with_few_kinds(text)).encode("latin-1")


def _with_few_kinds(text: str) -> str:
    if not _LIST.search(text):
        return text
    modules = _modules(text)

    def shorter(match: re.Match[str]) -> str:
        calls = match.group().split(",")
        kept = [call for call in calls if _trace_type(call[:-2], modules) in {None, *TRACE_TYPES}]
        return ",".join(kept) if kept else match.group()

    return _LIST.sub(shorter, text)


def _modules(text: str) -> dict[str, str]:
    """Return the text of each module by its name; none of a name that is given twice."""
    matches = list(_MODULE.finditer(text))
    ends = [after.start() for after in matches[1:]] + [len(text)]
    modules: dict[str, str] = {}
    for start, end in zip(matches, ends, strict=True):
        modules[start.group(1)] = "" if start.group(1) in modules else text[start.end() : end]
    return modules


def _trace_type(name: str, modules: dict[str, str]) -> str | None:
    """Return the kind of trace that a module exports or hands on; None where that cannot be told."""
    for _ in range(_STEPS):
        content = modules.get(name, "")
        types = _TYPE.findall(content)
        if types:
            return str(types[0]) if len(types) == 1 else None
        handed_on = _HANDED_ON.search(content)
        if not handed_on:
            return None
        name, called = handed_on.groups()
        if not called:
            sources = re.findall(rf"(?<![\w$.]){re.escape(name)}=({_NAME})\(\)", content)
            if len(sources) != 1:
                return None
            (name,) = sources
    return None


def _in_parentheses(text: str) -> str:
    stripped = text.rstrip(" \r\n")
    if text.count(_WRAPPER) != 1 or not stripped.endswith(_END):
        return text
    opened = stripped.replace(_WRAPPER, _WRAPPER.replace("() =>", "(() =>"))
    return f"{opened.removesuffix(_END)}}}){_END[1:]}{text[len(stripped) :]}"
