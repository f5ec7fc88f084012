"""The command line as ``python -m shaftprint``."""

from shaftprint.cli import main

if __name__ == "__main__":
    main()
