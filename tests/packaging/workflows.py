"""Runs the steps of a workflow as its server would: in a clone, with the environment of the server and nothing else.

    python tests/packaging/workflows.py github|gitlab dist/surefoot-*.whl

makes a repository with `surefoot new --ci` of a wheel that pip installs into an empty environment, and runs its steps
there: as they are, after a change that moves the walk, and in a pull request.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import venv
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

ME = ("-c", "user.name=me", "-c", "user.email=me@localhost")

STUBS = {
    "sudo": 'echo "sudo $*" >> "$CALLS"',
    "apt-get": 'echo "apt-get $*" >> "$CALLS"',
    "gh": 'echo "gh $*" >> "$CALLS"',
    "curl": 'echo "curl $*" >> "$CALLS"',
}
"""Programs of the servers' machines, which note that they were called."""


@dataclass
class Job:
    """A job that was run.

    Attributes:
        steps: names or commands of the steps that were run, with their exit codes.
        output: of all of them.
        failed: whether the job is red.
    """

    steps: dict[str, int] = field(default_factory=dict)
    output: str = ""
    failed: bool = False


class Origin:
    """A repository on a server, and clones of it.

    Args:
        folder: for all of it.
        programs: folder of `surefoot`, `python` and perhaps `pip`.
        pip: whether pip is called; where not, a call is noted.
    """

    def __init__(self, folder: Path, programs: Path, pip: bool = False) -> None:
        self.folder, self.bare, self.work = folder, folder / "origin.git", folder / "work"
        self._clones, self.calls = 0, folder / "calls.txt"
        stubs = {**STUBS, **({} if pip else {"pip": 'echo "pip $*" >> "$CALLS"'})}
        bin_ = folder / "bin"
        bin_.mkdir(parents=True)
        for name, text in stubs.items():
            (bin_ / name).write_text(f"#!/bin/sh\n{text}\n")
            (bin_ / name).chmod(0o755)
        (folder / "home").mkdir()
        self.environment = {
            "PATH": os.pathsep.join([str(bin_), str(programs), "/usr/bin", "/bin"]),
            "HOME": str(folder / "home"),
            "CALLS": str(self.calls),
            "CI": "true",
        }
        self.git("init", "-q", "--bare", "-b", "main", str(self.bare), at=folder)
        self.git("clone", "-q", str(self.bare), str(self.work), at=folder)
        self.git("switch", "-q", "-c", "main")

    def git(self, *words: str, at: Path | None = None) -> str:
        """Give git a command."""
        command = ["git", *ME, *words]
        done = subprocess.run(command, cwd=at or self.work, env=self.environment, capture_output=True, text=True)
        assert done.returncode == 0, f"{command}: {done.stderr}"
        return done.stdout

    def commit(self, message: str, branch: str = "main") -> None:
        """Commit all that is in the clone one works in, and push it."""
        self.git("add", "--all")
        self.git("commit", "-q", "-m", message)
        self.git("push", "-q", "origin", f"HEAD:{branch}")

    def surefoot(self, *words: str) -> str:
        """Give a command where one works."""
        command = ["surefoot", *words]
        return subprocess.run(
            command, cwd=self.work, env=self.environment, capture_output=True, text=True, check=True
        ).stdout

    def clone(self, branch: str) -> Path:
        """A clone as a server makes it."""
        self._clones += 1
        place = self.folder / f"clone-{self._clones}"
        self.git("clone", "-q", "--depth", "1", "--branch", branch, f"file://{self.bare}", str(place), at=self.folder)
        return place

    def github(self, event: str, branch: str = "main") -> tuple[Job, Path]:
        """Run the workflow of GitHub for an event."""
        place, job = self.clone(branch), Job()
        workflow = yaml.safe_load((place / ".github" / "workflows" / "walks.yml").read_text())
        context = {
            "github.event_name": event,
            "github.ref": f"refs/heads/{branch}",
            "github.token": "token",
            "github.event.pull_request.number": "7",
        }
        environment = {
            **self.environment,
            "GITHUB_EVENT_NAME": event,
            "GITHUB_SHA": self.git("rev-parse", "HEAD", at=place).strip(),
            "GITHUB_SERVER_URL": "https://github.com",
            "GITHUB_REPOSITORY": "me/mine",
            "GITHUB_STEP_SUMMARY": str(place / "summary.md"),
            **_filled(workflow["env"], context),
        }
        (described,) = workflow["jobs"].values()
        for step in described["steps"]:
            if not _holds(step.get("if", ""), context, job.failed):
                continue
            code = self._step(step, place, {**environment, **_filled(step.get("env", {}), context)}, job)
            job.failed |= bool(code) and not step.get("continue-on-error", False)
        return job, place

    def _step(self, step: Mapping[str, Any], place: Path, environment: Mapping[str, str], job: Job) -> int:
        name = step.get("name") or step.get("run") or step["uses"]
        if "run" in step:
            code = self.run(step["run"], place, environment, job)
        else:
            code = 0
            if step["uses"].startswith("actions/upload-artifact"):
                paths = [path for path in step["with"]["path"].split("\n") if path]
                code = int(not any((place / path).exists() for path in paths))
        job.steps[name] = code
        return code

    def gitlab(self, branch: str = "main", **more: str) -> tuple[Job, Path]:
        """Run the job of GitLab."""
        place, job = self.clone(branch), Job()
        (described,) = yaml.safe_load((place / ".gitlab-ci.yml").read_text()).values()
        environment = {
            **self.environment,
            "CI_PROJECT_DIR": str(place),
            "CI_COMMIT_SHA": self.git("rev-parse", "HEAD", at=place).strip(),
            "CI_DEFAULT_BRANCH": "main",
            "CI_JOB_URL": "https://gitlab.com/me/mine/-/jobs/7",
            "CI_API_V4_URL": "https://gitlab.com/api/v4",
            "CI_PROJECT_ID": "9",
            **({"CI_COMMIT_BRANCH": branch} if branch == "main" else {"CI_MERGE_REQUEST_IID": "3"}),
            **{name: os.path.expandvars(value) for name, value in described["variables"].items()},
            **more,
        }
        for name in ("CI_JOB_TOKEN", "CI_SERVER_PROTOCOL", "CI_SERVER_HOST", "CI_PROJECT_PATH"):
            environment.setdefault(name, name.lower())
        address = "{CI_SERVER_PROTOCOL}://oauth2:{CI_JOB_TOKEN}@{CI_SERVER_HOST}/{CI_PROJECT_PATH}.git".format(
            **environment
        )
        self.git("config", f"url.file://{self.bare}.insteadOf", address, at=place)
        job.failed = self.run("\n".join(map(_group, described["script"])), place, environment, job) != 0
        job.steps["script"] = int(job.failed)
        job.steps["after_script"] = self.run("\n".join(map(_group, described["after_script"])), place, environment, job)
        return job, place

    def run(self, script: str, place: Path, environment: Mapping[str, str], job: Job) -> int:
        """Run a script as a step does, by a shell that ends at the first command that fails."""
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
        done = subprocess.run(command, cwd=place, env=dict(environment), capture_output=True, text=True)
        job.output += f"$ {script}\n{done.stdout}{done.stderr}"
        return done.returncode

    def called(self) -> list[str]:
        """Calls of the programs of the server's machine, in order."""
        return self.calls.read_text().splitlines() if self.calls.exists() else []

    def files(self, branch: str) -> set[str]:
        """Files of a branch on the server."""
        return set(self.git("ls-tree", "-r", "--name-only", branch, at=self.bare).split())


