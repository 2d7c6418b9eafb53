"""Compiled modules: made of their sources, known by them, made anew where these changed, and never needed."""

import ast
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from needs import COMPILER

from surefoot.native import modules

pytestmark = pytest.mark.unit

LAW = "import math\n\n\ndef law(x: float) -> float:\n    return math.sqrt(x) + 1.0\n"
TYPES = "cimport libc.math as math\n\ncpdef double law(double x) noexcept nogil\n"


@pytest.fixture
def bare(tmp_path):
    """A checkout with one law, in which nothing was compiled."""
    native = tmp_path / "surefoot" / "native"
    native.mkdir(parents=True)
    for name in ("__init__.py", "__main__.py", "modules.py"):
        shutil.copy(Path(modules.__file__).parent / name, native)
    (tmp_path / "surefoot" / "__init__.py").write_text("from surefoot.native import modules\n\nmodules.refresh()\n")
    (tmp_path / "surefoot" / "law.py").write_text(LAW)
    (tmp_path / "surefoot" / "law.pxd").write_text(TYPES)
    (tmp_path / "pyproject.toml").touch()
    return tmp_path


@pytest.fixture
def checkout(bare):
    """The same, with what all compiled modules have in common as it was made here, which takes seconds."""
    if modules.made():
        shutil.copy(modules.ROOT / modules.shared_path(), bare / modules.shared_path())
        (bare / modules.STAMP.relative_to(modules.ROOT)).write_text(json.dumps({"made": modules.made()}))
    return bare


def python(folder: Path, *command: str, code: int = 0, **changed: str) -> str:
    """Output of a program there, and then its errors."""
    environment = {**os.environ, "PYTHONPATH": str(folder), **changed}
    done = subprocess.run(
        [sys.executable, *command], env=environment, cwd=folder, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == code, done.stderr
    return done.stdout + done.stderr


ASK = "from surefoot.law import law; import surefoot.law; print(law(4.0), surefoot.law.__file__)"


def test_a_law_that_was_edited_is_compiled_anew(bare):
    COMPILER.or_skip()
    checkout = bare
    path = checkout / "surefoot" / f"law{modules.SUFFIX}"
    assert python(checkout, "-c", ASK) == f"3.0 {path}\n"
    first = path.stat().st_mtime_ns
    assert python(checkout, "-c", ASK) == f"3.0 {path}\n"
    assert path.stat().st_mtime_ns == first, "nothing had changed"
    (checkout / "surefoot" / "law.py").write_text(LAW.replace("1.0", "2.0"))
    assert python(checkout, "-c", ASK) == f"4.0 {path}\n"
    assert python(checkout, "-m", "surefoot.native").startswith("compiled: Cython 3.")
    assert python(checkout, "-m", "surefoot.native", "--interpreted").startswith("interpreted, slower: that was asked")
    assert python(checkout, "-c", ASK) == f"4.0 {checkout / 'surefoot' / 'law.py'}\n"
    assert not path.exists()


def test_a_module_that_is_gone_leaves_nothing_behind(checkout):
    COMPILER.or_skip()
    python(checkout, "-c", ASK)
    for end in (".py", ".pxd"):
        (checkout / "surefoot" / f"law{end}").rename(checkout / "surefoot" / f"other{end}")
    assert "No module named 'surefoot.law'" in python(checkout, "-c", ASK, code=1)
    there = sorted(path.name for path in (checkout / "surefoot").glob(f"*{modules.SUFFIX}"))
    assert there == [f"other{modules.SUFFIX}"]


def test_a_law_that_cannot_be_compiled_is_an_error_that_names_its_line(checkout):
    COMPILER.or_skip()
    (checkout / "surefoot" / "law.py").write_text(LAW.replace("math.sqrt(x)", "print(x) or x"))
    said = python(checkout, "-c", ASK, code=1)
    assert "surefoot/law.py:5" in said
    assert said.rstrip().endswith("Mend it, or run 'python -m surefoot.native --interpreted'")
    assert "surefoot/law.py:5" in python(checkout, "-m", "surefoot.native", code=1)
    assert python(checkout, "-m", "surefoot.native", "--interpreted").startswith("interpreted")
    assert "law.py" in python(checkout, "-c", "import surefoot.law as it; print(it.__file__)")


@pytest.mark.parametrize("compiler", ["false", "no-such-compiler", ""])
def test_without_a_compiler_the_same_file_is_interpreted_and_the_reason_is_kept(checkout, compiler):
    source = checkout / "surefoot" / "law.py"
    hidden = "import sys; sys.modules['ziglang'] = None; "
    assert python(checkout, "-c", hidden + ASK, CC=compiler) == f"3.0 {source}\n"
    tell = "from surefoot.native import modules; print(modules.missing(), modules.made())"
    assert "C compiler" in python(checkout, "-c", tell)


def test_without_headers_the_reason_names_them(monkeypatch, tmp_path):
    monkeypatch.setattr(sysconfig, "get_paths", lambda: {"include": str(tmp_path)})
    with pytest.raises(modules.NothingCompilesError, match=r"no headers of Python; install them, such as python3"):
        modules.build()


LACKING = {
    "Cython": """import importlib.util as util
real = util.find_spec
util.find_spec = lambda name, *rest: None if name == "Cython" else real(name, *rest)""",
    "compiler": "import os; os.environ['CC'] = 'no-such-compiler'; sys.modules['ziglang'] = None",
}
AGAIN = """
import sys
sys.argv = sys.orig_argv = ["surefoot.native"]
{lacking}
import runpy
runpy.run_module("surefoot.native", run_name="__main__")
"""


@pytest.mark.parametrize("lacking", LACKING)
def test_what_is_compiled_stays_so_where_nothing_can_be_compiled_until_it_is_edited(checkout, lacking):
    COMPILER.or_skip()
    path, again = checkout / "surefoot" / f"law{modules.SUFFIX}", AGAIN.format(lacking=LACKING[lacking])
    python(checkout, "-c", ASK)
    assert python(checkout, "-c", again).startswith("compiled: Cython 3.")
    assert python(checkout, "-c", ASK) == f"3.0 {path}\n"
    (checkout / "surefoot" / "law.py").write_text(LAW.replace("1.0", "2.0"))
    assert re.match(rf"interpreted, slower: there is no (C )?{lacking}", python(checkout, "-c", again))
    assert not path.exists()


def test_modules_of_one_name_in_two_folders_are_each_compiled_and_one_that_fails_is_named(checkout):
    COMPILER.or_skip()
    folder = checkout / "surefoot" / "folder"
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "law.py").write_text(LAW.replace("1.0", "2.0"))
    (folder / "law.pxd").write_text(TYPES)
    both = "from surefoot import law; from surefoot.folder import law as other; print(law.law(4.0), other.law(4.0))"
    assert python(checkout, "-c", both) == "3.0 4.0\n"
    assert [path.stem.split(".")[0] for path in folder.glob(f"*{modules.SUFFIX}")].count("law") == 1
    (folder / "law.py").write_text(LAW.replace("math.sqrt(x)", "print(x) or x"))
    said = python(checkout, "-m", "surefoot.native", code=1).splitlines()[: modules.MOST_LINES]
    assert said[1].startswith("Error compiling") and any("folder/law.py:5" in line for line in said)


