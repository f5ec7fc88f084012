"""Choosing the reader of a file."""

import wave
from types import SimpleNamespace

import pytest
from scipy.io import wavfile

from shaftprint.errors import RecordingError
from shaftprint.recording import Recording, read_recording
from shaftprint.recording.readers._all import READERS
from shaftprint.recording.readers._reader import Reader


def _reader(name, *, mine):
    def read(path, **hints):
        return Recording(path=path, sha256="", format=f"{name} {sorted(hints)}", channels={})

    return SimpleNamespace(NAME=name, is_mine=lambda path: mine, read=read)


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "logger.dat"
    path.write_bytes(b"something")
    return path


def test_the_one_that_claims_the_file_reads_it(path):
    readers: list[Reader] = [_reader("A", mine=False), _reader("B", mine=True)]
    assert read_recording(path, readers=readers, gain=2).format == "B ['gain']"


def test_a_file_that_nobody_claims_is_refused_with_the_known_formats(path):
    with pytest.raises(RecordingError) as found:
        read_recording(path)
    for reader in READERS:
        assert reader.NAME in str(found.value)
    assert str(path) in str(found.value)


@pytest.mark.parametrize(("given", "is_told"), [(100.0, False), (100.05, False), (2000.0, True)])
def test_a_rate_that_was_given_and_is_not_that_of_the_file_is_told(tmp_path, given, is_told):
    path = tmp_path / "log.csv"
    path.write_text("time [s],M_s [V]\n" + "".join(f"{k / 100.0},{k % 7}\n" for k in range(300)))
    try:
        with read_recording(path, sample_rate_hz=given) as recording:
            told = [one for one in recording.remarks if "100 Hz, which counts; the 2000 Hz that were given" in one]
            assert recording.channel("M_s").rate_hz == pytest.approx(100.0)
    except RecordingError as refused:
        told = [str(refused)]
    assert bool(told) is is_told


def test_a_file_that_two_claim_is_refused_with_both(path):
    with pytest.raises(RecordingError, match="it may be A and B; pass the right one as readers"):
        read_recording(path, readers=[_reader("A", mine=True), _reader("B", mine=True)])


def test_a_missing_file_a_folder_and_an_empty_file_are_told(tmp_path):
    with pytest.raises(RecordingError, match=r"none\.nc: expected a logger file, found none there"):
        read_recording(tmp_path / "none.nc")
    with pytest.raises(RecordingError, match="expected a logger file, found a folder; name the file in it"):
        read_recording(tmp_path)
    (tmp_path / "empty.csv").touch()
    with pytest.raises(RecordingError, match=r"empty\.csv: expected a logger file, found an empty one"):
        read_recording(tmp_path / "empty.csv")


def test_a_missing_file_is_told_with_the_one_that_is_spelt_like_it(path):
    with pytest.raises(RecordingError, match=r"loger\.dat: expected .* Did you mean logger\.dat\?$"):
        read_recording(path.with_name("loger.dat"))
    with pytest.raises(RecordingError, match=r"trip\.dat: expected a logger file, found none there\.$"):
        read_recording(path.with_name("trip.dat"))


def test_a_file_that_cannot_be_opened_is_told(path):
    def fail(path):
        raise PermissionError("Permission denied")

    reader = SimpleNamespace(NAME="A", is_mine=fail, read=None)
    with pytest.raises(RecordingError, match=r"logger\.dat: the file cannot be read: Permission denied\."):
        read_recording(path, readers=[reader])


def test_a_recording_without_channels_says_so(path):
    recording = read_recording(path, readers=[_reader("A", mine=True)])
    with recording, pytest.raises(RecordingError, match='expected a channel "U", found none'):
        recording.channel("U")


