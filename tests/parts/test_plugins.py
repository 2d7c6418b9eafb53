"""The registry of what is plugged in: ours win, others are found by name and loaded once, what is wrong is named."""

import sys
from pathlib import Path

import pytest
from sites import Site

from surefoot.models.registry import ROBOTS
from surefoot.parts.plugins import AFRESH, OWN_PACKAGE, At, Declared, PluginError, Registry
from surefoot.planner.laws.profiles import PROFILES
from surefoot.scenarios.catalogue import SCENARIOS
from surefoot.scenarios.file.registries import INSTRUMENTS, REGISTRIES
from surefoot.scenarios.judge.metrics import METRICS
from surefoot.scenarios.run.full import PLANTS
from surefoot.scenarios.run.sensing import ESTIMATORS
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.wbc.tasks import TASKS

pytestmark = pytest.mark.unit

GROUP = "surefoot.lengths"


class Length(float):
    """The class that the registry of these tests is of."""


LOADS: list[str] = []


@pytest.fixture
def others(monkeypatch, tmp_path):
    """Have entry points by name and target; modules `counted` and `noisy` can be imported."""
    (tmp_path / "counted.py").write_text(
        "from tests_lengths import LOADS, Length\n"
        "LOADS.append('counted')\nLONG = Length(7.0)\nKIND = Length\nWORD = 'x'\n"
    )
    (tmp_path / "noisy.py").write_text("print('noise')\nraise OSError('no\\n  disk')\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setitem(sys.modules, "tests_lengths", sys.modules[__name__])
    LOADS.clear()
    brought: list[Site] = []

    def bring(**targets):
        brought.append(Site(tmp_path / f"site{len(brought)}", f"brings{len(brought)}"))
        brought[-1].register(GROUP, **targets)
        monkeypatch.syspath_prepend(str(brought[-1].folder))

    yield bring
    for name in ("counted", "noisy"):
        sys.modules.pop(name, None)


@pytest.fixture
def lengths():
    return Registry(GROUP, Length, {"own": Length(1.0), "also": Length(2.0)})


def test_it_is_a_mapping_of_ours_in_their_order_and_the_others_sorted(lengths, others):
    others(zebra="counted:LONG", bear="counted:LONG")
    lengths.add("cat", Length(3.0))
    assert list(lengths) == ["own", "also", "bear", "cat", "zebra"]
    assert len(lengths) == 5
    assert "bear" in lengths
    assert "cat" in lengths
    assert "dog" not in lengths
    assert lengths["own"] == 1.0
    assert lengths.get("dog") is None
    with pytest.raises(KeyError):
        lengths["dog"]


def test_an_entry_point_is_loaded_once_and_only_when_asked_for(lengths, others):
    others(long="counted:LONG", never="no_such_module:X")
    assert "long" in lengths
    assert list(lengths) == ["own", "also", "long", "never"]
    assert LOADS == []
    assert lengths["long"] is lengths["long"]
    assert LOADS == ["counted"]
    del sys.modules["counted"]
    assert lengths["long"] == 7.0
    assert LOADS == ["counted"]


def test_what_is_added_by_code_goes_before_an_entry_point_and_can_be_taken_back(lengths, others):
    others(long="counted:LONG")
    lengths.add("long", Length(3.0))
    lengths.add("long", Length(4.0))
    assert (lengths["long"], LOADS) == (4.0, [])
    lengths.discard("long")
    lengths.discard("long")
    assert lengths["long"] == 7.0


def test_a_name_of_ours_is_ours_and_a_clash_is_said(lengths, others):
    others(own="noisy:X", long="counted:LONG")
    assert lengths["own"] == 1.0
    assert list(lengths) == ["own", "also", "long"]
    assert {name: str(clash) for name, clash in lengths.clashes().items()} == {
        "own": f"'own' of package brings0 in {GROUP} has the name of one of surefoot's own; "
        "give it another name there, or remove it"
    }
    with pytest.raises(PluginError, match=r"'own' of surefoot\.lengths is surefoot's own; choose another name"):
        lengths.add("own", Length(3.0))


def test_a_package_that_cannot_be_loaded_is_named_in_one_line(lengths, others, capsys):
    others(noisy="noisy:X")
    with pytest.raises(PluginError) as refused:
        lengths["noisy"]
    assert refused.value.what == "'noisy' of package brings0 cannot be loaded, OSError: no disk"
    assert refused.value.right == "mend or remove it"
    assert str(refused.value) == f"{refused.value.what}; {refused.value.right}"
    assert capsys.readouterr() == ("", "noise\n")


def test_an_object_of_another_kind_is_refused(lengths, others):
    others(word="counted:WORD", kind="counted:KIND")
    with pytest.raises(PluginError, match=rf"'word' of package \S+ in {GROUP} is of type str; it must be a Length"):
        lengths["word"]
    with pytest.raises(PluginError, match=r"is the class Length; register an instance of it"):
        lengths["kind"]
    with pytest.raises(PluginError, match=r"'mine' in \S+ is of type float; it must be a Length"):
        lengths.add("mine", 3.0)
    assert "mine" not in lengths


def test_without_a_kind_it_must_be_called(others):
    makers = Registry(GROUP, None, {})
    others(word="counted:WORD", kind="counted:KIND")
    assert makers["kind"](2.0) == 2.0
    with pytest.raises(PluginError, match="is of type str; it must be a function or a class"):
        makers["word"]


def test_a_name_of_two_packages_is_refused(lengths, others):
    others(long="counted:LONG")
    others(long="noisy:X")
    with pytest.raises(PluginError, match=r"'long' in \S+ is of packages brings1 and brings0; remove one of them"):
        lengths["long"]
    assert list(lengths).count("long") == 1
    assert LOADS == []


def test_every_registry_of_surefoot_has_a_row_in_the_documentation():
    page = (Path(__file__).parents[2] / "docs" / "extending.md").read_text(encoding="utf-8")
    registries = (METRICS, PROFILES, TASKS, ESTIMATORS, PLANTS, INSTRUMENTS, ROBOTS, SCENARIOS, KINDS)
    groups = {registry.group for registry in registries}
    assert len(groups) == len(registries)
    for group in groups:
        assert f"| `{group}` |" in page
        assert f'[project.entry-points."{group}"]' in page


def test_what_is_declared_is_known_before_it_is_imported_and_imported_when_it_is_asked_for(others):
    """The fixture's modules count how often they are imported."""
    own = {"one": At("the first", "counted:LONG"), "two": At("the second", "counted:LONG")}
    names: Declared = Declared("surefoot.nothing", "counted:Length", own)
    assert list(names) == ["one", "two"] and names.said["two"] == "the second"
    assert "one" in names and names.package("one") == OWN_PACKAGE
    assert names.refusal("one") is None and names.refusal("three") is None
    with pytest.raises(PluginError, match="surefoot's own"):
        names.add("one", 1)
    assert LOADS == [] and "counted" not in sys.modules
    long = names["one"]
    assert names["one"] is long and names.owns(long) and not names.owns(object())
    with pytest.raises(PluginError, match="it must be a Length"):
        names.add("three", "3")
    assert names.add("three", long) is names["three"]


def test_a_declared_part_of_another_kind_is_refused(others):
    names: Declared = Declared("surefoot.nothing", "counted:Length", {"word": At("no length", "counted:WORD")})
    with pytest.raises(PluginError, match=r"'word' in surefoot\.nothing is of type str; it must be a Length"):
        names["word"]


@pytest.mark.parametrize("group", sorted(registry.group for registry in (*REGISTRIES.values(), METRICS)))
def test_every_declared_part_is_where_it_is_said_to_be_and_has_its_name(group):
    (registry,) = (one for one in (*REGISTRIES.values(), METRICS) if one.group == group)
    for name in registry.said if isinstance(registry, Declared) else ():
        assert getattr(registry[name], "name", name) == name
        assert registry.package(name) == OWN_PACKAGE


def test_what_is_said_of_a_part_before_it_is_imported_is_what_it_says_itself():
    assert dict(PROFILES.said) == {name: profile.doc for name, profile in PROFILES.items()}
    assert dict(METRICS.said) == {name: metric.meaning for name, metric in METRICS.items()}


def test_a_renamed_entry_point_says_that_its_package_is_to_be_installed_again(lengths, others):
    others(moved="counted:GONE", lost="nowhere:X")
    for name in ("moved", "lost"):
        with pytest.raises(PluginError) as refused:
            lengths[name]
        assert refused.value.right == f"mend or remove it, and {AFRESH}"


def test_a_name_that_there_is_not_hints_at_that_beside_packages_alone(lengths, others):
    assert lengths.hint == ""
    others(old="counted:LONG")
    assert lengths.hint == f"; if a package brings it, {AFRESH}"
