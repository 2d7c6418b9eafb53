"""Settings by which Sphinx makes the site of the pages of `build.py`; docs/decisions/site.md says why so."""

from typing import Any

from surefoot.version import __version__

project = "Surefoot"
copyright = "The Surefoot developers, Apache-2.0"
version = release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
root_doc = "index"
language = "en"

myst_heading_anchors = 4
default_role = "code"
smartquotes = False  # they are primes in equations
highlight_language = "none"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_class_signature = "mixed"
autodoc_default_options = {"members": True, "undoc-members": False}
napoleon_use_ivar = True
napoleon_use_rtype = False
add_module_names = False
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = f"Surefoot {__version__}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_copy_source = False
html_domain_indices = False
html_show_sourcelink = False
html_show_sphinx = False
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
copybutton_prompt_text = "$ "


def _show_code(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Show an indented block that stands apart in a docstring as code."""
    for at, (line, gap, block) in enumerate(zip(lines, lines[1:], lines[2:], strict=False)):
        if line and not line.startswith(" ") and not gap and block.startswith("    "):
            lines[at] = f"{line}:" if line.endswith(":") else f"{line} ::"


def setup(app: Any) -> None:
    """Take part in the build."""
    app.connect("autodoc-process-docstring", _show_code, priority=1)
