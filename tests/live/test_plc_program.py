"""The program for a controller: a checker reads it, and read as Python it goes back to the lever by itself."""

import ast
import math
import re
from itertools import pairwise
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parents[2] / "examples" / "plc" / "shaftprint_test.st"
CYCLE_S = 0.02
LEVER_V = 5.0


@pytest.mark.slow
def test_a_checker_reads_the_program():
    """Blark is a parser of IEC 61131-3; a program with a mistake is none to it."""
    parse = pytest.importorskip("blark.parse", reason="blark reads structured text").parse_source_code
    text = PROGRAM.read_text(encoding="utf-8")
    assert parse(text).exception is None
    assert parse(text.replace("END_IF", "END_IFS", 1)).exception is not None


# ---- the same text, word for word, as Python ----

_WORDS = (
    (r"\(\*.*?\*\)", ""),
    (r"T#(\d+)MS", lambda m: f"{int(m[1]) / 1000}"),
    (r"T#(\d+)S", r"\1.0"),
    (r"<>", "!="),
    (r"(?<![:<>!=])=(?!=)", "=="),
    (r":=", "="),
    (r"\b(TRUE|FALSE)\b", lambda m: m[1].title()),
    (r"\bMOD\b", "%"),
    (r"\b(AND|OR|NOT)\b", lambda m: m[1].lower()),
    (r"\bTest(Mode|Reason)\.(\w+)", r'"\2"'),
    (r"\b(INT_TO_DINT|DINT_TO_UDINT)\b", "int"),
    (r"\b(INT_TO_REAL|TIME_TO_REAL)\b", "float"),
    (r"\bABS\b", "abs"),
    (r"\bCOS\b", "math.cos"),
    (r"\bLIMIT\(", "limit("),
    (r"silent\(IN = (.*), PT = (\w+)\)", r"silent(\1, \2)"),
)


def limit(low, value, high):
    return max(low, min(value, high))


class Timer:
    """TON of IEC 61131-3, called once a cycle."""

    def __init__(self):
        self.elapsed, self.Q = 0.0, False

    def __call__(self, is_on, wanted):
        self.elapsed = self.elapsed + CYCLE_S if is_on else 0.0
        self.Q = self.elapsed >= wanted - 1e-9


def as_python(text):
    for old, new in _WORDS:
        text = re.sub(old, new, text, flags=re.DOTALL)
    lines, depth = [], 0
    for line in map(str.strip, text.splitlines()):
        if line.startswith(("END_IF", "END_FOR")):
            depth -= 1
        elif match := re.fullmatch(r"(IF|ELSIF) (.*) THEN", line):
            depth -= match[1] == "ELSIF"
            lines.append("    " * depth + f"{'if' if match[1] == 'IF' else 'elif'} {match[2]}:")
            depth += 1
        elif line == "ELSE":
            lines.append("    " * (depth - 1) + "else:")
        elif match := re.fullmatch(r"FOR (\w+) = (\w+) TO (\w+) DO", line):
            lines.append("    " * depth + f"for {match[1]} in range({match[2]}, {match[3]} + 1):")
            depth += 1
        elif line:
            lines.append("    " * depth + line.rstrip(";"))
    return "\n".join(lines)


class Controller:
    """The program in its task of 20 ms."""

    def __init__(self):
        declared, _, body = PROGRAM.read_text(encoding="utf-8").rpartition("END_VAR")
        self._code = compile(as_python(body.removesuffix("\nEND_FUNCTION_BLOCK\n")), str(PROGRAM), "exec")
        constants = re.findall(r"(\w+) : (?:TIME|U?DINT|REAL) := ([^;]+);", declared)
        self.memory = {name: ast.literal_eval(as_python(value)) for name, value in constants}
        names = re.findall(r"^\t(\w+) : (?:BOOL|U?DINT|REAL|TIME);", declared, re.MULTILINE)
        self.memory |= dict.fromkeys(names, 0) | {"mode": "Lever", "reason": "None", "silent": Timer()}
        self.memory |= dict.fromkeys(re.findall(r"(\w+) : BOOL := TRUE;", declared), True)
        self.memory |= {"limit": limit, "math": math, "key": True, "lever_v": LEVER_V, "set_point_v": LEVER_V}
        self.memory |= {"table": [0] * 30000, "buffers": {}, "lengths": [0, 0]}
        self.beats = True

    def run(self, seconds, **inputs):
        """Set inputs, go on, and return the set points that went out."""
        self.memory.update(inputs)
        out = []
        for _ in range(round(seconds / CYCLE_S)):
            if self.beats and self.memory["cycle_count"] % 25 == 24:
                self.memory["heartbeat"] += 1
            exec(self._code, self.memory)  # noqa: S102 - the program of this repository
            out.append(self.memory["set_point_v"])
        return out

    @property
    def state(self):
        return self.memory["mode"], self.memory["reason"]

    def load(self, table):
        self.memory["table"][: len(table)] = table
        total = 0
        for value in table:
            total = (total * 7 + value + 32768) % 1000003
        self.run(0.04, load=False)
        self.run(2.0, load=True, table_length=len(table), table_sum=total)

    def play(self, table):
        self.run(0.1)
        assert set(self.run(1.0, take=True)) == {LEVER_V}
        assert self.state == ("Held", "None")
        self.load(table)
        return self.run(1.0, play=True)


