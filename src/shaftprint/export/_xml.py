"""XML as bytes: the one place where a tree of elements becomes text."""

from xml.etree.ElementTree import Element, indent, tostring

from shaftprint.escape import xml_text


def xml_document(root: Element) -> bytes:
    """Return a tree as a document in UTF-8 that every parser of XML 1.0 reads, whatever its texts hold.

    ``root``: the tree; characters in it that XML has no room for are replaced.
    """
    for element in root.iter():
        for name, value in element.items():
            element.set(name, xml_text(value))
        if element.text is not None:
            element.text = xml_text(element.text)
    indent(root)
    content: bytes = tostring(root, encoding="utf-8")
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + content + b"\n"
