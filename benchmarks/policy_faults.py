"""Plants faults in contracts of policies and writes down what `surefoot policy check` names.

    python -m benchmarks.policy_faults NAME=CONTRACT ... [--robot g1] [--out docs/results/policy-faults.csv]

Weights are none of this repository: CONTRACT is a file or folder of yours. Rows of other names stay in the file.
"""

import argparse
import csv
from collections.abc import Iterator
from pathlib import Path

from surefoot.models.types import RobotDescription
from surefoot.scenarios.file.schema import RobotSettings
from surefoot.scenarios.policy.check import check
from surefoot.scenarios.policy.contract import Contract
from surefoot.scenarios.policy.files import read
from surefoot.scenarios.policy.mends import changed_terms, depths, reordered, scaled, times
from surefoot.scenarios.record.provenance import versions
from surefoot.scenarios.setup.robot.robots import describe

HEADS = ("policy", "planted", "up [s]", "wanted", "named", "by")
OUT = Path(__file__).parents[1] / "docs" / "results" / "policy-faults.csv"


def planted(contract: Contract, robot: RobotDescription) -> Iterator[tuple[str, str, Contract]]:
    """Ten faults, each with the name under which it is to be found; a history backward where there is one."""
    names = list(contract.joints)

    def swapped(one: str, other: str) -> Contract:
        i, j = (next(k for k, name in enumerate(names) if name.startswith(f"left_{part}")) for part in (one, other))
        order = list(names)
        order[i], order[j] = order[j], order[i]
        return reordered(contract, order)

    def with_(**keys: object) -> Contract:
        return contract.model_copy(update=keys)

    def acting(factor: float) -> Contract:
        return with_(action=contract.action.model_copy(update={"scale": times(contract.action.scale, factor)}))

    yield "", "nothing", contract
    yield "joint order", "knee and ankle changed", swapped("knee", "ankle_pitch")
    yield "joint order", "hip pitch and roll changed", swapped("hip_pitch", "hip_roll")
    kept = [name for name in robot.joint_names if name in names]
    broad = sorted(kept, key=lambda name: (depths(robot)[name], kept.index(name)))
    yield "joint order", "another simulator's order", reordered(contract, broad if kept == names else kept)
    yield "sign or scale of actions", "twice the action scale", acting(2.0)
    yield "sign or scale of actions", "the other sign of actions", acting(-1.0)
    soft = with_(stiffness=times(contract.stiffness, 0.2), damping=times(contract.damping, 0.2))
    yield "gains", "a fifth of the gains", soft
    yield "rate", "four times the rate", with_(rate=4.0 * contract.rate)
    history = contract.history
    if max([term.history or history.length for term in contract.observations], default=1) > 1:
        order = "newest_first" if history.order == "oldest_first" else "oldest_first"
        yield "history backward", "history backward", with_(history=history.model_copy(update={"order": order}))
    yield "frame or sign of a sense", "gravity upward", changed_terms(contract, scaled("gravity", -1.0))
    bare = contract.action.model_copy(update={"offset": None})
    yield "default posture", "no default posture", with_(default=0.0, action=bare)
    yield "unit of the command", "command in degrees", changed_terms(contract, scaled("command", 57.2958))


def rows_of(name: str, path: Path, robot: RobotDescription) -> Iterator[dict[str, str]]:
    """Rows on each fault that is planted in a contract, with what is named of it."""
    files = read(path, robot.joint_names)
    for fault, what, contract in planted(files.contract, robot):
        found = check(contract, files.network, robot)
        named = "" if found.cause is None else found.cause.fault.name
        mend = "" if found.cause is None else found.cause.change
        up = f"{found.given.stood:.2f} of {found.given.lasted:.2f}"
        yield dict(zip(HEADS, (name, what, up, fault, named, mend), strict=True))


def main() -> None:
    """Plant, check, and write down."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.policy_faults", description=__doc__)
    parser.add_argument("policies", nargs="+", metavar="NAME=CONTRACT")
    parser.add_argument("--robot", default="g1")
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    robot = describe(options.robot, RobotSettings())
    kept = []
    if options.out.is_file():
        with options.out.open(encoding="utf-8") as file:
            kept = list(csv.DictReader(line for line in file if not line.startswith("# ")))
    for given in options.policies:
        name, _, path = given.partition("=")
        kept = [row for row in kept if row["policy"] != name]
        for row in rows_of(name, Path(path), robot):
            kept.append(row)
            print(*row.values(), sep=" | ", flush=True)
            with options.out.open("w", encoding="utf-8", newline="") as file:
                code = versions()
                file.write("# python -m benchmarks.policy_faults NAME=CONTRACT\n")
                file.write(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
                writer = csv.DictWriter(file, HEADS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(kept)


if __name__ == "__main__":
    main()
