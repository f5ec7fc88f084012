"""NI TDMS files of LabVIEW and DAQmx."""
