"""Files of imc's format 2, block for block, as its maker describes them (Manual for imc Shared Components)."""

HEAD = "|CF,2,1,1;|CK,1,3,1,1;\r\n"


def block(key, *parameters, version=1):
    """Return a block with its length; of a tuple the length stands before the text."""
    parts = [f"{len(one[0])},{one[0]}" if isinstance(one, tuple) else str(one) for one in parameters]
    content = ",".join(parts)
    return f"|{key},{version},{len(content)},{content};\r\n"


def field(step=0.005, unit="s", *, kind=1, count=1, reduction=0, has_events=0, date=(5, 3, 2026, 9, 0, 12.25)):
    """Return the head of a field: its axis and the date of its trigger."""
    axis = block("CD", step, 1, (unit,), reduction, has_events, 0)
    return block("CG", count, kind, 1 if kind == 1 else 2) + axis + block("NT", *date)


def component(number, kind, size, place, length, **more):
    """Return a component whose samples lie at a place of block 1; ``more``: what is otherwise than usual."""
    said = {
        "index": 1, "digital": 1, "mask": 0, "first": 0, "offset": 0, "together": 1, "apart": 0, "start": 0, "later": 0,
        "filled": length, "scale": (0, 1, 0), "unit": "N m", "names": [(0, "M_s", "")],
    } | more  # fmt: skip
    packing = (number, size, kind, 8 * size, said["mask"], said["offset"], said["together"], said["apart"])
    buffer = (number, 1, place, length, said["first"], said["filled"], 1, said["start"], said["later"], "")
    names = [block("CN", 0, 0, bit, (name,), (comment,)) for bit, name, comment in said["names"]]
    scale = block("CR", *said["scale"], 1, (said["unit"],))
    return (
        block("CC", said["index"], said["digital"])
        + block("CP", *packing)
        + block("Cb", 1, 0, *buffer)
        + scale
        + "".join(names)
    )


def write_imc(path, *blocks, samples, head=HEAD, encoding="cp1252"):
    """Write blocks and, behind them, the block of samples."""
    content = "".join([head, *blocks]).encode(encoding)
    path.write_bytes(content + f"|CS,1,{len(samples) + 2},1,".encode() + samples + b";")
    return path
