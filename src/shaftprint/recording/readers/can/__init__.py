"""Frames of a CAN bus from any log, taken apart as a DBC or ARXML file, SAE J1939 or NMEA 2000 says what they hold."""
