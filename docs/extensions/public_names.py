"""The reference of the public names of the library, in groups, made of their docstrings."""

from collections.abc import Mapping
from typing import Any

GROUPS = {
    "params": "Settings",
    "contraction": "Contraction",
    "methods": "Contraction",
    "skeleton": "Skeleton",
    "geometry": "Skeleton",
    "metrics": "Measures",
    "slicing": "Surfaces",
    "surfaces": "Surfaces",
    "rolling": "Rolling",
    "viewer": "Looking",
    "io": "Files",
    "preprocess": "Files",
    "gallery": "Shapes whose skeleton is known",
    "one_call": "Everything at once",
    "pipeline": "Everything at once",
    "progress": "Everything at once",
    "errors": "Everything at once",
}  #: room of the library: heading of the page
ORDER = list(dict.fromkeys([*list(GROUPS.values())[1:], "Settings"]))


def grouped() -> Mapping[str, list[str]]:
    """Return the public names under the headings of the page, each once."""
    import tiskel

    groups: dict[str, list[str]] = {heading: [] for heading in ORDER}
    for name in tiskel.__all__:
        room = getattr(tiskel, name).__module__.split(".")[1]
        groups[GROUPS[room]].append(name)
    return groups


def reference() -> str:
    """Return the page's Markdown."""
    import tiskel

    lines = []
    for heading, names in grouped().items():
        lines += [f"## {heading}", ""]
        for name in names:
            kind = "autoclass" if isinstance(getattr(tiskel, name), type) else "autofunction"
            lines += ["```{eval-rst}", f".. {kind}:: tiskel.{name}", "```", ""]
    return "\n".join(lines)


def setup(app: Any) -> dict[str, bool]:
    """Make the directive ``{names}``."""
    from sphinx.util.docutils import SphinxDirective

    class Names(SphinxDirective):
        def run(self) -> list[Any]:
            return self.parse_text_to_nodes(reference(), allow_section_headings=True)

    app.add_directive("names", Names)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
