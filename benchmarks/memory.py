"""Memory and time of commands that read a log, for a short and a long log."""

import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import surefoot
from benchmarks.lengthened import lengthened
from benchmarks.table import Section, Value

MOST = 300e6
"""Most memory of a command of its own, whatever the length of the log [B]."""

LENGTHS = (60.0, 1200.0)
"""Lengths of the logs [s]: a minute, and twenty."""

_READ = "import sys, surefoot; surefoot.read(sys.argv[1])['/truth'].field('com')"
_FRAME = "import sys, surefoot; surefoot.read(sys.argv[1]).frame('/contact')"

COMMANDS: Mapping[str, Sequence[str]] = {
    "inspect": ("inspect", "LOG"),
    "inspect --topic /truth": ("inspect", "LOG", "--topic", "/truth"),
    "inspect --topic /truth, 5 s": ("inspect", "LOG", "--topic", "/truth", "--from", "30", "--to", "35"),
    "inspect --topic /events": ("inspect", "LOG", "--topic", "/events"),
    "export to csv": ("inspect", "LOG", "--topic", "/contact", "--export", "OUT/contact.csv"),
    "export to npz": ("inspect", "LOG", "--topic", "/truth", "--export", "OUT/truth.npz"),
    "export to parquet": ("inspect", "LOG", "--topic", "/truth", "--export", "OUT/truth.parquet"),
    "plot": ("plot", "LOG", "--out", "OUT/all.png"),
    "plot, 5 s": ("plot", "LOG", "--from", "30", "--to", "35", "--out", "OUT/part.png"),
    "replay --html, 5 s": ("replay", "LOG", "--from", "30", "--to", "35", "--html", "OUT/part.html"),
    "compare": ("compare", "LOG", "LOG"),
    "recover": ("recover", "LOG", "OUT/recovered.mcap"),
    "read(LOG)['/truth'].field('com')": ("-c", _READ, "LOG"),
    "read(LOG).frame('/contact')": ("-c", _FRAME, "LOG"),
}
"""Commands of Surefoot, or programs, by what they are called in the table."""


class Peak:
    """The most that a process holds while it runs.

    Attributes:
        own: memory that no file backs, which the kernel cannot drop [B].
        all: the same with pages of files that are mapped, such as libraries and the log itself [B].
    """

    def __init__(self, process: "subprocess.Popen[bytes]") -> None:
        self.own = self.all = 0
        self._status, self._process = Path(f"/proc/{process.pid}/status"), process
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()

    def _watch(self) -> None:
        while self._process.poll() is None:
            lines = self._status.read_text().splitlines()
            found = dict(line.split(":", 1) for line in lines if line.startswith(("RssAnon", "RssShmem", "VmRSS")))
            sizes = {name: 1024 * int(text.split()[0]) for name, text in found.items()}
            self.own = max(self.own, sizes.get("RssAnon", 0) + sizes.get("RssShmem", 0))
            self.all = max(self.all, sizes.get("VmRSS", 0))
            time.sleep(0.005)

    def join(self) -> None:
        """Wait for the end of the process."""
        self._thread.join()


def measured(command: Sequence[str], log: Path, folder: Path) -> tuple[Peak, float]:
    """Run a command on a log in a process of its own; its peak, and the time that it took [s].

    Raises:
        RuntimeError: it failed.
    """
    words = [{"LOG": str(log)}.get(word, word.replace("OUT", str(folder))) for word in command]
    module = () if words[0] == "-c" else ("-m", "surefoot")
    begin = time.perf_counter()
    with subprocess.Popen([sys.executable, *module, *words], stdout=subprocess.DEVNULL) as process:
        peak = Peak(process)
        peak.join()
    if process.returncode not in (0, 1):  # 1: a verdict, or two logs that differ
        raise RuntimeError(f"{' '.join(words)} ended with {process.returncode}")
    return peak, time.perf_counter() - begin


def reading(quick: bool) -> Section:
    """Peak memory and time of each command, for a log of a minute and for one of twenty."""
    lengths = (40.0,) if quick else LENGTHS
    rows: list[tuple[Value, ...]] = []
    ratios: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = surefoot.run(surefoot.load("walk-level", {"gait.steps": 2} if quick else {}), out=folder).log
        for seconds in lengths:
            log = lengthened(source, folder / f"{seconds:.0f}.mcap", seconds)
            size = log.stat().st_size / 1e6
            for what, command in list(COMMANDS.items())[: 1 if quick else None]:
                out = Path(tempfile.mkdtemp(dir=folder))
                peak, spent = measured(command, log, out)
                rows.append((what, seconds / 60.0, size, peak.own / 1e6, peak.all / 1e6, spent))
                ratios[f"{what}, {seconds / 60.0:g} min, over {MOST / 1e6:.0f} MB"] = peak.own / MOST
            log.unlink()
    columns = ("what", "log, min", "log, MB", "own, MB", "with files, MB", "time, s")
    note = "own: memory that no file backs; with files: all that is resident, of which the kernel may drop the rest"
    return Section("memory of reading a log", columns, tuple(rows), note, ratios)
