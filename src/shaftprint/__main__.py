"""The command line as ``python -m shaftprint``."""

from shaftprint.cli._main import main

if __name__ == "__main__":
    main()
