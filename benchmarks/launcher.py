"""Start one process and report what it took, as JSON: from a small parent, whose memory a child's peak includes.

Between fork and exec a child still has its parent's pages, so a parent with SciPy loaded hides every smaller peak.
"""

import json
import os
import subprocess
import sys
import time

if __name__ == "__main__":
    begin = time.perf_counter()
    process = subprocess.Popen([sys.executable, *sys.argv[1:]], stdout=subprocess.PIPE, text=True)
    output = process.stdout.read() if process.stdout else ""
    _, status, usage = os.wait4(process.pid, 0)
    found = {
        "wall_s": time.perf_counter() - begin,
        "cpu_s": usage.ru_utime + usage.ru_stime,
        # Bytes on macOS, units of 1024 bytes elsewhere.
        "peak_mb": usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e6 / 1024.0),
        "output": output.strip(),
    }
    print(json.dumps(found))
    sys.exit(os.waitstatus_to_exitcode(status))
