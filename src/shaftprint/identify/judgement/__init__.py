"""May the numbers of a fit be used, which of them, and why not: the verdict and the sentences that give its reasons."""
