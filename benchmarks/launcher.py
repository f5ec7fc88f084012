"""Start one process and report what it took, as JSON: from a small parent, whose memory a child's peak includes.

Between fork and exec a child still has its parent's pages, so a parent with SciPy loaded hides every smaller peak.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path


def cpu_so_far_s(process_id: int) -> float:
    """Return the CPU time of a process that runs, user and system [s]; not a number where the system does not tell."""
    try:
        status = Path(f"/proc/{process_id}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return float("nan")
    # the name before the numbers may hold spaces and brackets
    fields = status.rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    begin = time.perf_counter()
    process = subprocess.Popen([sys.executable, *sys.argv[1:]], stdout=subprocess.PIPE, text=True)
    first_line = process.stdout.readline() if process.stdout else ""
    first_line_cpu_s = cpu_so_far_s(process.pid)
    output = first_line + process.stdout.read() if process.stdout else ""
    _, status, usage = os.wait4(process.pid, 0)
    found = {
        "wall_s": time.perf_counter() - begin,
        "first_line_cpu_s": first_line_cpu_s,
        "cpu_s": usage.ru_utime + usage.ru_stime,
        # Bytes on macOS, units of 1024 bytes elsewhere.
        "peak_mb": usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e6 / 1024.0),
        "output": output.strip(),
    }
    print(json.dumps(found))
    sys.exit(os.waitstatus_to_exitcode(status))
