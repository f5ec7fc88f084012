"""How a file of a format that no reader knows becomes one that is read: which export of which program."""

import re
from pathlib import Path

from shaftprint.recording.readers._packed import first_bytes

# So many of the first letters are looked at, and so many lines have to be alike.
_SEEN, _FEWEST_LINES, _SHORT = 4000, 2, 64
_TABLE, _TO_CSV = "save the sheet as CSV", ".to_csv(...)"
_ARCHIVE = "it is an archive: unpack it"
_OCTAVE = "in Octave save -v7 FILE.mat"
_NMEA_0183 = rb"[^\r\n$!]{0,80}[$!][A-Z]{4,5},[^\r\n]*\*[0-9A-F]{2}"
_IKONVERT = rb"!PDGY,\d+,\d,\d+,\d+,[\d.]+,"
_BUSMASTER = rb"(?:\*{3}(?:BUSMASTER|PROTOCOL) |\d\d?:\d\d:\d\d:\d{3,4} +[TR]x +\d+ +(?:0x)?[0-9A-Fa-f]+ +[sxr]+ +\d+ )"
_VCD = rb"\$(?:date|version|timescale|scope|var|comment|enddefinitions)\b"
_FRAMES_WITHOUT_TIMES = (
    rb"(?:(?:\w*can\d+ +|<0x)[0-9a-fA-F]{3,8}>? +\[\d\] +[0-9a-fA-F]{2}"
    rb"|[0-9A-F]{8},[0-9A-F]{2}(?: [0-9A-F]{2}){0,7} *\r?$|[0-9A-F]{3,8}#(?:[0-9A-F]{2}){0,8}\r?$)"
)
_MICROCHIP = rb"\d+;[RT]X;0x[0-9A-F]{3,8};\d;"
_GIT_LFS = rb"(?:version https://git-lfs|oid sha256:|size \d+$)"
_OF_LINES = {
    _NMEA_0183: "sentences of NMEA 0183, which come about once a second and are not read: log the NMEA 2000 bus itself "
    "(candump -l, BLF, ASC, TRC), or write the values as CSV with a column of times",
    _IKONVERT: "messages of NMEA 2000 in the form of iKonvert, which is not read: log the bus with candump -l",
    _BUSMASTER: "a log of BUSMASTER, which is not read: its converter of formats makes an ASC file of it",
    _VCD: "edges of a logic analyser as VCD, which is not read: write them as CSV, a row of time [s] and level each; "
    "times count in its $timescale",
    _FRAMES_WITHOUT_TIMES: "frames of a CAN bus without times: log it with candump -l",
    _MICROCHIP: "frames of a CAN bus in a form that is not read: SavvyCAN loads it and saves it as a candump log",
    _GIT_LFS: "a pointer of Git LFS in place of the file: git lfs pull",
}
"""What lines of text begin as, and what they are."""
# Gantner's name stands behind its length
_UDBF = b"UniversalDataBinFile"
_LECROY = b"WAVEDESC"
_SQLITE, _ZIP = b"SQLite format 3", b"PK\x03\x04"
_BY_BYTES = {
    _SQLITE: "it is an SQLite database: export the table as CSV (sqlite3 -header -csv)",
    b"PAR1": "it is a Parquet table: write it as CSV, pandas.read_parquet(FILE).to_csv(...)",
    b"\xd0\xcf\x11\xe0": f"it is an Office document: {_TABLE}",
    b"ARROW1": f"it is an Arrow or Feather table: write it as CSV, pandas.read_feather(FILE){_TO_CSV}",
    b"FEA1": f"it is a Feather table: write it as CSV, pandas.read_feather(FILE){_TO_CSV}",
    b"ORC": f"it is an ORC table: write it as CSV, pandas.read_orc(FILE){_TO_CSV}",
    b"\x93NUMPY": "it is an array of NumPy: scipy.io.savemat writes it with its fs or t, numpy.savetxt as text",
    b"<stata_dta>": f"it is a table of Stata: write it as CSV, pandas.read_stata(FILE){_TO_CSV}",
    b"\x80\x04\x95": "it is a pickle, which is never opened here: write the values as CSV in the program that made it",
    b"\x80\x05\x95": "it is a pickle, which is never opened here: write the values as CSV in the program that made it",
    b"CDF\x05": "it is a netCDF file with 64-bit data: nccopy -k nc4 FILE NEW.nc",
    b"# Octave": f"it is Octave's text: {_OCTAVE}",
    b"# Created by Octave": f"it is Octave's text: {_OCTAVE}",
    b"Octave-1-": f"it is Octave's binary form: {_OCTAVE}",
    b"<?xml": "it is XML: write the values as CSV",
    b"<html": "it is a page: save its table as CSV",
    b"<table": "it is a page: save its table as CSV",
    b"{": "JSON, as of a result or the truth beside a simulated recording: name the file of the logger, or write "
    "its values as CSV",
    b"Rar!": _ARCHIVE,
    b"7z\xbc\xaf": _ARCHIVE,
    b"\xb5b": "it is UBX of a u-blox receiver: write time and gSpeed [mm/s] of its NAV-PVT messages as CSV (pyubx2)",
    b"ULog": "it is a PX4 log: ulog2csv of the package pyulog writes CSV",
    b"\x89MCAP": "it is a ROS log: PlotJuggler exports it as CSV",
    b"#ROSBAG": "it is a ROS log: PlotJuggler exports it as CSV",
    b'"TOB': "it is Campbell's binary form: in LoggerNet, CardConvert writes TOA5",
    **dict.fromkeys((b"RG01", b"RG03", b"AG01", b"AG03", b"AG10"), "an oscilloscope's samples: save them there as CSV"),
    b"RIFF": "it is a sound file: scipy.io.wavfile reads it (24 bits come times 256), scipy.io.savemat writes the "
    "samples with fs",
}
# names of what is in an archive
_BY_NAMES = {
    b"[Content_Types].xml": f"it is a spreadsheet: {_TABLE}",
    b"docProps/": f"it is a spreadsheet: {_TABLE}",
    b"opendocument.spreadsheet": f"it is a spreadsheet: {_TABLE}",
    b"logic-1": "it is a session of sigrok: sigrok-cli -i FILE -O csv; the rate stands above its rows",
    b".npy": "it holds arrays of NumPy: scipy.io.savemat writes them with their fs or t",
}
_BY_ENDING = {
    (".xlsx", ".xlsm", ".xls", ".ods"): f"it is a spreadsheet: {_TABLE}",
    (".zip",): _ARCHIVE,
    (".toml",): "it is a file of settings, as of a vessel, a campaign or a drive: name the recording first, and this "
    "one behind --vessel, --campaign or --drive",
    (".dbc", ".arxml", ".kcd", ".sym"): "it says what frames hold: name the log first, and this one behind --dbc",
    (".tdm", ".tdx"): "National Instruments' TDM: in DIAdem or LabVIEW save it as TDMS",
    (".lms", ".ldsf", ".sdf"): "Simcenter Testlab: export time data as MATLAB or as UFF 58",
    (".raw",): "imc in a form that is not read: in FAMOS or imc STUDIO save it as .dat, MATLAB or MDF 4",
    (".pnrf", ".nrf"): "HBM Perception: export it as MATLAB, ASCII or MDF 4",
    (".psdata", ".plw", ".picolog"): "PicoScope or PicoLog: save it as CSV or MATLAB 4",
    (".wfm", ".isf"): "an oscilloscope's waveform: save it there as CSV",
    (".wdf", ".wvf"): "Yokogawa: Xviewer saves it as CSV or MATLAB",
    (".mem", ".rec"): "Hioki: the instrument or its Waveform Viewer saves it as CSV",
    (".gbd",): "Graphtec: GL-Connect or the logger saves it as CSV",
    (".ddf", ".dlp"): "DASYLab: write with the format ASCII",
    (".mlg", ".msl"): "TunerStudio or MegaLogViewer: export it as CSV",
    (".ld",): "MoTeC i2: export it as CSV or MATLAB",
    (".xrk", ".xrz", ".drk"): "AIM: Race Studio exports it as CSV",
    (".llg", ".llgx"): "Link: PCLink exports it as CSV",
    (".svdx", ".svbx"): "TwinCAT Scope: export it as CSV",
    (".kme", ".kme40", ".kme50"): "Kvaser Memorator: its program extracts it as ASC, BLF or MDF 4",
    (".ebl",): "Actisense: its EBL Reader exports N2K ASCII",
    (".rsp", ".dac", ".sie"): "nCode or RPC: export time data as CSV, MATLAB or UFF 58",
    (".mvr", ".erg"): "CarMaker: export it as CSV or MATLAB",
    (".edf", ".bdf"): "EDF: EDFbrowser exports it as ASCII",
    (".pcap", ".pcapng"): "a network log: Wireshark exports the fields as CSV",
    (".log", ".nmea"): "write its values as CSV with a column of times",
}


