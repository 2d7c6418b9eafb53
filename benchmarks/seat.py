"""Cost of the seat of a policy, beside its network: CPU time of a run, in turns with the same run from kept commands.

    python -m benchmarks.seat CONTRACT ... [--robot g1]

The network runs in both, on the same inputs, and its time is counted in neither. Its weights push the simulator's
memory out of the processor's caches, which slows the rest of a run by about a thirtieth, whoever asks the network.

Weights are none of this repository: CONTRACT is a file or folder of yours. The state is the truth, so that no estimator
is counted: a run has one with or without a policy.
"""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from surefoot.joints import JointCommand
from surefoot.scenarios.run.run import one_thread, open_log
from surefoot.scenarios.run.seat import seat_loop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import Walk, resolve

SETTINGS = ("duration=8", "sensing.source=truth")
ROUNDS = 7


def run(walk: Walk, changed: Callable[[Any], None] = lambda _: None) -> float:
    """CPU time of the ticks of a run, whose walker is changed before it begins [s]."""
    with TemporaryDirectory() as folder, open_log(Path(folder) / "log.mcap", walk) as writer:
        loop = seat_loop(walk, writer)
        changed(loop.walker)
        begin = time.thread_time()
        while not loop.done and loop.step():
            pass
        return time.thread_time() - begin


class Deciding:
    """A policy as it is, whose commands and inputs are kept, and whose network is timed where it runs.

    Attributes:
        commands: of every tick.
        inputs: of the network, by the tick that decides on them.
        inference: CPU time of the network [s].
    """

    def __init__(self) -> None:
        self.commands: list[JointCommand] = []
        self.inputs: dict[int, Any] = {}
        self.inference = 0.0

    def __call__(self, walker: Any) -> None:
        """Listen to the policy of a walker."""
        mind, step, infer = walker.mind, walker.mind.step, walker.mind.network.run

        def stepped(*given: Any) -> JointCommand:
            command: JointCommand = step(*given)
            self.commands.append(command)
            return command

        def inferred(given: Any) -> Any:
            self.inputs[len(self.commands)] = given
            begin = time.thread_time()
            found = infer(given)
            self.inference += time.thread_time() - begin
            return found

        mind.step, mind.network.run = stepped, inferred


class Playing:
    """A walker that gives kept commands, tick by tick, in the place of what its policy decides.

    Args:
        kept: of a run as it is.

    Attributes:
        inference: CPU time of the network, whose outputs nobody reads [s].
    """

    def __init__(self, kept: Deciding) -> None:
        self._kept = kept
        self.inference = 0.0

    def __call__(self, walker: Any) -> None:
        """Take the place of a walker's policy."""
        ticks, infer = iter(enumerate(self._kept.commands)), walker.mind.network.run

        def stepped(*_: Any) -> JointCommand:
            tick, command = next(ticks)
            if tick in self._kept.inputs:
                begin = time.thread_time()
                infer(self._kept.inputs[tick])
                self.inference += time.thread_time() - begin
            return command

        walker.mind.step = stepped


def report(policy: str, robot: str) -> str:
    """A line on a policy, by the least times of all rounds."""
    walk = resolve(load("walk-level", [f"robot={robot}", f"controller.policy={policy}", *SETTINGS]))
    least = np.full(3, np.inf)
    for _ in range(ROUNDS):
        deciding = Deciding()
        whole = run(walk, deciding)
        playing = Playing(deciding)
        played = run(walk, playing)
        times = (whole - deciding.inference, played - playing.inference, deciding.inference)
        least = np.minimum(least, times)
    rest, played, inference = least.tolist()
    what = f"{rest:.3f} s beside the network's {inference:.3f} s, of which the seat {rest - played:.3f} s"
    return f"{policy}: {what}, {(rest - played) / rest:.1%}"


def main() -> None:
    """Print a line on each policy."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.seat", description=__doc__)
    parser.add_argument("policies", nargs="+", metavar="CONTRACT")
    parser.add_argument("--robot", default="g1")
    options = parser.parse_args()
    with one_thread():
        for policy in options.policies:
            print(report(policy, options.robot), flush=True)


if __name__ == "__main__":
    main()
