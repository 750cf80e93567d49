"""Formulas as MathML, which browsers draw without script, font or network; latex2mathml translates them."""

from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)


def _write(display: str) -> Any:
    def visit(writer: Any, node: nodes.Node) -> None:
        formula = node.astext().strip()
        mathml = convert(formula, display=display)
        if "\\" in mathml:  # what is not known is left as it was
            LOGGER.warning("formula %s has a command that MathML has no word for", formula, location=node)
        writer.body.append(f'<div class="math">{mathml}</div>' if display == "block" else mathml)
        raise nodes.SkipNode

    return visit


def setup(app: Any) -> dict[str, bool]:
    """Make "mathml" a name for html_math_renderer."""
    app.add_html_math_renderer("mathml", (_write("inline"), None), (_write("block"), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
