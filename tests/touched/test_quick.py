"""`make quick` runs what a change touches, and is not green where nothing is known or nothing runs."""

import subprocess

import pytest
import quick
from edited import MODULE, Edit, edits, functions
from touches import READ, Touches, mirrored, named, read, write

from surefoot.native.modules import sources

pytestmark = pytest.mark.unit

LAW = '''"""A law."""

GAIN = 2.0


class Law:
    """Holds a gain."""

    def force(self, x):
        """Force of a spring."""
        return GAIN * x

    def power(self, x, v):
        return self.force(x) * v
'''
KNOWN = Touches(
    "0" * 40,
    {
        "tests/wbc/test_law.py": 1.0,
        "tests/wbc/test_power.py": 2.0,
        "tests/run/test_walk.py": 30.0,
        "tests/docs/test_words.py": 1.0,
    },
    {
        "wbc/law.py": {
            "Law.force": frozenset({"tests/wbc/test_law.py", "tests/run/test_walk.py"}),
            "Law.power": frozenset({"tests/wbc/test_power.py"}),
            READ: frozenset({"tests/docs/test_words.py"}),
        }
    },
)  # fmt: skip
EVERY = frozenset(KNOWN.seconds)
OF_FORCE = EVERY - {"tests/wbc/test_power.py"}


def git(root, *words):
    subprocess.run(
        ["git", "-c", "user.name=n", "-c", "user.email=e", "-c", "commit.gpgsign=false", *words], cwd=root, check=True
    )


def put(root, path, text):
    (root / path).parent.mkdir(parents=True, exist_ok=True)
    (root / path).write_text(text)


@pytest.fixture
def tree(tmp_path, monkeypatch):
    git(tmp_path, "init", "-q", "-b", "main")
    put(tmp_path, "wbc/law.py", LAW)
    for test in KNOWN.seconds:
        put(tmp_path, test, "def test_nothing():\n    pass\n")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-q", "-m", "all")
    monkeypatch.setattr(quick, "ROOT", tmp_path)
    monkeypatch.setattr(quick, "read", lambda: KNOWN)
    return tmp_path


def touched(root):
    (edit,) = edits(root, "HEAD")
    return KNOWN.of(edit, root, named(edit.path, root) | mirrored(edit.path, root))


@pytest.mark.parametrize(
    ("before", "after", "differ"),
    [
        ("GAIN * x", "-GAIN * x", {"Law.force"}),
        ("Force of a spring.", "Its force.", set()),
        ("        return self.force", "        # why\n\n        return self.force", set()),
        ("GAIN = 2.0", "GAIN = 3.0", {MODULE}),
        ("    def power", "    @property\n    def power", {"Law.power"}),
        ("def power(self, x, v)", "def work(self, x, v)", {"Law.power", "Law.work"}),
    ],
)
def test_a_function_differs_by_what_it_means(before, after, differ):
    old, new = functions(LAW), functions(LAW.replace(before, after))
    assert {name for name in old.keys() | new.keys() if old.get(name) != new.get(name)} == differ


@pytest.mark.parametrize(
    ("before", "after", "tests"),
    [
        ("GAIN * x", "-GAIN * x", OF_FORCE),
        ("GAIN = 2.0", "GAIN = 3.0", EVERY),
        ("Force of a spring.", "Its force.", {"tests/docs/test_words.py"}),
        ("def power", "def work(self):\n        return 1\n\n    def power", EVERY),
    ],
)
def test_an_edit_touches_tests_that_run_the_function_and_those_that_read_its_file(tree, before, after, tests):
    put(tree, "wbc/law.py", LAW.replace(before, after))
    assert touched(tree) == tests


def test_types_of_a_compiled_module_are_all_of_its_functions(tree):
    put(tree, "wbc/law.pxd", "cdef class Law:\n    pass\n")
    assert touched(tree) == EVERY


