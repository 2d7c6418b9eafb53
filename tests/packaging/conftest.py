"""Fixtures: the distributions of this tree, the wheel as an installer unpacks it, and packages of strangers."""

import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from sites import Site

from surefoot.models.registry import ROBOTS
from surefoot.native import modules
from surefoot.planner.laws.profiles import PROFILES
from surefoot.scenarios.catalogue import SCENARIOS
from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.cli.files import FILES
from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.judge.metrics import METRICS
from surefoot.scenarios.run.full import PLANTS
from surefoot.scenarios.run.sensing import ESTIMATORS
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.wbc.tasks import TASKS

ROOT = Path(__file__).parents[2]


def build(tree: Path, folder: Path, *targets: str) -> list[Path]:
    """Build distributions of a tree with the backend itself, which needs nothing that is not installed."""
    command = [sys.executable, "-m", "hatchling", "build", "-d", str(folder), *targets]
    subprocess.run(command, cwd=tree, check=True, capture_output=True, timeout=60)
    return sorted(folder.iterdir())


@pytest.fixture(scope="session")
def distributions(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Wheel and sdist."""
    wheel, sdist = build(ROOT, tmp_path_factory.mktemp("dist"))
    return wheel, sdist


def _wheel_of(sdist: Path, factory: pytest.TempPathFactory, compiled: bool) -> Path:
    folder = factory.mktemp("sdist")
    shutil.unpack_archive(sdist, folder)
    (tree,) = folder.iterdir()
    if compiled:  # by this tree: what is of the same sources is not compiled again, which takes minutes
        for path in modules.built():
            if (ROOT / path).exists():
                shutil.copy(ROOT / path, tree / path)
    (wheel,) = build(tree, factory.mktemp("again"), "-t", "wheel")
    return wheel


@pytest.fixture(scope="session")
def wheel_from_sdist(distributions: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel that an installer makes of the sdist."""
    return _wheel_of(distributions[1], tmp_path_factory, compiled=True)


@pytest.fixture(scope="session")
def wheel_without_compiler(distributions: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of a machine whose compiler fails."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CC", "false")
        return _wheel_of(distributions[1], tmp_path_factory, compiled=False)


@pytest.fixture(scope="session")
def unpacked(distributions: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder for the path that holds what the wheel installs."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(distributions[0]) as archive:
        archive.extractall(folder)
    return folder


class Answer(NamedTuple):
    """Exit code and output of a command."""

    code: int
    out: str
    err: str


@pytest.fixture
def site(tmp_path: Path) -> Callable[[str], Site]:
    """Make an empty distribution of that name."""
    return lambda name: Site(tmp_path / name, name)


@pytest.fixture
def importing() -> Iterator[None]:
    """Forget afterwards what was imported of strangers."""
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if name.startswith(("my_package", "broken")):
            del sys.modules[name]
    for registry in (KINDS, INSTRUMENTS, PROFILES, ESTIMATORS, PLANTS, TASKS, ROBOTS, METRICS, SCENARIOS, FILES):
        registry.forget()


@pytest.fixture
def at_hand(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], importing: None
) -> Callable[..., Answer]:
    """Give a command in this process, as a user who has distributions on the path."""

    def give(*arguments: str, sites: Iterable[Site] = ()) -> Answer:
        for made in sites:
            monkeypatch.syspath_prepend(str(made.folder))
        with pytest.raises(SystemExit) as ended:
            cli.program([*arguments])
        said = capsys.readouterr()
        return Answer(int(ended.value.code or 0), said.out, said.err)

    return give


@pytest.fixture
def documented(site: Callable[[str], Site]) -> Site:
    """The package that docs/extending.md makes: its files and entry points as they stand there."""
    page = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
    made = site("my-package")
    for path, text in re.findall(r"(?s)```(?:python|yaml)\n# (my_package/\S+)\n(.*?)```", page):
        made.write(path, text)
    for table in re.findall(r"(?s)```toml\n(.*?)```", page):
        for group, points in tomllib.loads(table)["project"]["entry-points"].items():
            made.register(group, **points)
    return made


@pytest.fixture
def disguised(site: Callable[[str], Site]) -> Site:
    """A package with a robot whose names tell nothing."""
    made = site("disguised")
    shutil.copy(Path(__file__).with_name("disguised.py"), made.folder)
    made.register("surefoot.robots", disguised="disguised:DISGUISED")
    return made
