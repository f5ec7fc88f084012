"""Files of imc: FAMOS, STUDIO and the devices, format 2."""
