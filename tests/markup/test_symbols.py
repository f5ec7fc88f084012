from shaftprint.markup._html import sentence_html, symbol_html
from shaftprint.markup._symbols import mathtext


def test_names_become_symbols():
    assert mathtext("tau_dn") == r"$\tau_{\mathrm{dn}}$"
    assert mathtext("v K_i / (k_q - g)") == r"$v$ $K_{\mathrm{i}}$ / ($k_{\mathrm{q}}$ - $g$)"
    assert mathtext("gain margin") == "gain margin"
    assert mathtext("zeta") == r"$\zeta$"
    assert mathtext("J R / K_m^2") == r"$J$ $R$ / $K_{\mathrm{m}}$$^{2}$"


def test_powers_are_raised_in_names_and_in_sentences():
    raised = "<i>K</i><sub>m</sub><sup>2</sup>"
    assert symbol_html("J R / K_m^2") == f"<i>J</i> <i>R</i> / {raised}"
    assert sentence_html("Trusted: R and J R / K_m^2.") == f"Trusted: R and J R / {raised}."


def test_what_is_typed_is_set_as_such_and_stays_hostile_nowhere():
    assert sentence_html("Say `plan --within 160s`.") == (
        "Say <code><span>plan</span> <span>--within</span> <span>160s</span></code>."
    )
    assert sentence_html("Add --after.") == "Add <code><span>--after</span></code>."
    assert sentence_html("`K_p +/- <b>`") == ("<code><span>K_p</span> <span>+/-</span> <span>&lt;b&gt;</span></code>")
    # one backtick, a dash between words, a minus and a symbol are none of it
    assert sentence_html("a ` b -- c re-check -3 K_p") == "a ` b -- c re-check -3 <i>K</i><sub>p</sub>"
