"""The logo of a report: a small picture drawn anew from the file of a user, or why there is none."""

import io
from pathlib import Path

from shaftprint.files import reason
from shaftprint.late import late

with late():
    # comes with matplotlib; few reports have a logo
    from PIL import Image

_MOST_BYTES, _MOST_PIXELS = 2**20, 16_000_000
_SIZE_PX = (600, 200)


def drawn_logo(path: Path) -> tuple[bytes | None, str]:
    """Return a logo as PNG of at most 600 by 200 pixels, or None with why it is left out.

    It is drawn anew, so that nothing of the file but its pixels comes into a report.

    ``path``: PNG or JPEG.
    """
    try:
        if path.is_symlink() or not path.is_file():
            return None, f"expected {path.name} beside the vessel file, found none there"
        with path.open("rb") as file:
            content = file.read(_MOST_BYTES + 1)
        if len(content) > _MOST_BYTES:
            return None, f"expected {path.name} of at most 1 MB, found more"
        with Image.open(io.BytesIO(content), formats=("PNG", "JPEG")) as picture:
            if picture.width * picture.height > _MOST_PIXELS:
                return None, f"expected {path.name} of at most 16 million pixels, found more"
            picture.thumbnail(_SIZE_PX)
            # a grey of 16 bits would be cut off at the white of 8
            grey = picture.point(lambda level: level / 256.0).convert("L") if picture.mode.startswith("I") else picture
            small = grey.convert("RGBA")
    except OSError as error:
        return None, f"expected {path.name} as PNG or JPEG: {reason(error) if error.errno else 'it is neither'}"
    except (ValueError, SyntaxError, Image.DecompressionBombError):
        return None, f"expected {path.name} as PNG or JPEG, found a damaged one"
    drawn = io.BytesIO()
    small.save(drawn, format="PNG")
    return drawn.getvalue(), ""
