"""A workflow for CI to start from: ``surefoot new --ci``, written from the files of `ci`."""

import platform
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.output import reason
from surefoot.scenarios.record.provenance import ABSENT, PACKAGES, relevant_versions

WORKFLOWS = {"github": ".github/workflows/walks.yml", "gitlab": ".gitlab-ci.yml"}
"""Paths of the workflows in a repository, by the kind of server."""

_WALKS = "walks"
"""Folder of the scenarios."""


def add_ci(server: str, place: Path, surefoot: str = "") -> tuple[Path, ...]:
    """Write a workflow that checks the scenarios of the folder ``walks``; a first one, where there is no such folder.

    Args:
        server: kind of the CI server, github or gitlab.
        place: folder of the repository.
        surefoot: what pip shall install; by default this version.

    Returns:
        The files that were written.

    Raises:
        ScenarioError: there is a workflow already, or the folder cannot be written.
    """
    workflow = place / WORKFLOWS[server]
    versions = relevant_versions()
    minor = ".".join(platform.python_version_tuple()[:2])
    text = _template(f"{server}.yml").replace("@SUREFOOT@", surefoot or f"surefoot=={versions['surefoot']}")
    texts = {workflow: text.replace("@PYTHON@", minor)}
    if not (place / _WALKS / "constraints.txt").exists():
        texts[place / _WALKS / "constraints.txt"] = _constraints(versions)
    if not any((place / _WALKS).glob("*.yaml")):
        texts[place / _WALKS / "first-walk.yaml"] = _template("first-walk.yaml")
    try:
        for path, content in texts.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("x", encoding="utf-8") as file:
                file.write(content)
    except FileExistsError:
        raise ScenarioError([f"{workflow}: is there already; remove it, or take another folder with --out"]) from None
    except OSError as error:
        raise ScenarioError([f"{place}: cannot be written, {reason(error)}; take another folder with --out"]) from None
    return tuple(texts)


def _template(name: str) -> str:
    return (files(__package__) / "ci" / f"{name}.tmpl").read_text(encoding="utf-8")


def _constraints(versions: Mapping[str, str]) -> str:
    """Versions of all that a walk depends on, as they are here."""
    head = "# Versions with which the baselines are made; other ones walk the same within the tolerances at best.\n"
    pinned = (f"{name}=={versions[name]}" for name in PACKAGES if name != "surefoot" and versions[name] != ABSENT)
    return head + "".join(f"{line}\n" for line in pinned)
