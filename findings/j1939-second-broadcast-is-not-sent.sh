#!/usr/bin/env bash
# About: can-j1939 2.0.12 on a virtual bus of python-can 4.6.1, three broadcasts of 20 bytes (as of active faults, DM1) one after the other
# Guess: they are sent one after the other, as J1939-21 wants of a sender with one broadcast at a time.
# What happens: while the first goes out (50 ms a packet) send_pgn() answers False for the others and they are never sent: no exception, no log line. A short message passes
#   meanwhile, and is there before the long one.
. "$(dirname "$0")/_setup.sh"
packages can-j1939==2.0.12 python-can==4.6.1
run <<'PY'
import time

import j1939
from find import seen

sender, listener, came = j1939.ElectronicControlUnit(), j1939.ElectronicControlUnit(), []
for unit in (sender, listener):
    unit.connect(interface="virtual", channel="engine room")
listener.subscribe(lambda priority, pgn, source, timestamp, data: came.append((pgn, len(data))))
name = j1939.Name(
    arbitrary_address_capable=0, industry_group=0, vehicle_system_instance=0, vehicle_system=0, function=0,
    function_instance=0, ecu_instance=0, manufacturer_code=0, identity_number=1,
)
engine = j1939.ControllerApplication(name, 0x00)
sender.add_ca(controller_application=engine)
engine.start()
time.sleep(1.0)
answers = [engine.send_pgn(0, 0xFE, group, 6, [1] * 20) for group in (0xCA, 0xE0, 0x01)]
engine.send_pgn(0, 0xFE, 0x02, 6, [1] * 8)
time.sleep(3.0)
sender.stop()
listener.stop()
seen(f"answers: {answers}", answers == [True, False, False])
seen(f"came:    {[(hex(pgn), size) for pgn, size in came]}", came == [(0xFE02, 8), (0xFECA, 20)])
PY
