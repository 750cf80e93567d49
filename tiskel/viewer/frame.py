"""A page inside another, as notebooks show results."""

import html

HEIGHT = 480  # pixels; a notebook's cell and its output fit on a screen


def framed(page: str) -> str:
    """Return a frame that holds a whole page, for the output of a notebook."""
    document = html.escape(page, quote=True)
    style = f"width:100%;height:{HEIGHT}px;border:1px solid #ccc;border-radius:6px"
    return f'<iframe srcdoc="{document}" style="{style}" sandbox="allow-scripts" allowfullscreen></iframe>'
