"""Pieces of HTML; whatever comes from outside is escaped here."""

import base64
import html
from collections.abc import Iterable, Sequence

FEW = 4  # lines that need no folding
MANY = 25  # rows that need no box to scroll in; printed, all of them are there


def text(value: object) -> str:
    """Return a value so that it can only be read, whatever it holds."""
    return html.escape(str(value), quote=True)


def number(value: object) -> str:
    """Return a number with five digits, other values as they are, an empty text for None."""
    return "" if value is None else f"{value:.5g}" if isinstance(value, float) else str(value)


def table(head: Sequence[str], rows: Iterable[Sequence[object]], kind: str = "") -> str:
    """Return a table; its cells are escaped."""
    top = "".join(f'<th scope="col">{text(cell)}</th>' for cell in head)
    lines = ["<tr>" + "".join(f"<td>{text(number(cell))}</td>" for cell in row) + "</tr>" for row in rows]
    box = "wide long" if len(lines) > MANY else "wide"
    body = f"<thead><tr>{top}</tr></thead><tbody>{''.join(lines)}</tbody>"
    return f'<div class="{box}" tabindex="0"><table class="{kind}">{body}</table></div>'


def facts(pairs: Iterable[tuple[str, object]]) -> str:
    """Return names with their values."""
    rows = (f"<tr><th scope='row'>{text(name)}</th><td>{text(number(value))}</td></tr>" for name, value in pairs)
    return f'<div class="wide"><table class="facts">{"".join(rows)}</table></div>'


def section(name: str, title: str, *parts: str) -> str:
    """Return a section with a heading that can be linked to; nothing where it has no part."""
    body = "".join(parts)
    return f'<section id="{name}"><h2>{text(title)}</h2>{body}</section>' if body else ""


def picture(name: str, data: bytes | None, caption: str) -> str:
    """Return a PNG with its caption, and a link to the file beside the report."""
    if data is None:
        return ""
    source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    link = f'<a href="{text(name)}">{text(name)}</a>'
    return f'<figure><img src="{source}" alt="{text(caption)}"><figcaption>{text(caption)} {link}</figcaption></figure>'


def messages(lines: Iterable[tuple[str, str]]) -> str:
    """Return lines of (kind, words) as a list; the kind is "warning", "note" or "plain"."""
    items = "".join(f'<li class="{kind}">{text(words)}</li>' for kind, words in lines)
    return f'<ul class="said">{items}</ul>' if items else ""


def folded(lines: Sequence[tuple[str, str]]) -> str:
    """Return lines as :func:`messages`, warnings first; what is more than a few of a kind can be opened."""
    warnings = [line for line in lines if line[0] == "warning"]
    others = [line for line in lines if line[0] != "warning"]
    return _opened(warnings, FEW, "more warnings") + _opened(others, FEW if len(others) <= FEW else 0, "lines")


def _opened(lines: Sequence[tuple[str, str]], first: int, name: str) -> str:
    """Return the first lines, and the others behind a summary that counts them."""
    rest = lines[first:] if len(lines) > first + 1 else []
    shown = messages(lines[: len(lines) - len(rest)])
    return f"{shown}<details><summary>{len(rest)} {name}</summary>{messages(rest)}</details>" if rest else shown
