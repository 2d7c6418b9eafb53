"""The installed distribution: its version, and what installs an extra of it."""

import json
import shutil
import sys
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from shlex import quote

try:
    __version__ = version("surefoot")
except PackageNotFoundError:  # a source tree on the path that was never installed
    __version__ = "0+unknown"


def install_command(extra: str) -> str:
    """Command that installs an extra of Surefoot where it came from: its clone, what pip was given, or an index."""
    here, clone = Path(sys.executable).parent, Path(__file__).parents[1]
    pip = "pip" if Path(shutil.which("pip") or "").parent == here else f"{quote(sys.executable)} -m pip"
    if (clone / "constraints.txt").is_file():
        folder = Path() if Path.cwd() == clone else clone
        return f"{pip} install -c {quote(str(folder / 'constraints.txt'))} -e {quote(f'{folder}[{extra}]')}"
    source = _installed_from()
    return f"{pip} install {quote(f'surefoot[{extra}] @ {source}' if source else f'surefoot[{extra}]')}"


def _installed_from() -> str:
    """Address of the archive, folder or repository that pip was given; empty when it came from an index."""
    try:
        origin = json.loads(distribution("surefoot").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return ""
    repository = origin.get("vcs_info", {}).get("vcs")
    return f"{repository}+{origin['url']}" if repository else str(origin.get("url", ""))
