#!/usr/bin/env bash
# About: mcap 1.6.0, iter_messages() between the first and the last time that the file's own statistics state
# Guess: that is everything, in the order in which the sensor has stamped it.
# What happens: the end is left out, and with it the last message; and the order is that of the logger's receipt (log_time): a message that was stamped earlier by its sensor and
#   came late stands behind younger ones. start_time and end_time are of receipt as well.
. "$(dirname "$0")/_setup.sh"
packages mcap==1.6.0
run <<'PY'
import io

from find import seen
from mcap.reader import make_reader
from mcap.writer import Writer

file = io.BytesIO()
writer = Writer(file)
writer.start()
channel = writer.register_channel("torque", "json", writer.register_schema("torque", "jsonschema", b"{}"))
for received, stamped in ((10, 9), (20, 19), (30, 15), (40, 39)):
    writer.add_message(channel, log_time=received, publish_time=stamped, data=b"{}")
writer.finish()
file.seek(0)
reader = make_reader(file)
statistics = reader.get_summary().statistics
first, last = statistics.message_start_time, statistics.message_end_time
between = [message.log_time for _, _, message in reader.iter_messages(start_time=first, end_time=last)]
stamps = [message.publish_time for _, _, message in reader.iter_messages()]
seen(f"statistics: {statistics.message_count} messages from {first} to {last}", statistics.message_count == 4)
seen(f"between those: {between}", between == [10, 20, 30])
seen(f"by the sensor's clock: {stamps}", stamps == [9, 19, 15, 39])
PY
