"""Names of what is played once more."""

from shaftprint.campaign._leg import first_name, name_again


def test_names_of_what_is_played_again():
    assert [first_name(one) for one in ("M1", "M1-2", "M1-12", "low-1", "low-speed")] == (
        ["M1", "M1", "M1", "low-1", "low-speed"]
    )
    assert name_again("M1", {"M1", "M2"}) == "M1-2"
    assert name_again("M1-2", {"M1", "M1-2"}) == "M1-3"
