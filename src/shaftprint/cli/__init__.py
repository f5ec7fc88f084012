"""The command line: each command opens files, calls the verbs of the library, prints, and says how it ended.

========= ==========================================================================================
exit code meaning
========= ==========================================================================================
0         done
1         an input or a file that the user can mend, said in one sentence on the error output
2         an option or a command that does not exist
3         done, with all that is found written, and the answer is no: the docs' page on output has the list
130       interrupted with Ctrl-C; nothing is left half-written
========= ==========================================================================================

Tables go to the output, progress bars and errors to the error output. A command's file is imported when
the command is called, not before: ``shaftprint --help`` loads neither NumPy nor anything heavier.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
