"""The documentation site: ``make docs`` writes it to out/docs, without a network, and it needs none to be read."""

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

from tiskel import __version__

project, author, copyright = "tiskel", "the tiskel developers", "the tiskel developers, MIT licence"
release = version = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml", "command_reference", "public_names"]
exclude_patterns = ["extensions", "notebooks", "static"]
html_theme = "furo"
html_title = f"tiskel {release}"
html_math_renderer = "mathml"  # browsers draw it themselves: no script and no font is fetched
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["math.css"]
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3  # links to headings, as GitHub has them
myst_links_external_new_tab = False
templates_path: list[str] = []
autodoc_default_options = {"members": True, "member-order": "bysource", "exclude-members": "__init__, __new__"}
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
napoleon_use_ivar = True
napoleon_use_rtype = False
suppress_warnings = ["myst.strikethrough"]
OUTSIDE = re.compile(r"\[([^\]]+)\]\((\.\./[^)#]+\.md)\)")  # a link to a table of benchmarks/, as GitHub follows it


def setup(app: Any) -> None:
    """Turn links to Markdown outside of this folder into downloads: they are no pages of the site."""

    def read(app: Any, name: str, source: list[str]) -> None:
        source[0] = OUTSIDE.sub(r"{download}`\1 <\2>`", source[0])

    app.connect("source-read", read)