SINE = [round(5000 + 400 * math.sin(2 * math.pi * 0.1 * k * CYCLE_S)) for k in range(3000)]


def test_the_table_goes_out_value_by_value_and_its_last_is_held():
    controller = Controller()
    sent = controller.play(SINE) + controller.run(61.0)
    assert sent[:3000] == pytest.approx([value / 1000 for value in SINE], abs=1e-9)
    assert set(sent[3000:]) == {sent[2999]}
    assert controller.state == ("Held", "None")
    # another takes its place, at the time that it is given
    controller.run(0.1, play=False)
    controller.load([5100] * 100)
    begin = controller.memory["cycle_count"] + 26
    sent = controller.run(2.0, play=True, start_cycle=begin)
    assert set(sent[:25]) == {sent[0]}
    assert sent[-1] == pytest.approx(5.1)


def test_a_table_goes_on_until_the_next_one_begins():
    controller = Controller()
    controller.play(SINE)
    # its second of 50 cycles ends now
    first = controller.memory["cycle_count"] - 49
    controller.run(0.1, play=False)
    controller.load([5000] * 100)
    now = controller.memory["cycle_count"]
    sent = controller.run(1.6, play=True, start_cycle=now + 26)
    assert sent[:25] == pytest.approx([value / 1000 for value in SINE[now + 1 - first : now + 26 - first]], abs=1e-9)
    assert sent[-1] == 5.0


def test_a_new_test_begins_with_nothing_of_an_earlier_one():
    controller = Controller()
    controller.play(SINE)
    controller.run(3.0, play=False, release=True)
    controller.run(0.1, release=False, take=False)
    assert set(controller.run(1.0, take=True)) == {LEVER_V}
    controller.load([5100] * 100)
    start = controller.memory["cycle_count"] + 26
    assert set(controller.run(0.5, play=True, start_cycle=start)) == {LEVER_V}
    assert controller.run(1.0)[-1] == pytest.approx(5.1)


def test_a_silent_program_is_answered_with_the_lever_within_a_second():
    controller = Controller()
    controller.play([5400] * 3000)
    while controller.memory["cycle_count"] % 25:
        controller.run(CYCLE_S)
    controller.beats = False
    sent = controller.run(1.0)
    assert sent[36] == 5.4
    assert sent[-1] == LEVER_V
    assert controller.state == ("Lever", "Silent")
    # and it does not begin again when the program is back
    controller.beats = True
    assert set(controller.run(3.0)) == {LEVER_V}


@pytest.mark.parametrize(
    ("cause", "reason"),
    [
        ({"abort": True}, "Aborted"),
        ({"release": True}, "Released"),
        ({"key": False}, "KeyOff"),
        ({"lever_v": LEVER_V - 0.1}, "LeverMoved"),
    ],
)
def test_an_abort_goes_down_half_a_cosine_of_two_seconds(cause, reason):
    controller = Controller()
    assert controller.play([5400] * 2000)[-1] == 5.4
    goal = cause.get("lever_v", LEVER_V)
    sent = controller.run(2.1, **cause)
    assert controller.state == ("Lever", reason)
    # the cycle that sees it still holds; 1 s later it is half way
    assert sent[0] == 5.4
    assert sent[50] == pytest.approx(goal + (5.4 - goal) / 2, abs=1e-6)
    assert sent[25] == pytest.approx(goal + (5.4 - goal) * (0.5 + 0.5 * math.cos(math.pi / 4)), abs=1e-6)
    assert sent[100:] == [goal] * 5
    assert max(a - b for a, b in pairwise(sent)) < (5.4 - goal) * math.pi / 2 / 100 + 1e-9


def test_a_table_torn_on_its_way_is_not_played():
    controller = Controller()
    controller.run(0.1)
    controller.run(1.0, take=True)
    controller.load(SINE)
    assert controller.memory["is_loaded"]
    controller.run(0.1, load=False)
    controller.memory["table"][7] ^= 1
    controller.run(2.0, load=True)
    assert set(controller.run(3.0, play=True)) == {LEVER_V}
    assert controller.state == ("Lever", "TableInvalid")


def test_distance_and_slope_are_the_controllers():
    controller = Controller()
    sent = controller.play([9000] * 2000) + controller.run(1.0)
    assert max(sent) == pytest.approx(LEVER_V + 0.5)
    assert max(b - a for a, b in pairwise(sent)) == pytest.approx(0.01)


def test_after_a_restart_nothing_begins_that_was_asked_for_before():
    controller = Controller()
    assert set(controller.run(5.0, take=True, play=True, load=True)) == {LEVER_V}
    assert controller.state == ("Lever", "None")