def _group(command: str) -> str:
    return command.rstrip("\n")


def _filled(values: Mapping[str, Any], context: Mapping[str, str]) -> dict[str, str]:
    """Values with the expressions in them as they are."""
    return {
        name: re.sub(r"\$\{\{ (\S+) \}\}", lambda found: context[found[1]], str(text)) for name, text in values.items()
    }


def _holds(condition: str, context: Mapping[str, str], failed: bool) -> bool:
    """Return true if a step is run; one without a condition is where none has failed."""
    parts = condition.split(" && ") if condition else []
    if not any("always()" in part or "failure()" in part for part in parts) and failed:
        return False
    for part in parts:
        if part == "failure()" and not failed:
            return False
        if compared := re.fullmatch(r"(\S+) == '(.*)'", part):
            if context[compared[1]] != compared[2]:
                return False
        elif part not in ("always()", "failure()"):
            raise ValueError(f"{part}: not known here")
    return True


def main(kind: str, wheel: Path) -> None:
    """Try a workflow with a wheel in an empty environment."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "python")
        venv.create(place, with_pip=True)
        index = {
            name: value
            for name, value in os.environ.items()
            if name.startswith(("PIP_", "HTTP", "http", "SSL", "no_proxy", "NO_PROXY"))
        }
        origin = Origin(Path(folder, "server"), place / "bin", pip=True)
        origin.environment |= index
        config = Path.home() / ".config" / "pip"
        if config.exists():
            shutil.copytree(config, Path(origin.environment["HOME"], ".config", "pip"))
        subprocess.run([place / "bin" / "pip", "install", "-q", wheel.resolve()], check=True)
        print(origin.surefoot("new", "--ci", kind))
        path = origin.work / (".github/workflows/walks.yml" if kind == "github" else ".gitlab-ci.yml")
        path.write_text(re.sub(r'SUREFOOT: "[^"]*"', f'SUREFOOT: "{wheel.resolve()}"', path.read_text()))
        print(origin.surefoot("check", "walks", "--update"))
        (origin.work / ".gitignore").write_text("runs/\n")
        origin.commit("First walk")
        subprocess.run([place / "bin" / "pip", "uninstall", "-qy", "surefoot", "mujoco", "numpy"], check=True)
        for words, change in (("as it is", ""), ("longer steps", "step_length: 0.22")):
            if change:
                walk = origin.work / "walks" / "first-walk.yaml"
                walk.write_text(walk.read_text().replace("step_length: 0.2", change))
                origin.commit(words, "change")
            branch, event = ("change", "pull_request") if change else ("main", "push")
            job, clone = origin.github(event, branch) if kind == "github" else origin.gitlab(branch)
            print(f"== {words}: {'red' if job.failed else 'green'} {job.steps}\n{job.output}")
            print((clone / "check.md").read_text())
        print(sorted(origin.files("surefoot-history")))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