LAST = "def last(them):\n    return them[-1]\n\n\ndef beyond(them):\n    return them[9]\n"
LOOK = """
import surefoot.law as it
print(it.last((1.0, 2.0)), it.__file__.endswith(".py"))
try:
    it.beyond((1.0, 2.0))
except IndexError as error:
    print(error)
"""


def test_a_module_without_arrays_of_c_looks_at_its_indices(checkout):
    COMPILER.or_skip()
    (checkout / "surefoot" / "law.py").write_text(LAST)
    (checkout / "surefoot" / "law.pxd").write_text("cpdef last(tuple them)\ncpdef beyond(tuple them)\n")
    assert python(checkout, "-c", LOOK) == "2.0 False\ntuple index out of range\n"


def compiled_values():
    """Source and types of each module that has types."""
    found = []
    for path in modules.sources().values():
        source = (modules.ROOT / path).with_suffix(".py")
        types = source.with_suffix(".pxd").read_text(encoding="utf-8")
        found.append(pytest.param(source.read_text(encoding="utf-8"), types, id=str(path)))
    return found


@pytest.mark.parametrize(("source", "types"), compiled_values())
def test_a_compiled_dataclass_takes_its_values_in_the_order_of_its_source(source, types):
    """Cython takes them in the order of the types."""
    assert field_orders(source, types) == []


def test_another_order_is_seen():
    source = "@dataclass(frozen=True)\nclass A:\n    x: float\n    y: float\n"
    assert field_orders(source, "cdef class A:\n    cdef readonly double x, y\n") == []
    assert field_orders(source, "cdef class A:\n    cdef readonly double y\n    cdef readonly double x\n") == ["A"]
    assert field_orders(source, "cdef class A:\n    cdef readonly double x\n") == ["A"]


def field_orders(source: str, types: str) -> list[str]:
    """Dataclasses whose fields have another order, or are others, where their types are."""
    wrong = []
    for node in ast.walk(ast.parse(source)):
        declared = isinstance(node, ast.ClassDef) and re.search(
            rf"(?m)^cdef class {node.name}\b.*:\n((    .*\n|\n)*)", types
        )
        if not declared or not any("dataclass" in ast.unparse(one) for one in node.decorator_list):
            continue
        lines = re.findall(r"(?m)^    cdef (?:readonly |public )?(?:[\w.]+|\([\w, ]+\)) ((?:\w+, )*\w+)$", declared[1])
        there = [name for line in lines for name in line.split(", ")]
        own = [one.target.id for one in node.body if isinstance(one, ast.AnnAssign)]
        if there[: len(own)] != own:
            wrong.append(node.name)
    return wrong


DIGESTS = "import json, runpy; print(json.dumps(runpy.run_path('surefoot/native/modules.py')['digests']()))"


def test_a_change_of_types_makes_stale_who_knows_them(checkout):
    package = checkout / "surefoot"
    for name, types in (("other", "from surefoot cimport law\n"), ("third", "cimport surefoot.other\n"), ("alone", "")):
        (package / f"{name}.py").touch()
        (package / f"{name}.pxd").write_text(types)

    def digests():
        return json.loads(python(checkout, "-c", DIGESTS))

    before = digests()
    (package / "law.pxd").write_text(TYPES + "\n")
    moved = {name for name, digest in digests().items() if digest != before[name]}
    assert moved == {"surefoot.law", "surefoot.other", "surefoot.third"}
    (package / "law.py").write_text(LAW + "\n")
    again = digests()
    assert {name for name in again if again[name] != before[name]} == moved


def test_all_modules_of_this_checkout_are_compiled_or_none_is():
    found = modules.sources()
    there = [name for name, path in found.items() if (modules.ROOT / modules.target(path)).exists()]
    assert there == ([] if modules.missing() else list(found))
    assert len(found) > 4
