"""Write the sample output of README.md: what `surefoot run walk` prints.

    python docs/readme.py

It walks for real. What the wall clock measures is written as a range, since it is another on each machine.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"
COMMAND = ("run", "walk")
REAL_TIME = "4 to 5"
"""Real-time factor on one core of a present machine, as the README says."""

_BLOCK = re.compile(r"(?s)(<!-- sample: walk -->\n```\n).*?(```\n<!-- end -->)")


def sample() -> str:
    """The command and what it prints."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "surefoot", *COMMAND]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return without_clock(f"$ surefoot {' '.join(COMMAND)}\n{done.stdout}")


def without_clock(output: str) -> str:
    """The output without spaces at the ends of lines, and with the range in the place of what was measured."""
    lines = "".join(f"{line.rstrip()}\n" for line in output.splitlines())
    return re.sub(
        r"(?m)^(real_time_factor +)\S+( +)(times)",
        lambda found: f"{found[1]}{REAL_TIME:<{found.start(3) - found.end(1)}}{found[3]}",
        lines,
    )


def updated(text: str, output: str) -> str:
    """The text of the README with another sample."""
    return _BLOCK.sub(lambda found: f"{found[1]}{output}{found[2]}", text)


if __name__ == "__main__":
    README.write_text(updated(README.read_text(encoding="utf-8"), sample()), encoding="utf-8")
