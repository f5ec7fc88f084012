"""A program of its own that reads mutated files of one format and says of each how it ended.

``python read_mutated_files.py NAME FIRST STOP FOLDER`` reads the inputs [FIRST, STOP). An input depends on its format
and number alone. The program that calls it ends it where an input takes too long: no alarm reaches into C libraries.
"""

import gzip
import json
import resource
import struct
import sys
import time
from pathlib import Path

import asammdf
import can
import h5netcdf
import nptdms
import numpy as np
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import RecordingWriter, read_recording, write_mat_v73
from shaftprint.recording._journal import JournalWriter

MOST_ADDRESSES = 6_000_000_000
CLOCK = np.arange(400) / 100.0
COUNTS = np.arange(-200, 200, dtype=np.int16)


def _native(path):
    with RecordingWriter(path, overwrite=True) as writer:
        writer.declare("M_s", unit="N m", rate_hz=100.0, scale=0.5)
        writer.append("M_s", COUNTS)


def _mdf(path):
    with asammdf.MDF(version="4.10") as file:
        torque = asammdf.Signal(COUNTS, CLOCK, name="M_s", unit="V", conversion={"a": 0.5, "b": -3.0})
        file.append([torque, asammdf.Signal(np.sin(CLOCK), CLOCK, name="U", unit="V")])
        file.append([asammdf.Signal(CLOCK[:50], CLOCK[:50] * 7.0, name="X", invalidation_bits=CLOCK[:50] > 0.2)])
        file.save(path, overwrite=True, compression=1)


def _mdf3(path):
    with asammdf.MDF(version="3.30") as file:
        file.append([asammdf.Signal(COUNTS, CLOCK, name="M_s", unit="V", conversion={"a": 0.5, "b": -3.0})])
        file.save(path, overwrite=True)


def _tdms(path):
    said = {"wf_increment": 0.01, "wf_start_offset": 0.25, "unit_string": "V"}
    with nptdms.TdmsWriter(str(path)) as writer:
        for part in (slice(0, 150), slice(150, 400)):
            channels = [
                nptdms.ChannelObject("a", "M_s", COUNTS[part], said),
                nptdms.ChannelObject("a", "U", CLOCK[part]),
            ]
            writer.write_segment(channels)


def _mat(version):
    def write(path):
        slow = {} if version == "4" else {"slow": {"fs": 10.0, "X": CLOCK[:40]}}
        scipy.io.savemat(
            path, {"t": CLOCK, "M_s": np.sin(CLOCK), **slow}, format=version, do_compression=version == "5"
        )

    return write


def _mat73(path):
    _native(path.with_suffix(".nc"))
    with read_recording(path.with_suffix(".nc")) as recording:
        write_mat_v73(path, recording.channels.values(), overwrite=True)


def _netcdf4(path):
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {"time": 400}
        file.create_variable("time", ("time",), "f8", data=CLOCK).attrs["units"] = "seconds since 2026-03-04"
        file.create_variable("M_s", ("time",), "i2", data=COUNTS, compression="gzip").attrs["scale_factor"] = 0.5


def _netcdf3(path):
    with scipy.io.netcdf_file(path, "w") as file:
        file.createDimension("time", 400)
        file.createVariable("time", "d", ("time",))[:] = CLOCK
        file.createVariable("M_s", "h", ("time",))[:] = COUNTS


def _text(path):
    rows = (f"{4 + k // 86400:02}.03.2026 05:06:{k % 60:02},5;{k},25;-3,5e-2" for k in range(60))
    path.write_text("Logger 7\n\nDate;M_s;U\n;N m;V\n" + "\n".join(rows) + "\n")


def _plain(path):
    titles = "# made by a program\n# time [s]  M_s [N m]  U\n"
    path.write_text(titles + "".join(f"{0.1 * k:10.4f} {k:8d} {-3.5e-2 * k:12.4e}\n" for k in range(60)))


def _labview(path):
    names = ("Channels\t1", "Samples\t30", "Date\t2026/03/05", "Y_Unit_Label\tNm", "X0\t0.0", "Delta_X\t0.1")
    head = "\n".join((*names, "***End_of_Header***", "X_Value\tM_s\tComment\n"))
    rows = "".join(f"{0.1 * k:.6f}\t{k % 7}.25\n" for k in range(30))
    begin = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n\n"
    path.write_text(begin + head + rows + "\n" + head + rows)


def _universal(path):
    lines = ["    -1", f"{58:6d}", "shaft torque", "NONE", "NONE", "NONE", "NONE"]
    lines += ["    1         0    0         0       NONE         1   3       NONE         0   0"]
    lines += ["         4       400         1  0.00000e+00  1.00000e-02  0.00000e+00"]
    lines += ["        17    0    0    0 Time                 s                   "]
    lines += ["         8    0    0    0 Torque               N m                 "]
    lines += ["         0    0    0    0 NONE                 NONE                "] * 2
    lines += ["".join(f"{value:20.11e}" for value in COUNTS[k : k + 4].tolist()) for k in range(0, 400, 4)]
    path.write_text("\n".join([*lines, "    -1", ""]))


def _packed(path):
    _text(path)
    path.write_bytes(gzip.compress(path.read_bytes(), mtime=0))


def _frames(path):
    with can.Logger(path) as logger:
        for number in range(400):
            content = [0xF0, 165, 155, number % 256, 40, 0xFF, 0xFF, 0xFF]
            frame = can.Message(timestamp=1.78e9 + CLOCK[number], arbitration_id=0x0CF00400, data=content, channel=0)
            logger.on_message_received(frame)


