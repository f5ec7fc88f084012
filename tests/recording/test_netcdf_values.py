"""NetCDF's own words for what is no value and for counts without a sign, as its Users Guide defines them."""

import h5py
import numpy as np
import pytest
import scipy

from shaftprint.recording import read_recording

TIME_S = np.arange(6) * 0.1
NEVER_WRITTEN = 9.969209968386869e36


def written(path, counts, attributes, fill=None):
    """Write one variable beside its times, in the classic format or in HDF5 by the ending."""
    if path.suffix == ".nc":
        with scipy.io.netcdf_file(path, "w") as file:
            file.createDimension("time", counts.size)
            for name, values in (("time", TIME_S), ("n", counts)):
                file.createVariable(name, values.dtype, ("time",))[:] = values
            file.variables["time"].units = "s"
            for key, value in attributes.items():
                setattr(file.variables["n"], key, value)
    else:
        with h5py.File(path, "w") as file:
            file["time"] = TIME_S
            file["time"].attrs["units"] = "s"
            file.create_dataset("n", data=counts, fillvalue=fill)
            file["n"].attrs.update(attributes)
    with read_recording(path) as recording:
        return recording.channel("n").values(0, counts.size)


@pytest.mark.parametrize("ending", [".nc", ".h5"])
@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ({"scale_factor": 0.5, "valid_range": np.array([0, 3000], "i2")}, [np.nan, 0.0, 1.0, 1500.0, np.nan, 1.5]),
        # of the type of the unpacked values: meant in the unit
        ({"scale_factor": 0.5, "valid_range": np.array([0.0, 1500.0])}, [np.nan, 0.0, 1.0, 1500.0, np.nan, 1.5]),
        ({"scale_factor": -0.5, "valid_min": -1500.0}, [0.5, 0.0, -1.0, -1500.0, np.nan, -1.5]),
        ({"valid_max": np.int16(3000)}, [-1.0, 0.0, 2.0, 3000.0, np.nan, 3.0]),
        ({"missing_value": np.array([-1, 2], "i2")}, [np.nan, 0.0, np.nan, 3000.0, 32000.0, 3.0]),
        ({"_Unsigned": "true"}, [65535.0, 0.0, 2.0, 3000.0, 32000.0, 3.0]),
        ({"_Unsigned": "true", "_FillValue": np.int16(-1)}, [np.nan, 0.0, 2.0, 3000.0, 32000.0, 3.0]),
    ],
)
def test_counts_that_are_no_values_are_none(tmp_path, ending, attributes, expected):
    counts = np.array([-1, 0, 2, 3000, 32000, 3], "i2")
    np.testing.assert_array_equal(written(tmp_path / f"log{ending}", counts, attributes), expected)


@pytest.mark.parametrize(("ending", "kind"), [(".nc", "f4"), (".nc", "f8"), (".h5", "f4"), (".h5", "f8")])
def test_what_was_never_written_is_no_value(tmp_path, ending, kind):
    values = np.array([1.0, 2.0, NEVER_WRITTEN, 4.0, 5.0, 6.0], kind)
    read = written(tmp_path / f"log{ending}", values, {}, fill=NEVER_WRITTEN)
    np.testing.assert_array_equal(read, [1.0, 2.0, np.nan, 4.0, 5.0, 6.0])


def test_a_data_set_that_names_no_such_value_keeps_it(tmp_path):
    counts = np.array([-32767, 0, 2, 3, 4, 5], "i2")
    np.testing.assert_array_equal(written(tmp_path / "log.h5", counts, {}), counts)
