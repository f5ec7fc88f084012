#!/usr/bin/env bash
# About: n2k 0.5.0 (NMEA 2000), engine speed of PGN 127488
# Guess: FFFE (out of range) and FFFD (reserved) are no speeds, and a speed of 20000 rpm, which the field cannot hold, is refused or sent as not available.
# What happens: they are read as 16383.5 and 16383.25 rpm; only FFFF is None. 20000 rpm are sent as FFFE, the mark for out of range, and read back by the same library as 16383.5 rpm;
#   -5 rpm, as of a shaft that turns astern, are sent as 0.
. "$(dirname "$0")/_setup.sh"
packages n2k==0.5.0
run <<'PY'
from find import seen
from n2k import messages


def sent(speed_rpm):
    engine = messages.EngineParametersRapid(engine_instance=0, engine_speed=speed_rpm, engine_boost_pressure=None, engine_tilt_trim=None)
    return messages.create_n2k_engine_parameters_rapid_message(engine)


for word, speed_rpm in (("ffff", None), ("feff", 16383.5), ("fdff", 16383.25)):
    message = sent(None)
    message.data = bytearray(bytes.fromhex(f"00{word}ffff7fffff"))
    found = messages.parse_n2k_engine_parameters_rapid(message).engine_speed
    seen(f"{word}: {found}", found == speed_rpm)
for speed_rpm, word, again in ((20_000.0, "feff", 16383.5), (-5.0, "0000", 0.0)):
    message = sent(speed_rpm)
    found = messages.parse_n2k_engine_parameters_rapid(message).engine_speed
    seen(f"{speed_rpm:g} rpm: {message.data[1:3].hex()}, read as {found}", message.data[1:3].hex() == word and found == again)
PY
