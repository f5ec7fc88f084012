"""Text files: columns of numbers with titles, in the layouts that loggers and spreadsheets write."""
