from ._drive import Drive, load_drive

__all__ = [
    "Drive",
    "load_drive",
]
