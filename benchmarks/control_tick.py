"""Where the time of a control tick goes, and the real-time factor, from a real walk.

    python benchmarks/control_tick.py [--scenario NAME] [--set KEY=VALUE ...]

Run it with OMP_NUM_THREADS=1 on an idle core.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
from bare_walk import BareWalk

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

CHANNEL_PARTS = ("state", "wbc_build", "wbc_solve", "planner", "log", "physics", "tick", "controller")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Microseconds of each part of a control tick, and real-time factor.")
    parser.add_argument("--scenario", default="diagonal-walk", help="catalogue name or path of a scenario file")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="set a key; repeatable")
    return parser.parse_args()


def row(name: str, seconds: np.ndarray, every: float) -> str:
    median, p90 = np.percentile(seconds, (50, 90)) * 1e6
    return f"{name:<20} {median:>9.1f} {p90:>9.1f} {np.mean(seconds) * 1e6 / every:>13.1f}"


def print_parts(scenario: str, overrides: list[str], folder: Path) -> None:
    walk = BareWalk(scenario, tuple(overrides))
    count = sum(1 for _ in walk.ticks(folder / "bare.mcap"))
    print(f"{'part':<20} {'median us':>9} {'p90 us':>9} {'mean per tick':>13}")
    for name, seconds in walk.laps.items():
        print(row(name, np.array(seconds), count / len(seconds)))
    total = sum(sum(seconds) for seconds in walk.laps.values()) / count
    print(f"{'sum':<20} {'':>9} {'':>9} {1e6 * total:>13.1f}   of {1e6 / walk.rate:.0f} at {walk.rate} Hz")


def print_run(scenario: str, overrides: list[str], folder: Path) -> None:
    result = run_scenario(load_scenario(scenario, overrides), folder)
    timing = read(result.log)["/timing"]
    print(f"\nrun of {scenario}: {'; '.join(result.verdict.reasons) or 'all criteria met'}")
    for name in CHANNEL_PARTS:
        spent = timing.field(name) * 1e-6
        used = spent[spent > 0.0]
        print(row(f"/timing.{name}", used, len(spent) / len(used)))
    print(f"real-time factor {result.verdict.to_json()['real_time_factor']:.2f} with full logging")


def main() -> None:
    options = arguments()
    with tempfile.TemporaryDirectory() as folder:
        print_parts(options.scenario, options.set, Path(folder))
        print_run(options.scenario, options.set, Path(folder))


if __name__ == "__main__":
    main()
