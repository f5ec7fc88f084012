"""Which of several structures the data want: criteria, tests of one within another, lines left out."""
