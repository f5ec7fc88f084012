from shaftprint.markup._html import sentence_html
from shaftprint.markup._symbols import mathtext


def test_names_become_symbols():
    assert mathtext("tau_dn") == r"$\tau_{\mathrm{dn}}$"
    assert mathtext("v K_i / (k_q - g)") == r"$v$ $K_{\mathrm{i}}$ / ($k_{\mathrm{q}}$ - $g$)"
    assert mathtext("gain margin") == "gain margin"
    assert mathtext("zeta") == r"$\zeta$"


def test_what_is_typed_is_set_as_such_and_stays_hostile_nowhere():
    assert sentence_html("Say `plan --within 160s`.") == (
        "Say <code><span>plan</span> <span>--within</span> <span>160s</span></code>."
    )
    assert sentence_html("Add --after.") == "Add <code><span>--after</span></code>."
    assert sentence_html("`K_p +/- <b>`") == ("<code><span>K_p</span> <span>+/-</span> <span>&lt;b&gt;</span></code>")
    # one backtick, a dash between words, a minus and a symbol are none of it
    assert sentence_html("a ` b -- c re-check -3 K_p") == "a ` b -- c re-check -3 <i>K</i><sub>p</sub>"
