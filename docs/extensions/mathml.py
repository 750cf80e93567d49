"""Formulas as MathML, by the translator that docutils has: browsers draw them, without script or network."""

from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)


def _write(block: bool) -> Any:
    def visit(writer: Any, node: nodes.Node) -> None:
        formula = node.astext().strip()
        try:
            mathml = tex2mathml(formula, as_block=block)
        except MathError as error:
            LOGGER.warning("formula %s: %s", formula, error, location=node)
            mathml = f"<code>{writer.encode(formula)}</code>"
        writer.body.append(f'<div class="math">{mathml}</div>' if block else mathml)
        raise nodes.SkipNode

    return visit


def setup(app: Any) -> dict[str, bool]:
    """Make "mathml" a name for html_math_renderer."""
    app.add_html_math_renderer("mathml", (_write(False), None), (_write(True), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
