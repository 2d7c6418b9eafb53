"""Results that a change can have touched, and the commands that make them again.

    python docs/results.py                          # fresh, stale or unknown, each with the time that it took last
    python docs/results.py --run [NAME]...          # make again what is stale, or what is named
    python docs/results.py --run --background       # the same in a process that goes on alone

Digests of what a result is made of are kept when it is made, in docs/results/made.json. A result is fresh only while
they are the same: where none were kept it is unknown. A run that is interrupted goes on by the same command: results
that were made are kept, and campaigns have journals of their own. At the end the tables of the pages are written.
"""

import argparse
import fcntl
import json
import os
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import made_of
import yaml

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent
OUT = Path("runs") / "results"
KEPT = FOLDER / "results" / "made.json"

RUN = ("surefoot.studies.campaigns.sweep", "surefoot.scenarios.run.run", "surefoot.scenarios.judge.verdict")
"""Sources that a campaign follows from."""

CHECK = ("surefoot.scenarios.check.command", "surefoot.scenarios.run.run", "surefoot.scenarios.judge.verdict")
"""Sources that a baseline follows from."""

AFTER = ("python docs/reference.py", "python docs/texts.py")
"""Write tables, numbers and texts from the results."""


@dataclass(frozen=True)
class Result:
    """A result that is kept.

    Attributes:
        name: of it.
        commands: that make and keep it, one after the other.
        code: modules or scripts whose imports it follows from.
        inputs: files or folders beside those, relative to the root.
        writes: what is kept, relative to the root.
        needs: what making it needs that is not here; empty where nothing.
        good: exit codes of commands that have made it.
    """

    name: str
    commands: tuple[str, ...]
    code: tuple[str, ...] = RUN
    inputs: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    needs: str = ""
    good: tuple[int, ...] = (0,)

    def digests(self, root: Path = ROOT) -> Mapping[str, str]:
        """Digests of all that it is made of: code, inputs with the command, and versions."""
        files = [path for one in self.inputs for path in _files(root / one)]
        words = [*self.commands, *(path.read_text(encoding="utf-8") for path in files if path.suffix == ".yaml")]
        inputs = {*(path.relative_to(root) for path in files), *made_of.data(words, root)}
        return {
            "code": made_of.digest(made_of.code(self.code, root), root),
            "inputs": made_of.digest(inputs, root),
            "command": made_of.of_text("\n".join(self.commands)),
            "versions": made_of.of_text(made_of.versions(root)),
        }


def _files(path: Path) -> Iterator[Path]:
    if not path.exists():
        raise SystemExit(f"{path} is not there; mend docs/made.yaml")
    yield from sorted(one for one in path.rglob("*") if one.is_file()) if path.is_dir() else (path,)


def results(root: Path = ROOT) -> dict[str, Result]:
    """All results by name: campaigns of `measured`, those of made.yaml, and the baselines of the catalogue."""
    from measured import MADE

    found = {}
    for name, made in MADE.items():
        shipped = root / "studies" / "campaigns" / "campaigns" / f"{made.campaign}.yaml"
        campaign = shipped.relative_to(root).as_posix() if shipped.exists() else made.campaign
        commands = (f"{made.command} --out {OUT / name}", f"python docs/measured.py {name} {OUT / name}")
        found[name] = Result(name, commands, (*RUN, "docs/measured.py"), (campaign,), (f"docs/results/{name}.csv",))
    for name, said in yaml.safe_load((root / "docs" / "made.yaml").read_text(encoding="utf-8")).items():
        found[name] = _of(name, said)
    for path in sorted((root / "scenarios" / "baselines").glob("*.baseline.yaml")):
        scenario = path.name.removesuffix(".baseline.yaml")
        command = f"surefoot check {scenario} --update --out {OUT / 'check' / scenario} --force"
        writes = (path.relative_to(root).as_posix(),)
        found[f"baseline-{scenario}"] = Result(f"baseline-{scenario}", (command,), CHECK, writes=writes)
    return found


def _of(name: str, said: Mapping[str, Any]) -> Result:
    lists = {key: tuple(said[key]) for key in ("code", "inputs", "writes", "good") if key in said}
    return Result(name, (said["command"],), needs=said.get("needs", ""), **lists)


