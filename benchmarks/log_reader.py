"""Time to load one channel of a long log into numpy: 20,000 messages of 60 values among five channels.

python benchmarks/log_reader.py [--tries N]
"""

import argparse
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec

MESSAGES, VALUES, CHANNELS, PERIOD_NS = 20_000, 60, 5, 2_000_000


def write(path: Path) -> None:
    rows = np.random.default_rng(0).normal(size=(500, VALUES))
    with LogWriter(path, {}) as writer:
        specs = [ChannelSpec(f"/c{i}", "Values", (FieldSpec("values", (VALUES,)),)) for i in range(CHANNELS)]
        channels = [writer.channel(spec) for spec in specs]
        for tick in range(MESSAGES):
            for channel in channels:
                channel.append(tick * PERIOD_NS, rows[tick % 500])


def load(path: Path) -> float:
    start = time.perf_counter()
    values = read(path)["/c0"].field("values")
    spent = time.perf_counter() - start
    assert values.shape == (MESSAGES, VALUES)
    return spent


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=9)
    tries = parser.parse_args().tries
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        write(path)
        spent = [1e3 * load(path) for _ in range(tries)]
        print(f"log of {path.stat().st_size / 1e6:.0f} MB, {MESSAGES} x {VALUES} values of one of {CHANNELS} channels")
    print(f"median {median(spent):.0f} ms, least {min(spent):.0f} ms, most {max(spent):.0f} ms")


if __name__ == "__main__":
    main()
