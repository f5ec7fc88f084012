from shaftprint.markup._symbols import mathtext


def test_names_become_symbols():
    assert mathtext("tau_dn") == r"$\tau_{\mathrm{dn}}$"
    assert mathtext("v K_i / (k_q - g)") == r"$v$ $K_{\mathrm{i}}$ / ($k_{\mathrm{q}}$ - $g$)"
    assert mathtext("gain margin") == "gain margin"
    assert mathtext("zeta") == r"$\zeta$"
