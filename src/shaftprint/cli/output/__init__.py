"""Where a command writes: tables and bars on the terminal, files, and folders that appear as a whole."""
