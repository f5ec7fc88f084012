"""Tables on a terminal and in a file."""

from shaftprint.cli._tables import print_table


def test_table_in_a_file_is_not_folded(capsys):
    long = "a meaning of many words " * 5
    print_table("Title [s]", ("name", "value [rad/s]"), [(long, "1.5"), ("b [x]", "20")], numbers=(1,))
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == "Title [s]"
    assert any(line.strip().startswith(long.strip()) and line.endswith("1.5") for line in lines)
    # markup in a cell is text, and numbers stand to the right
    place = next(line for line in lines if "b [x]" in line)
    assert place.endswith(" 20")
