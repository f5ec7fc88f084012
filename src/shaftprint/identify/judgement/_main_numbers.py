"""Which of the numbers that a ship is tested for can be used, in plain words, where some of them cannot."""

from collections.abc import Collection, Mapping

from shaftprint.catalogue._gauge import GAUGE_K_I, GAUGE_K_P
from shaftprint.identify.judgement._number_precision import share_of
from shaftprint.spelling import listed

# By what an owner asks for: names of the numbers, each with its own words where others of the group can be used.
_ASKED: Mapping[str, Mapping[str, str]] = {
    "inertia": {"I_dn": "inertia"},
    "propeller": {"K_Q": "propeller"},
    "total delay": {"t_d + t_sp": "total delay"},
    "governor gains": {GAUGE_K_P.name: "proportional gain", GAUGE_K_I.name: "integral gain"},
    "margins": {"gain margin": "gain margin", "phase margin": "phase margin", "delay margin": "delay margin"},
}


def main_numbers(trusted: Collection[str], not_trusted: Mapping[str, str]) -> tuple[list[str], dict[str, list[str]]]:
    """Return what can be used of the numbers that matter, and what cannot, in words, with the shares it is known to.

    Nothing where they are of one kind alone, as in a drive.
    """
    usable: list[str] = []
    doubted: dict[str, list[str]] = {}
    asked = {
        group: [name for name in names if name in trusted or name in not_trusted] for group, names in _ASKED.items()
    }
    if sum(map(bool, asked.values())) < 2:
        return [], {}
    for group, names in asked.items():
        good = [name for name in names if name in trusted]
        bad = [name for name in names if name in not_trusted]
        words = _ASKED[group]
        usable += [group] if good and not bad else [words[name] for name in good]
        if bad and not good:
            doubted[group] = [share_of(not_trusted[name]) for name in bad]
        else:
            doubted |= {words[name]: [share_of(not_trusted[name])] for name in bad}
    return usable, doubted


def main_in_words(trusted: Collection[str], not_trusted: Mapping[str, str]) -> str:
    """Return what can be used and what cannot in one sentence; nothing where all that matters can."""
    usable, doubted = main_numbers(trusted, not_trusted)
    if not doubted:
        return ""
    cannot = listed([f"{name}{_known_to(shares)}" for name, shares in doubted.items()])
    sentence = f"{listed(usable)} can be used; {cannot} cannot." if usable else f"{cannot} cannot be used."
    return sentence[:1].upper() + sentence[1:]


def groups_lost(trusted: Collection[str], not_trusted: Mapping[str, str]) -> list[str]:
    """Return what a ship is tested for of which no number can be used."""
    return [group for group in main_numbers(trusted, not_trusted)[1] if group in _ASKED]


def _known_to(shares: list[str]) -> str:
    told = [share.removesuffix(" %") for share in dict.fromkeys(shares) if share]
    return f" (known to {listed(told)} %)" if told else ""
