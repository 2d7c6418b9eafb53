"""Panels of one figure: as many as asked for, all of one size, and no wider than a page."""

import pytest

from surefoot.scenarios.show.kit.figures import PAGE_WIDTH, panels

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(("count", "most", "rows"), [(1, 3, 1), (3, 3, 1), (4, 3, 2), (7, 2, 4)])
def test_panels_fill_rows_and_all_have_one_size(count, most, rows):
    figure, every = panels(count, most, 2.0)
    figure.draw_without_rendering()
    assert len(every) == count
    assert [one for one in figure.axes if one.get_visible()] == every
    width, height = figure.get_size_inches()
    assert width == pytest.approx(max(PAGE_WIDTH * min(count, most) / most, 4.2))
    assert height == pytest.approx(2.0 * rows + 0.3)
    sizes = {tuple(one.get_position().size.round(3)) for one in every}
    assert len(sizes) == 1


def test_panels_of_a_row_stand_beside_each_other_in_their_order():
    figure, every = panels(5, 3, 2.0)
    figure.draw_without_rendering()
    places = [(-round(one.get_position().y0, 3), round(one.get_position().x0, 3)) for one in every]
    assert places == sorted(places)
    assert len({place[0] for place in places}) == 2
