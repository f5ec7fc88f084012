"""Files of the server's own look: style sheets, the script of progress, a picture for the tab."""

from starlette.responses import Response

from shaftprint.markup._environment import style_sheet, template_text
from shaftprint.web._asked import Asked, NotThere

_KINDS = {
    "page.css": "text/css",
    "web.css": "text/css",
    "web.js": "text/javascript",
    "tables.js": "text/javascript",
    "windows.js": "text/javascript",
    "icon.svg": "image/svg+xml",
}
_ROOM = "shaftprint.web"


async def static(asked: Asked) -> Response:
    """Return a file of the server's own look."""
    name = asked.named("name")
    if name not in _KINDS:
        raise NotThere
    text = style_sheet() if name == "page.css" else template_text(_ROOM, name)
    # the same for everybody, and another one only with another version of the program
    return Response(text, media_type=_KINDS[name], headers={"cache-control": "private, max-age=3600"})