def kept(path: Path = KEPT) -> dict[str, Any]:
    """Record of results when they were made, by their name: digests, and the time it took [s]."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def state(result: Result, records: Mapping[str, Any], root: Path = ROOT) -> str:
    """Fresh; stale, and by what; or unknown, where nobody has kept what it is made of, or what is kept was edited."""
    if result.name not in records:
        return "unknown"
    record, now = records[result.name], result.digests(root)
    moved = [what for what, digest in now.items() if record["of"].get(what) != digest]
    if moved:
        return f"stale: {', '.join(moved)}"
    written = made_of.digest((Path(path) for path in result.writes if (root / path).exists()), root)
    return "fresh" if record["written"] == written else "unknown: it was written since by something else"


def make(result: Result, path: Path = KEPT, root: Path = ROOT) -> str:
    """Make a result again and keep what it is made of; the sentence says how that ended.

    It is not kept as fresh where a command fails, or where what it is made of changed meanwhile.
    """
    before, begun = result.digests(root), time.monotonic()
    for command in result.commands:
        done = subprocess.run(command, shell=True, cwd=root, env=_environment(), check=False)
        if done.returncode not in result.good:
            return f"{result.name}: '{command}' ended with {done.returncode}; it is not made"
    if result.digests(root) != before:
        return f"{result.name}: its code or inputs were changed while it was made; make it again"
    written = made_of.digest((Path(one) for one in result.writes), root)
    took = round(time.monotonic() - begun)
    records = kept(path) | {result.name: {"of": before, "written": written, "seconds": took}}
    scratch = path.with_suffix(".tmp")
    scratch.write_text(json.dumps(dict(sorted(records.items())), indent=1) + "\n", encoding="utf-8")
    scratch.replace(path)
    return f"{result.name}: made in {took} s"


def _environment() -> dict[str, str]:
    """Commands are those of this environment."""
    return {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}


def make_all(chosen: Iterable[Result], path: Path = KEPT, root: Path = ROOT, after: Iterable[str] = AFTER) -> int:
    """Make results one after the other, then what follows from them; the number that could not be made.

    A second one of these waits for nothing: it says that one runs.
    """
    (root / OUT).mkdir(parents=True, exist_ok=True)
    with (root / OUT / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SystemExit(f"results are being made already; see {OUT / 'log.txt'}") from None
        failed, some = 0, False
        for result in chosen:
            if state(result, kept(path), root) == "fresh":
                print(f"{result.name}: fresh", flush=True)
                continue
            said, some = make(result, path, root), True
            failed += ": made in " not in said
            print(said, flush=True)
        for command in after if some else ():
            failed += subprocess.run(command, shell=True, cwd=root, env=_environment(), check=False).returncode != 0
    return failed


def table(every: Mapping[str, Result], records: Mapping[str, Any], root: Path = ROOT) -> Iterator[str]:
    """A line for each result: its state, the time that it took last, and what makes it."""
    for name, result in every.items():
        seconds = records.get(name, {}).get("seconds")
        took = "time not known" if seconds is None else f"{seconds / 60.0:.0f} min"
        by_hand = f"; needs {result.needs}" if result.needs else ""
        yield f"{name}: {state(result, records, root)}; {took}; {' && '.join(result.commands)}{by_hand}"


def main() -> int:
    """List results, or make them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of results; by default those that are stale")
    parser.add_argument("--run", action="store_true", help="make them")
    parser.add_argument("--unknown", action="store_true", help="also those of which nothing is known")
    parser.add_argument("--background", action="store_true", help="make them in a process that goes on alone")
    options = parser.parse_args()
    every, records = results(), kept()
    if unknown := [name for name in options.names if name not in every]:
        parser.error(f"there is no result {', '.join(unknown)}; without arguments all are listed")
    if not options.run:
        print("\n".join(table({name: every[name] for name in options.names or every}, records)))
        return 0
    wanted = ("stale", "unknown") if options.unknown else ("stale",)
    names = options.names or [name for name in every if state(every[name], records).startswith(wanted)]
    chosen = [every[name] for name in names if not every[name].needs]
    for name in names:
        if every[name].needs:
            print(f"{name} is not made: it needs {every[name].needs}")
    if not chosen:
        print("nothing is stale; give names, or --unknown for those of which nothing is known")
        return 0
    if options.background:
        return _in_background([result.name for result in chosen])
    return 1 if make_all(chosen) else 0


def _in_background(names: list[str]) -> int:
    (ROOT / OUT).mkdir(parents=True, exist_ok=True)
    command = [sys.executable, __file__, "--run", *names]
    with (ROOT / OUT / "log.txt").open("a") as log:
        subprocess.Popen(command, cwd=ROOT, stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True)
    print(f"{len(names)} results are made; {OUT / 'log.txt'} says how far it is, '{shlex.join(command[1:])}' goes on")
    return 0


if __name__ == "__main__":
    sys.exit(main())
