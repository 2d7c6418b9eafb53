"""Compiles the modules that hold the laws when the package is installed or its wheel is built.

Such a wheel is of one version of Python and one platform, on Linux of a version of glibc. Where nothing can be compiled
the package is whole without, and the same modules run interpreted.
"""

import importlib.util
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CompiledModules(BuildHookInterface):
    """Makes the extension modules beside their sources and takes them along."""

    def _modules(self) -> Any:
        """`surefoot.native.modules`, by its path: nothing is installed yet."""
        path = Path(self.root, "surefoot", "native", "modules.py")
        spec = importlib.util.spec_from_file_location("surefoot_modules", path)
        assert spec is not None
        assert spec.loader is not None
        modules = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = modules
        spec.loader.exec_module(modules)
        return modules

    def dependencies(self) -> list[str]:
        """Needs of the build beside Cython: a C compiler as a wheel where the machine has none."""
        return [] if self._modules().has_compiler() else ["ziglang>=0.15"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling; what is of the same sources is not compiled again."""
        modules = self._modules()
        try:
            modules.build(modules.stale())
        except modules.NothingCompilesError as error:
            modules.interpret(str(error))
            self.app.display_warning(f"Surefoot runs interpreted, slower: {error}")
            return
        build_data["artifacts"] += [f"/{path.as_posix()}" for path in modules.built()]
        build_data["pure_python"] = False
        build_data["tag"] = modules.tag()
