"""Text out of files that may be damaged, fit for one line on a screen."""


def printable(text: str) -> str:
    """Return text with a question mark for every character that ends lines, moves the cursor or is not to be seen."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)
