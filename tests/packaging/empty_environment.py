"""Install a distribution into an empty environment and walk with it.

    python tests/packaging/empty_environment.py dist/surefoot-*.whl dist/surefoot-*.tar.gz [--keep FILE]

Prints for each how large the environment became, and the largest parts of it. With `--keep` a row of a file says
so, in place of the row of the same Python and kind.
"""

import argparse
import csv
import subprocess
import sys
import tempfile
import venv
from collections import Counter
from pathlib import Path

CONSTRAINTS = Path(__file__).parents[2] / "constraints.txt"
COLUMNS = ("python", "distribution", "MB", "largest")


def walks(distribution: Path) -> Counter[str]:
    """Bytes of the parts of an environment that holds the distribution, in which a walk passes."""
    with tempfile.TemporaryDirectory() as folder:
        venv.create(folder, with_pip=True)
        before = parts(Path(folder))
        program = Path(folder, "bin")
        install = [program / "pip", "install", "--quiet", "-c", CONSTRAINTS, distribution.resolve()]
        subprocess.run(install, check=True)
        for command in (["--version"], ["run", "diagonal-walk", "--set", "gait.steps=2", "--out", folder]):
            subprocess.run([program / "surefoot", *command], check=True, cwd=folder)
        return parts(Path(folder)) - before


def parts(folder: Path) -> Counter[str]:
    """Bytes of all files in an environment, by their folder beside the packages, or in that of what CMake built."""
    found: Counter[str] = Counter()
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink():
            first, *others = path.as_posix().partition("site-packages/")[2].split("/")
            found["/".join(others[:2]) if first == "cmeel.prefix" else first] += path.stat().st_size
    return found


def keep(path: Path, row: dict[str, str]) -> None:
    """Put a row into a file, in place of the one of the same Python and kind."""
    rows = list(csv.DictReader(path.open(encoding="utf-8"))) if path.exists() else []
    minor = row["python"].rpartition(".")[0]
    others = [
        one for one in rows if (one["python"].rpartition(".")[0], one["distribution"]) != (minor, row["distribution"])
    ]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        order = sorted(
            [*others, row], key=lambda one: ([int(part) for part in one["python"].split(".")], one["distribution"])
        )
        writer.writerows(order)


def main() -> None:
    """Try the distributions that are named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("distributions", nargs="+", type=Path)
    parser.add_argument("--keep", type=Path, help="CSV file of what was tried")
    told = parser.parse_args()
    for distribution in told.distributions:
        sizes = walks(distribution)
        megabytes, python = f"{sizes.total() / 1e6:.0f}", sys.version.split()[0]
        largest = ", ".join(f"{name} {size / 1e6:.0f}" for name, size in sizes.most_common(4))
        print(f"{distribution.name}: walks on Python {python}, {megabytes} MB installed ({largest})")
        if told.keep:
            kind = "wheel" if distribution.suffix == ".whl" else "sdist"
            keep(told.keep, {"python": python, "distribution": kind, "MB": megabytes, "largest": largest})


if __name__ == "__main__":
    main()
