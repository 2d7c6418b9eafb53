"""Install a distribution into an empty environment and walk with it.

    python tests/packaging/empty_environment.py dist/surefoot-*.whl dist/surefoot-*.tar.gz

Prints for each how large the environment became.
"""

import subprocess
import sys
import tempfile
import venv
from pathlib import Path

CONSTRAINTS = Path(__file__).parents[2] / "constraints.txt"


def walks(distribution: Path) -> int:
    """Bytes of an environment that holds the distribution, in which a walk passes."""
    with tempfile.TemporaryDirectory() as folder:
        venv.create(folder, with_pip=True)
        before = size(Path(folder))
        program = Path(folder, "bin")
        install = [program / "pip", "install", "--quiet", "-c", CONSTRAINTS, distribution.resolve()]
        subprocess.run(install, check=True)
        for command in (["--version"], ["run", "diagonal-walk", "--set", "gait.steps=2", "--out", folder]):
            subprocess.run([program / "surefoot", *command], check=True, cwd=folder)
        return size(Path(folder)) - before


def size(folder: Path) -> int:
    """Bytes of all files in a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(
            f"{Path(name).name}: walks on Python {sys.version.split()[0]}, {walks(Path(name)) / 1e6:.0f} MB installed"
        )
