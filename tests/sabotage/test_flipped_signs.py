"""Signs of laws are found, those of places and counts are not, and a draw is the same again."""

from pathlib import Path

import pytest
import signs

pytestmark = pytest.mark.unit

TEXT = '''"""Words - and + more."""
AT = 3 - one
class Law:
    def __init__(self, a):
        self.a = -a
    def force(self, x: float, low: float = -0.5) -> float:
        """A spring - of a kind."""
        for i in range(len(x) - k):  # not - this
            self.out[first + i] -= self.a * (x[i + k] - self.rest)
            self.n += 1
            j = i - 1
        return self.a + f"{-x}" + min(self.limits[0], 2.0 - -x) - 0.5
def tail():
    room = np.zeros((n + k, 3)), np.empty(n - k)
    return [a + [b], -c]
'''
FOUND = [(9, "-="), (9, "-"), (12, "-"), (12, "-"), (12, "-"), (15, "-")]


def test_signs_are_those_of_numbers_in_functions():
    assert [(sign.line, sign.sign) for sign in signs.signs(TEXT)] == FOUND


def test_a_flipped_sign_differs_in_that_sign_alone():
    for sign in signs.signs(TEXT):
        flipped = sign.flipped(TEXT)
        line, other = TEXT.splitlines()[sign.line - 1], flipped.splitlines()[sign.line - 1]
        assert len(flipped) == len(TEXT)
        assert [(a, b) for a, b in zip(TEXT, flipped, strict=True) if a != b] in ([("-", "+")], [("+", "-")])
        assert other[sign.column :].startswith(signs.FLIPPED[sign.sign]) and line[: sign.column] == other[: sign.column]


def test_a_draw_is_the_same_again_and_another_with_another_seed():
    known = signs.modules()
    assert Path("planner/recovery/step_adjustment.py") in known and Path("surefoot/maths/linear.pyx") in known
    one, again, other = (signs.drawn(seed, 20, known) for seed in (1, 1, 2))
    assert one == again and one != other
    assert len({module for module, _ in one}) == 20


@pytest.mark.parametrize(
    ("module", "first"),
    [
        ("wbc/contact/zmp.py", "tests/wbc/contact/test_zmp.py"),
        ("scenarios/record/foxglove/views.py", "tests/scenarios/record"),
        ("surefoot/maths/algebra.py", "tests/maths/test_algebra.py"),
        ("surefoot/joints.py", "tests/test_joints.py"),
    ],
)
def test_tests_of_a_module_are_its_own_and_those_of_its_folder(module, first):
    tests = signs.tests_of(Path(module))
    assert first in tests
    assert all((signs.ROOT / test).exists() for test in tests)


def test_tests_of_other_folders_that_run_the_function_are_tried_after_those_of_its_own():
    module = Path("surefoot/maths/dual_method.py")
    text = (signs.ROOT / module).read_text()
    moves = next(sign for sign in signs.signs(text) if "self.u[k] -=" in text.splitlines()[sign.line - 1])
    others = signs.runners(module, moves)
    assert "tests/planner/laws/test_bounded_qp.py" in others
    assert not any(test.startswith("tests/maths") for test in others)
    assert all((signs.ROOT / test).exists() for test in others)
    compiled = Path("surefoot/maths/linear.pyx")
    assert isinstance(signs.runners(compiled, next(signs.signs((signs.ROOT / compiled).read_text()))), list)
