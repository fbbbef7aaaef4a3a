"""Runs a command and says what the whole process, with all its children, has cost. Linux."""

import dataclasses
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time


@dataclasses.dataclass
class Run:
    """`cpu_s` is user and system time, `peak_bytes` the largest resident set of any one process."""

    returncode: int
    cpu_s: float
    wall_s: float
    peak_bytes: int
    stdout: str
    stderr: str
    timed_out: bool

    @property
    def failure(self):
        """Why it failed, in a few words, or nothing."""
        if self.timed_out:
            return f"stopped after {self.wall_s:.0f} s"
        if self.returncode < 0:
            return f"killed by {signal.Signals(-self.returncode).name}"
        if self.returncode:
            lines = [line for line in (self.stdout + self.stderr).splitlines() if "rror" in line]
            return f"exit code {self.returncode}" + (f": {lines[-1]}" if lines else "")
        return ""


def end_children_on_sigterm():
    """A script that is told to end takes what it runs with it, as it does on Ctrl-C. Call it once, from its main()."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))


def run(command, limit_s=None):
    """Runs `command` to its end, or kills it and its children after `limit_s` seconds of wall time."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        child = subprocess.Popen(
            [str(word) for word in command], stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True
        )
        timed_out = threading.Event()

        def stop():
            timed_out.set()
            os.killpg(child.pid, signal.SIGKILL)

        timer = threading.Timer(limit_s, stop) if limit_s else None
        if timer:
            timer.start()
        try:
            _, status, usage = os.wait4(child.pid, 0)
        except BaseException:
            os.killpg(child.pid, signal.SIGKILL)
            raise
        finally:
            if timer:
                timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.monotonic() - start
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
    cpu_s = usage.ru_utime + usage.ru_stime
    return Run(child.returncode, cpu_s, wall_s, usage.ru_maxrss * 1024, *texts, timed_out.is_set())
