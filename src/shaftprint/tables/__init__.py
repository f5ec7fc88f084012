"""Tables: made once, printed on the terminal by the commands and on a page by the report.

================== ========= ==================================================================================
quantity           unit      how it is written
================== ========= ==================================================================================
value ± std        -         both rounded to the second digit of the standard deviation
interval           -         95 %; an end that a bound of the search sets is marked with an asterisk
speed              rpm       of the engine
share              %         of a variance, of the motion, of the truth
difference         %         from the value of the vessel file, relative to it
================== ========= ==================================================================================

Every ``*_table`` function returns a ``Table`` of plain text. Who prints it escapes what is foreign in it, and turns
its letters (±, a true minus sign, a narrow space between thousands) into those that the place has.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
