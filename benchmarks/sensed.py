"""Errors of the estimator over its deviations, at fixed instants of a walk, over seeds.

    python -m benchmarks.sensed --seeds 20 --out docs/sensors.csv

Each run is a walk of three steps. Each error is divided by the deviation that the estimator says. The mean of the
squares over seeds and instants is the NEES per number: 1 of an estimator that knows how wrong it is.
"""

import argparse
import csv
from pathlib import Path

import numpy as np

import surefoot
from surefoot.scenarios.log import read
from surefoot.wbc.types import Array

INSTANTS = (0.8, 1.2, 1.6, 2.0, 2.4, 2.8)
"""Instants at which errors are looked at, in both supports and at both feet [s]."""

WALK = {"gait.steps": 3, "duration": 3.0, "criteria": {}}
PARTS = {"CoM": "com", "velocity": "com_velocity", "tilt": "tilt"}
UNITS = {"CoM": (1e3, "mm"), "velocity": (1e3, "mm/s"), "tilt": (180.0 / np.pi, "°")}


def sample(preset: str, seed: int, folder: Path) -> dict[str, tuple[Array, Array]]:
    """Errors and deviations of a run by name, shape (instants, n) each."""
    keys = {**WALK, "sensing.preset": preset, "seed": seed}
    log = read(surefoot.run(surefoot.load("walk-level", keys), out=folder).log)["/estimation"]
    at = np.searchsorted(log.time, INSTANTS)
    return {name: (log.field(f"{part}_error")[at], log.field(f"{part}_deviation")[at]) for name, part in PARTS.items()}


def rows(preset: str, seeds: int, folder: Path) -> list[list[str]]:
    """A row per quantity: preset, quantity, seeds, RMS of the error, its unit, NEES."""
    found = [sample(preset, seed, folder) for seed in range(seeds)]
    table = []
    for name, (factor, unit) in UNITS.items():
        errors, deviations = (np.stack([run[name][k] for run in found]) for k in (0, 1))
        rms = factor * float(np.sqrt(np.mean(errors**2)))
        squares = float(np.mean((errors / deviations) ** 2))
        table.append([preset, name, str(seeds), f"{rms:.2f}", unit, f"{squares:.2f}"])
    return table


def main() -> None:
    """Measure and write the CSV."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20, help="seeds of the sensors")
    parser.add_argument("--presets", nargs="+", default=["good", "cheap"], help="presets of the sensors")
    parser.add_argument("--runs", type=Path, default=Path("runs"), help="folder of the logs")
    parser.add_argument("--out", type=Path, required=True, help="CSV that is written")
    options = parser.parse_args()
    with options.out.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["preset", "quantity", "seeds", "error_rms", "unit", "nees"])
        for preset in options.presets:
            writer.writerows(rows(preset, options.seeds, options.runs))
            file.flush()


if __name__ == "__main__":
    main()