def test_a_file_is_known_by_its_name_before_it_moved(tree):
    (tree / "wbc" / "tasks").mkdir()
    git(tree, "mv", "wbc/law.py", "wbc/tasks/law.py")
    put(tree, "wbc/tasks/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    assert touched(tree) == OF_FORCE
    git(tree, "add", ".")
    git(tree, "commit", "-q", "-m", "moved")
    put(tree, "wbc/tasks/law.py", LAW)
    assert touched(tree) == OF_FORCE, "the map is from before"


def test_a_map_that_was_made_anew_in_part_has_a_moved_file_twice(tree):
    (tree / "wbc" / "tasks").mkdir()
    git(tree, "mv", "wbc/law.py", "wbc/tasks/law.py")
    git(tree, "commit", "-q", "-m", "moved")
    put(tree, "wbc/tasks/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    again = {name: frozenset({"tests/docs/test_words.py"}) for name in KNOWN.files["wbc/law.py"]}
    both = Touches(KNOWN.commit, KNOWN.seconds, {**KNOWN.files, "wbc/tasks/law.py": again})
    assert set(quick.choose(edits(tree, "HEAD"), both, tree, 1e3).runs) == OF_FORCE | {"tests/docs/test_words.py"}


def test_a_test_is_known_where_it_moved(tree):
    git(tree, "mv", "tests/wbc/test_law.py", "tests/run/test_law.py")
    git(tree, "commit", "-q", "-m", "moved")
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    assert touched(tree) == OF_FORCE - {"tests/wbc/test_law.py"} | {"tests/run/test_law.py"}


def test_a_test_that_was_never_watched_touches_what_its_folder_mirrors(tree):
    put(tree, "tests/wbc/test_new.py", "def test_nothing():\n    pass\n")
    git(tree, "add", ".")
    git(tree, "commit", "-q", "-m", "new")
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    assert touched(tree) == OF_FORCE | {"tests/wbc/test_new.py"}


def test_a_test_that_names_a_changed_module_comes_first(tree):
    put(tree, "tests/run/test_names.py", "from surefoot.wbc.law import Law\n")
    git(tree, "add", ".")
    git(tree, "commit", "-q", "-m", "new")
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    assert touched(tree) == OF_FORCE | {"tests/run/test_names.py"}
    choice = quick.choose(edits(tree, "HEAD"), KNOWN, tree, 100.0)
    assert next(iter(choice.runs)) == "tests/run/test_names.py"


def test_a_dear_one_waits_for_the_quick_ones_though_it_names_the_module(tree):
    put(tree, "tests/run/test_walk.py", "from surefoot.wbc.law import Law\n")
    git(tree, "commit", "-q", "-a", "-m", "names it")
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    choice = quick.choose(edits(tree, "HEAD"), KNOWN, tree, 30.5)
    assert set(choice.runs) == OF_FORCE - {"tests/run/test_walk.py"}
    assert choice.left == {"tests/run/test_walk.py": 30.0}


def test_an_unknown_file_has_the_tests_of_its_mirrored_folder(tree):
    put(tree, "wbc/new/task.py", "def f():\n    return 1\n")
    assert touched(tree) == {"tests/wbc/test_law.py", "tests/wbc/test_power.py"}


def test_a_changed_test_is_touched_alone_and_comes_first(tree):
    put(tree, "tests/run/test_walk.py", "def test_other():\n    pass\n")
    assert touched(tree) == {"tests/run/test_walk.py"}
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    choice = quick.choose(edits(tree, "HEAD"), KNOWN, tree, 31.0)
    assert list(choice.runs) == ["tests/run/test_walk.py", "tests/wbc/test_law.py"]
    assert set(choice.left) == {"tests/docs/test_words.py"}


def test_tests_beside_the_change_and_quick_ones_fit_first(tree):
    choice = quick.choose([Edit("wbc/law.py", "wbc/law.py", None)], KNOWN, tree, 4.0)
    assert list(choice.runs) == ["tests/wbc/test_law.py", "tests/wbc/test_power.py", "tests/docs/test_words.py"]
    assert choice.left == {"tests/run/test_walk.py": 30.0}


def test_what_is_left_is_said(tree, monkeypatch, capsys):
    put(tree, "wbc/law.py", LAW.replace("GAIN * x", "-GAIN * x"))
    monkeypatch.setattr("sys.argv", ["quick.py", "--seconds", str(quick.STARTING + 5.0), "--list"])
    assert quick.main() == 0
    assert "tests/run/test_walk.py (30 s)" in capsys.readouterr().out


@pytest.mark.parametrize("path", [None, "LICENSE"])
def test_nothing_known_is_not_green(tree, monkeypatch, capsys, path):
    if path is not None:
        put(tree, path, "words")
    monkeypatch.setattr("sys.argv", ["quick.py"])
    assert quick.main() == quick.NOTHING_RAN
    said = capsys.readouterr().out
    assert "othing was tested" in said or "nothing was tested" in said
    assert path is None or f"No unit test is known to touch {path}" in said


def test_a_map_is_read_as_it_was_written(tmp_path):
    write(KNOWN, tmp_path / "map.json")
    assert read(tmp_path / "map.json") == KNOWN
    assert not read(tmp_path / "none.json").files


def test_the_kept_map_sees_calls_in_compiled_modules():
    """Their calls are told by the hook of the interpreter only where they were compiled for that."""
    known, root = read(), quick.ROOT
    files = [(root / path).resolve().relative_to(root).with_suffix(".py").as_posix() for path in sources().values()]
    called = [path for path in files if known.entries(Edit(path, path, None), root).keys() - {READ}]
    assert len(called) > 0.5 * len(files)
    tests = known.of(Edit("planner/laws/footstep_tvmpc.py", "planner/laws/footstep_tvmpc.py", None), root, frozenset())
    assert "tests/planner/laws/test_tvmpc.py" in tests