@pytest.mark.parametrize(
    ("name", "content", "remedy"),
    [
        ("log.xlsx", b"PK\3\4\0\0", "it is a spreadsheet: save the sheet as CSV"),
        ("log.raw", b"\1\2\3\0", "imc in a form that is not read: in FAMOS or imc STUDIO save it as .dat"),
        ("log.db", b"SQLite format 3\0", "it is an SQLite database: export the table as CSV"),
        ("log.bin", b"\1\2\3\0", "export it as CSV, MATLAB or MDF 4 from the program that wrote it"),
        ("log.ubx", b"\xb5b\1\7\x5c\0", r"it is UBX of a u-blox receiver: write time and gSpeed \[mm/s\]"),
        ("log.psdata", b"\1\2\3\0", "PicoScope or PicoLog: save it as CSV or MATLAB 4"),
        (
            "mine.toml",
            b"[vessel]\nname = 'Meander'\n",
            "it is a file of settings, as of a vessel, a campaign or a drive",
        ),
        ("log.acme", b"\1\2\3\0", "export it as CSV, MATLAB or MDF 4 from the program that wrote it"),
    ],
)
def test_a_format_that_is_not_read_says_which_export_is(tmp_path, name, content, remedy):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=f"expected one of the formats .*, found none of them; {remedy}"):
        read_recording(path)


@pytest.mark.parametrize("ending", [".txt", ".log"])
@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("server 2021\n$HDMTW,12.6,C*1A\n$HDVTG,189.1,T,,M,8.4,N,15.5,K*49\n", "sentences of NMEA 0183"),
        ("!AIVDM,1,1,,B,3:16dn0PBkPfhv,0*1A\n!AIVDM,1,1,,B,402Fha1vAj>kP0,0*4B\n", "sentences of NMEA 0183"),
        ("!PDGY,127488,2,3,255,481.734,2C20AAAAAAE=\n!PDGY,127251,2,3,255,481.735,2AAAAAD///8=\n", "form of iKonvert"),
        ("$date today $end\n$timescale 10 us $end\n#0\n1!\n#25\n0!\n", "edges of a logic analyser as VCD, .*timescale"),
        (
            "***BUSMASTER Ver 3.2.2***\n***PROTOCOL CAN***\n***HEX***\n10:00:00:0010 Rx 1 0x316 s 8 05 21\n",
            "a log of BUSMASTER.*ASC",
        ),
        (
            "# sample\n<0x316> [8] 05 21 68 09 21 21 00 6f\n<0x18f> [2] fe 5b\n",
            "frames of a CAN bus without times: log it with candump -l",
        ),
        ("309#40\n025#00\n309#40\n", "frames of a CAN bus without times: log it with candump -l"),
        (
            "22:20:14:992 Rx 0 0000021A s 2 FE 36\n22:20:14:992 Rx 0 0000023A s 2 00 37\n",
            "a log of BUSMASTER.*ASC",
        ),
        (
            "# sample\n  can0  09F8027F   [8]  00 FC FF FF 00 00 FF FF\n  can0  09F8017F   [2]  E8 AC\n",
            "expected times in front of the frames, found none; log with candump -L",
        ),
    ],
)
def test_a_log_that_is_no_table_is_named(tmp_path, ending, lines, words):
    path = tmp_path / f"log{ending}"
    path.write_text(40 * lines)
    with pytest.raises(RecordingError, match=words):
        read_recording(path)


def test_a_table_of_whole_numbers_with_dates_is_no_bus(tmp_path):
    path = tmp_path / "log.csv"
    rows = (f"2026-03-01 10:00:{k:02d},1,{12500 + k},950,85,77,{30 + k % 10}\n" for k in range(60))
    path.write_text("time,running,torque [N m],speed [rpm],oil [degC],water [degC],rack [%]\n" + "".join(rows))
    with read_recording(path) as recording:
        assert recording.channel("torque").values(0, 3) == pytest.approx([12500.0, 12501.0, 12502.0])


def test_a_sound_file_is_refused_with_what_its_reader_makes_of_24_bits(tmp_path):
    path = tmp_path / "log.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 3, 1000, 0, "NONE", "not compressed"))
        file.writeframes(b"".join(count.to_bytes(3, "little", signed=True) for count in (1000, -1000)))
    with pytest.raises(RecordingError, match="24 bits come times 256"):
        read_recording(path)
    assert wavfile.read(path)[1].tolist() == [256_000, -256_000]
