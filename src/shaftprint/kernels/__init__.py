"""Functions that numba compiles, and the folder in which the compiled code is kept between two runs.

What is kept is unpickled and run, so it is kept only where nobody but the user can have put it; elsewhere functions are
compiled anew in every run. All compiled functions of the package are made here, so that one rule holds for all.
"""