def remedy(path: Path) -> str:
    """Return how to come by a file that is read, from the first bytes and the ending of one that is not."""
    begin = first_bytes(path) or b""
    ending = path.suffix.lower()
    by_ending = next((words for endings, words in _BY_ENDING.items() if ending in endings), None)
    if begin.startswith(_SQLITE) and b"arbitration_id" in begin:
        return "it holds the frames of a CAN bus: can_logconvert FILE log.blf makes a log of them, which is read"
    if _LECROY in begin[:_SHORT]:
        return "it is an oscilloscope's waveform: save it there as ASCII or MATLAB"
    if _UDBF in begin[:_SHORT]:
        return "it is Gantner's UDBF: GI.bench exports it as CSV"
    if begin.startswith(_ZIP):
        return next((words for mark, words in _BY_NAMES.items() if mark in begin), by_ending or _ARCHIVE)
    if _every_second_is_nul(begin):
        return "it is text in UTF-16 without its mark: save it as UTF-8"
    for mark, words in _BY_BYTES.items():
        if begin.startswith(mark):
            return words
    of_lines = what_lines_are(begin)
    if of_lines:
        return f"it holds {of_lines}"
    return by_ending or "export it as CSV, MATLAB or MDF 4 from the program that wrote it"


def what_lines_are(begin: bytes) -> str:
    """Return what a text is that is no table, and what to do; empty where its first lines do not show it.

    ``begin``: first bytes of the file.
    """
    for pattern, words in _OF_LINES.items():
        if len(re.findall(rb"(?m)^[ \t]*" + pattern, begin[:_SEEN])) >= _FEWEST_LINES:
            return words
    return ""


def _every_second_is_nul(begin: bytes) -> bool:
    """Return whether bytes are letters of two bytes each, as Windows stores ASCII in."""
    odd, even = begin[1:-1:2], begin[:-1:2]
    return any(ours and not any(ours) and all(others) for ours, others in ((odd, even[: len(odd)]), (even, odd)))
