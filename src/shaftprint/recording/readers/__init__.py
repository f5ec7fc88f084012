"""One file or folder a logger format; ``_all`` lists them."""
