"""Behaviour to the bit: digests of every channel of about sixty runs, to hold a change against the code before it.

    python benchmarks/digests.py --out before.json --jobs 2            # on the old code, ten minutes of two cores
    python benchmarks/digests.py --against before.json --jobs 2        # on the new; exits 1 where a run differs

Runs are those of the catalogue with the sensors that they name, walks on the pendulum, pushes and punches
at random with fixed seeds, other sensors, and other robots. All channels count but those of the wall's clock and of the
process. A run that is refused counts with its refusal.
"""

import argparse
import hashlib
import json
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import surefoot
from surefoot.scenarios.catalogue import CONTROLS, OWN

Overrides = dict[str, Any]

OF_THE_CLOCK = ("/timing", "/process")
"""Topics that differ from run to run."""

PENDULUM: Overrides = {"fidelity": "pendulum"}
GOOD: Overrides = {"sensing.source": "ekf", "sensing.preset": "good"}
CHEAP: Overrides = {**GOOD, "sensing.preset": "cheap"}


def pushed(seed: int, least: float, most: float, body: str | None = None) -> Overrides:
    """A push of 0.1 s at random: its impulse per mass from a range [N·s/kg], its direction, step and moment."""
    rng = np.random.default_rng(seed)
    push = {
        "step": int(rng.integers(4, 9)),
        "phase": ("single", "double")[int(rng.integers(2))],
        "fraction": round(float(rng.uniform()), 3),
        "duration": 0.1,
        "impulse": round(float(rng.uniform(least, most)), 3),
        "direction": round(float(rng.uniform(-np.pi, np.pi)), 3),
    }
    return {"pushes": [push if body is None else {**push, "body": body}], "criteria": {"fell": False}}


def catalogue() -> Iterator[tuple[str, Overrides]]:
    """All scenarios as they stand, and some on the pendulum."""
    for name in (*OWN, *CONTROLS):
        yield name, {}
    for name in ("walk-level", "stairs-up", "walk-turn", "commanded", "paper-walk", "paper-push"):
        yield name, PENDULUM


def pushes() -> Iterator[tuple[str, Overrides]]:
    """Pushes and punches at random of three robots, from sensors and from the true state."""
    for seed in range(4):
        yield "walk-level", pushed(seed, 0.2, 0.6)
        yield "walk-level", {"sensing.preset": None, **pushed(100 + seed, 0.2, 0.6)}
        yield "walk-level", {"robot": "g1", "sized_for": "humanoid100", **pushed(200 + seed, 0.2, 0.6)}
    yield "walk-level", {"robot": "talos", "sized_for": "humanoid100", "sensing.preset": None, **pushed(300, 0.2, 0.4)}
    yield "walk-level", pushed(400, 0.1, 0.3, "left_forearm")
    yield "stairs-up", pushed(500, 0.05, 0.15)
    yield "walk-level", {**PENDULUM, **pushed(600, 0.2, 0.6)}
    yield "stand", {**PENDULUM, "pushes": [{"time": 1.0, "duration": 0.1, "force": [400, 0, 0]}]}


def sensors() -> Iterator[tuple[str, Overrides]]:
    """Other sensors, none in the feet, and motors that err."""
    yield "walk-level", CHEAP
    yield "stairs-up", CHEAP
    yield "walk-level", {**GOOD, "sensing.wrench": "none"}
    yield "walk-turn", {"sensing.preset": None}
    yield "walk-level", {"motors": {"delay": 0.004, "noise": 2.0, "friction_loss": 1.0}}


def robots() -> Iterator[tuple[str, Overrides]]:
    """Other robots on the walk and on stairs."""
    for name in ("g1", "talos", "alexander"):
        sized = {"robot": name, "sized_for": "humanoid100"}
        yield "walk-level", sized
        yield "stairs-up", {**sized, "sensing.preset": None}


def walks() -> list[tuple[str, Overrides]]:
    """Scenario and overrides of each run."""
    return [*catalogue(), *pushes(), *sensors(), *robots()]


def label_of(walk: tuple[str, Overrides]) -> str:
    """Name of a run."""
    return f"{walk[0]} {json.dumps(walk[1], sort_keys=True)}"


def digests(walk: tuple[str, Overrides]) -> tuple[str, Mapping[str, str]]:
    """Name of a run, and the digest of each of its channels by topic, with how it ended."""
    name, overrides = walk
    try:
        with tempfile.TemporaryDirectory() as folder:
            result = surefoot.run(surefoot.load(name, overrides), out=folder)
            log = surefoot.read(result.log)
            found = {topic: channel_digest(log, topic) for topic in log.topics if topic not in OF_THE_CLOCK}
            return label_of(walk), {"end": json.dumps(log.metadata["end"], sort_keys=True), **found}
    except (surefoot.ScenarioError, surefoot.SetupError) as error:
        return label_of(walk), {"refused": str(error)}


def channel_digest(log: surefoot.Log, topic: str) -> str:
    """Digest of the times and contents of all messages of a topic in order of time."""
    found = hashlib.sha256()
    for stamp, content in sorted(log.messages(topic), key=lambda message: message[0]):
        found.update(stamp.to_bytes(8, "little") + content)
    return found.hexdigest()[:16]


def moved(before: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    """Topics, or what else is known of a run, that are not as before."""
    return [key for key in {**before, **now} if before.get(key) != now.get(key)]


def main() -> int:
    """Make the digests, and tell those that differ."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--out", type=Path, help="file to write the digests to")
    parser.add_argument("--against", type=Path, help="digests to hold these against")
    parser.add_argument("--only", default="", help="runs whose line contains this")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    chosen = [walk for walk in walks() if options.only in label_of(walk)]
    begin = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool(options.jobs, maxtasksperchild=12) as pool:
        found = dict(pool.imap_unordered(digests, chosen, chunksize=1))
    print(f"{len(found)} runs in {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    if options.out is not None:
        options.out.write_text(json.dumps(found, indent=1, sort_keys=True) + "\n")
    if options.against is None:
        return 0
    before = json.loads(options.against.read_text())
    others = {label: moved(before.get(label, {"run": "none"}), now) for label, now in sorted(found.items())}
    for label, topics in others.items():
        if topics:
            print(f"{label}\n    differs in {', '.join(topics)}")
    count = sum(not topics for topics in others.values())
    print(f"{count} of {len(others)} equal to the bit")
    return int(count < len(others))


if __name__ == "__main__":
    sys.exit(main())
