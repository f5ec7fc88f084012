from ._arguments import JobArguments
from ._dask import work_on_dask
from ._lists import COLUMNS, recordings_in, recordings_of_list
from ._submit import submit
from ._work import Worked, work

__all__ = [
    "COLUMNS",
    "JobArguments",
    "Worked",
    "recordings_in",
    "recordings_of_list",
    "submit",
    "work",
    "work_on_dask",
]