def _journal(path):
    channel = {"name": "U", "unit": "V", "rate_hz": 100.0, "scale": 0.5, "offset": 0.0, "dtype": "int16"}
    with JournalWriter(path, {"channels": [channel]}) as journal:
        for number in range(40):
            journal.block(number, 0.1 * number, 0.1, [np.arange(10, dtype=np.int16)])


def _imc(path):
    words = (
        "CF,2 1|CK,1 1,1|CG,1 1,1,1|CD,1 1E-2,1,1,s,0,0,0|NT,1 5,3,2026,9,0,12.25|CC,1 1,1|CP,1 1,2,4,16,0,0,1,0|"
        "Cb,1 1,0,1,1,0,800,0,800,1,0,0,|CR,1 1,0.5,-3,1,2,Nm|CN,1 0,0,0,3,M_s,0,|"
        "CG,1 1,1,1|CD,1 1E-2,1,1,s,0,0,0|NT,1 5,3,2026,9,0,12.75|CC,1 1,1|CP,1 2,4,7,32,0,0,1,0|"
        "Cb,1 1,0,2,1,800,1600,0,1600,1,0,0,|CR,1 0,1,0,1,1,V|CN,1 0,0,0,1,U,0,"
    )
    blocks = (word.split(" ") for word in words.split("|"))
    head = "".join(f"|{key},{len(said)},{said};\r\n" for key, said in blocks)
    path.write_bytes(head.encode() + b"|CS,1,2402,1," + COUNTS.tobytes() + CLOCK.astype("<f4").tobytes() + b";")


def _catman(path):
    numbers = [CLOCK, COUNTS / 7.0]
    pieces = []
    for name, unit in ((b"Time  1", b"s"), (b"M_s", b"Nm")):
        texts = b"".join(struct.pack("<h", len(text)) + text for text in (name, unit, b""))
        clock = struct.pack("<di2d", 0.0, 148, 46086.375, 10.0) + bytes(132)
        pieces.append(struct.pack("<hi", 1, 400) + texts + struct.pack("<hh", 0, 8) + clock + bytes(11))
    begin = 8 + 64 + 6 + 8 + 4
    places = [begin + 2, begin + len(pieces[0]) + 2]
    head = (
        struct.pack("<hih", 5012, begin + sum(map(len, pieces)), 0)
        + bytes(64)
        + struct.pack("<hi2ii", 2, 0, *places, 0)
    )
    path.write_bytes(head + b"".join(pieces) + np.array(numbers).tobytes())


def _noise(path):
    path.write_bytes(np.random.default_rng(5).bytes(4000))


FORMATS = {
    "native.nc": _native, "log.mf4": _mdf, "log.mdf": _mdf3, "log.tdms": _tdms, "v4.mat": _mat("4"),
    "v5.mat": _mat("5"), "v73.mat": _mat73, "other.nc": _netcdf4, "classic.nc": _netcdf3, "log.csv": _text,
    "log.csv.gz": _packed, "plain.txt": _plain, "log.dxd": _noise,
    "log.blf": _frames, "log.asc": _frames, "log.trc": _frames, "log.log": _frames, "log.lvm": _labview,
    "log.uff": _universal, "test.journal": _journal, "log.dat": _imc, "log.bin": _catman,
}  # fmt: skip


def mutated(content, rng):
    """Return a damaged copy: bits, numbers, pieces, ends; the beginning, where formats say most, more often."""
    found = bytearray(content)
    for _ in range(int(rng.integers(1, 6))):
        length = len(found)
        place = int(length * rng.random() ** (3 if rng.random() < 0.5 else 1)) if length else 0
        size = int(2 ** rng.uniform(0, 8))
        match int(rng.integers(6)):
            case 0:
                found[place : place + 1] = bytes([int(rng.integers(256))])
            case 1:
                found[place : place + 4] = rng.choice([b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", bytes(4), b"\0\0\0\1"])
            case 2:
                found[place : place + 8] = rng.integers(0, 2**62, dtype=np.int64).tobytes()
            case 3:
                del found[place : place + size]
            case 4:
                found[place:place] = found[place : place + size]
            case _:
                del found[place if rng.random() < 0.3 else length :]
    return bytes(found)


def read_all(path):
    """Read every sample of every channel."""
    with read_recording(path) as recording:
        for channel in recording.channels.values():
            for start in range(0, channel.count, 100_000):
                channel.values(start, min(start + 100_000, channel.count))


def _reason(path):
    try:
        read_all(path)
    except RecordingError as error:
        return str(error)
    return None


def _peak_mb():
    status = Path("/proc/self/status")
    if status.exists():
        # of this program alone: what getrusage says begins with the peak of the one that started it
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return float(line.split()[1]) / 1024.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024.0 if sys.platform != "darwin" else 1048576.0)


def _say(**what):
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()


def main(name, first, stop, folder):
    """Read mutated inputs and print one line of JSON for each."""
    # a library that asks for all memory is to be refused it, not to take the computer down
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    path = Path(folder) / name
    FORMATS[name](path)
    content = path.read_bytes()
    if name != "log.dxd":
        read_all(path)
    _say(number=-1, peak_mb=_peak_mb())
    for number in range(first, stop):
        path.write_bytes(mutated(content, np.random.default_rng((11, number))))
        begin = time.perf_counter()
        reason = _reason(path)
        _say(number=number, reason=reason, took_s=time.perf_counter() - begin, peak_mb=_peak_mb())


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
