"""Keys while a live test is played."""

import os
from types import SimpleNamespace

from shaftprint.cli._live_options import take_keys


def test_keys_ask_and_others_are_named(capsys):
    ends, begins = os.pipe()
    os.write(begins, b"h\ng\nx s r\n")
    os.close(begins)
    operator = SimpleNamespace(asks=[])
    take_keys(ends, operator)
    os.close(ends)
    assert [str(ask) for ask in operator.asks] == ["hold", "go on", "skip", "repeat"]
    assert "x: expected one of h, g, s, r" in capsys.readouterr().err
