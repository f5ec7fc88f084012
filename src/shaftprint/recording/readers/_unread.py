"""How a file of a format that no reader knows becomes one that is read: which export of which program."""

from pathlib import Path

_TABLE = "save the sheet as CSV"
_BY_BYTES = {
    b"SQLite format 3": "it is an SQLite database: export the table as CSV (sqlite3 -header -csv)",
    b"PAR1": "it is a Parquet table: write it as CSV, pandas.read_parquet(FILE).to_csv(...)",
    b"\xd0\xcf\x11\xe0": f"it is an Office document: {_TABLE}",
    b"Rar!": "it is an archive: unpack it",
    b"7z\xbc\xaf": "it is an archive: unpack it",
    b"ULog": "it is a PX4 log: ulog2csv of the package pyulog writes CSV",
    b"\x89MCAP": "it is a ROS log: PlotJuggler exports it as CSV",
    b"#ROSBAG": "it is a ROS log: PlotJuggler exports it as CSV",
    b"RIFF": "it is a sound file: scipy.io.wavfile reads it, scipy.io.savemat writes the samples with fs",
}
_BY_ENDING = {
    (".xlsx", ".xlsm", ".xls", ".ods"): f"it is a spreadsheet: {_TABLE}",
    (".json",): "JSON, as of a result or the truth beside a simulated recording: name the file of the logger",
    (".zip",): "it is an archive: unpack it",
    (".tdm", ".tdx"): "National Instruments' TDM: in DIAdem or LabVIEW save it as TDMS",
    (".lms", ".ldsf", ".sdf"): "Simcenter Testlab: export time data as MATLAB or as UFF 58",
    (".raw",): "imc: in FAMOS or imc STUDIO export it as MATLAB, ASCII or MDF 4",
    (".bin",): "HBM catman: export it as MATLAB, ASCII or MDF 4",
    (".pnrf", ".nrf"): "HBM Perception: export it as MATLAB, ASCII or MDF 4",
    (".psdata", ".plw", ".picolog"): "PicoScope or PicoLog: save it as CSV or MATLAB 4",
    (".wfm", ".isf"): "an oscilloscope's waveform: save it there as CSV",
    (".wdf", ".wvf"): "Yokogawa: Xviewer saves it as CSV or MATLAB",
    (".mem", ".rec"): "Hioki: the instrument or its Waveform Viewer saves it as CSV",
    (".gbd",): "Graphtec: GL-Connect or the logger saves it as CSV",
    (".ddf", ".dlp"): "DASYLab: write with the format ASCII",
    (".mlg", ".msl"): "TunerStudio or MegaLogViewer: export it as CSV",
    (".ld",): "MoTeC i2: export it as CSV or MATLAB",
    (".mvr", ".erg"): "CarMaker: export it as CSV or MATLAB",
    (".edf", ".bdf"): "EDF: EDFbrowser exports it as ASCII",
    (".pcap", ".pcapng"): "a network log: Wireshark exports the fields as CSV",
    (".log", ".nmea"): "write its values as CSV with a column of times",
}


def remedy(path: Path) -> str:
    """Return how to come by a file that is read, from the first bytes and the ending of one that is not."""
    with path.open("rb") as file:
        begin = file.read(16)
    for mark, words in _BY_BYTES.items():
        if begin.startswith(mark):
            return words
    ending = path.suffix.lower()
    by_ending = next((words for endings, words in _BY_ENDING.items() if ending in endings), None)
    return by_ending or "export it as CSV, MATLAB or MDF 4 from the program that wrote it"
