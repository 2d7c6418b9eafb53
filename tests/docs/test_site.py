"""The built site opens from its folder in a browser: no error, nothing fetched, no sideways scroll, accessible."""

import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

import pytest
from browser import Browser
from needs import AXE, BROWSER, SITE

pytestmark = [pytest.mark.unit, pytest.mark.long]

ROOT = Path(__file__).parents[2]
WIDTHS = (390, 1280)
"""Widths of a phone and of a desktop [px]."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder of the site as it is built now; SITE names one that is there already."""
    if given := os.environ.get("SITE"):
        return Path(given)
    SITE.or_skip()
    folder = tmp_path_factory.mktemp("site") / "html"
    command = [sys.executable, ROOT / "docs" / "site" / "build.py", folder]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def browser(site, tmp_path_factory):
    BROWSER.or_skip()
    with Browser(site / "index.html", tmp_path_factory.mktemp("profile"), (1280, 900)) as opened:
        yield opened


@pytest.mark.parametrize("link", ["nowhere.md", "log.md#no-such-heading", "images/none.png"])
def test_a_broken_link_breaks_the_build(link, tmp_path):
    SITE.or_skip()
    (tmp_path / "log.md").write_text("# Log\n")
    picture = "!" if link.endswith("png") else ""
    (tmp_path / "index.md").write_text(f"# Index\n\nSee {picture}[it]({link}).\n\n```{{toctree}}\nlog\n```\n")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "dummy", "-c", ROOT / "docs" / "site"]
    done = subprocess.run([*command, tmp_path, tmp_path / "out"], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert link.partition("#")[2] in done.stderr


def pages(site):
    return sorted(path for path in site.rglob("*.html") if "_static" not in path.parts)


def test_links_of_the_site_lead_to_a_page_and_to_a_place_on_it(site):
    texts = {path.resolve(): path.read_text(encoding="utf-8") for path in pages(site)}
    places = {path: set(re.findall(r'\sid="([^"]+)"', text)) for path, text in texts.items()}
    checked = 0
    for path, text in texts.items():
        for link in re.findall(r'\s(?:href|src)="([^"]+)"', text):
            found = urlsplit(urljoin(path.as_uri(), link.replace("&amp;", "&")))
            if found.scheme != "file":
                continue
            target = Path(unquote(found.path))
            assert target.exists(), f"{path.name}: {link}"
            if found.fragment and target in places:
                assert unquote(found.fragment) in places[target] | {"", "top"}, f"{path.name}: {link}"
            checked += 1
    assert checked > 5000


def test_nothing_is_fetched_from_elsewhere(site):
    for path in (*site.rglob("*.html"), *site.rglob("*.css"), *site.rglob("*.js")):
        text = path.read_text(encoding="utf-8")
        fetched = re.findall(r'<(?:script|img|iframe|source)[^>]+src="(https?:[^"]+)|url\(["\']?(https?:[^)]+)', text)
        fetched += re.findall(
            r'<link(?![^>]*rel="(?:canonical|index|search|next|prev)")[^>]+href="(https?:[^"]+)()"', text
        )
        assert not fetched, f"{path.name}: {fetched}"


@pytest.mark.parametrize("width", WIDTHS)
def test_every_page_opens_without_an_error_and_without_sideways_scroll(site, browser, width):
    browser.show_as(width, 900)
    for path in pages(site):
        browser.open(path)
        assert browser.complaints() == [], path.name
        assert browser.run("return window.innerWidth") == width
        over = browser.run("const e = document.documentElement; return e.scrollWidth - e.clientWidth")
        assert over <= 0, f"{path.name} is {over} px wider than a screen of {width} px"
        hidden = browser.run("return [...document.images].filter(i => i.complete && !i.naturalWidth).map(i => i.src)")
        assert hidden == [], path.name


def test_an_error_and_a_page_that_is_too_wide_are_found(browser, tmp_path):
    page = tmp_path / "wide.html"
    page.write_text("<p style='width: 2000px'>wide</p><script>throw new Error('no')</script>")
    browser.show_as(390, 900)
    browser.open(page)
    assert any("no" in told for told in browser.complaints())
    assert browser.run("return document.documentElement.scrollWidth") >= 2000


def test_the_search_finds_a_key_and_a_metric_without_a_server(site, browser):
    browser.show_as(1280, 900)
    for word in ("cop_ratio_p99", "step_adaptation"):
        browser.open(f"{(site / 'search.html').as_uri()}?q={word}")
        found = browser.wait_for("return document.querySelectorAll('#search-results li').length", 30.0)
        assert found >= 1, word


@pytest.mark.parametrize("dark", [False, True])
def test_no_page_has_a_serious_fault_of_accessibility(site, browser, dark):
    AXE.or_skip()
    code, faults = Path(os.environ["AXE"]).read_text(encoding="utf-8"), {}
    browser.show_as(1280, 900, dark)
    for path in pages(site):
        browser.open(path)
        browser.run(code)
        found = browser.run(
            "return axe.run(document, {resultTypes: ['violations']}).then(r => r.violations"
            ".filter(v => ['serious', 'critical'].includes(v.impact))"
            ".map(v => [v.id, v.nodes.slice(0, 3).map(n => n.html)]))"
        )
        faults |= {path.relative_to(site).as_posix(): found} if found else {}
    assert not faults, faults
