"""Compiles the kernels when the package is installed or its wheel is built, see `surefoot/native`.

A wheel with the library in it is tied to the platform, on Linux to a version of glibc, and to no version of Python.
Where there is no compiler the
package is whole without it, and runs on plain Python.
"""

import importlib.util
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelHook(BuildHookInterface):
    """Makes the library beside its sources and takes it along."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling; the library of the same sources is not made again."""
        spec = importlib.util.spec_from_file_location("kernel_build", Path(self.root, "surefoot", "native", "build.py"))
        assert spec is not None
        assert spec.loader is not None
        native = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(native)
        why = "" if native.is_built() else native.build()
        if why:
            self.app.display_warning(f"Surefoot runs on plain Python, slower, since there is {why}")
            return
        build_data["artifacts"].append(f"/surefoot/native/{native.LIBRARY.name}")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{native.platform_tag()}"
