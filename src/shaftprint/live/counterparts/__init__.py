"""What stands between the program and the governor, a file a protocol; each loads its library when it is asked for."""
