"""Bytes that are changed in a few places, as damage and attacks change them."""

import random

WORDS = (
    b"\0", b"%00", b"../", b"%2e%2e%2f", b"\r\n", b"'\"<>", b"\xff\xfe", b"A" * 3000, b"-1", b"9" * 40, b"{", b"%",
    b"\xe2\x80\xae", b"--frontier", b"filename=", b"Transfer-Encoding: chunked\r\n", b"Host: evil\r\n", b"//",
    b"T25:61", b'name="token"', b"id-", b"\xd8\x00", b"NaN",
)  # fmt: skip
"""What attacks are made of."""


def mutated(raw: bytes, rng: random.Random) -> bytes:
    """Return bytes with a few changes: letters, parts left out, doubled, moved, cut off, or dangerous words put in."""
    content = bytearray(raw)
    for _ in range(rng.choice((1, 1, 2, 3, 8))):
        at = rng.randrange(len(content) + 1)
        end = min(len(content), at + rng.choice((1, 4, 30)))
        match rng.randrange(6):
            case 0 if at < len(content):
                content[at] = rng.randrange(256)
            case 1:
                del content[at:end]
            case 2:
                content[at:at] = content[at:end]
            case 3:
                content[at:at] = rng.choice(WORDS)
            case 4:
                content[at:end] = rng.randbytes(end - at)
            case _ if rng.random() < 0.2:
                del content[at:]
        if not content:
            break
    return bytes(content)
