"""Words from elsewhere (names of files, elements, branches) made fit to be shown."""

import unicodedata
from collections.abc import Iterable

LONGEST = 300  #: characters of a message; what is longer loses its middle
HIDDEN = ("Cc", "Cf", "Cs", "Co", "Zl", "Zp")  #: categories that a terminal acts on, or cannot show: escapes, marks


def printable(text: str) -> str:
    """Return a text in one line without anything that a terminal acts on, such as escape sequences of colours.

    Examples
    --------
    >>> from tiskel.wording import printable
    >>> printable("a\\x1b[31mred" + chr(10) + "b")
    'a\\\\x1b[31mred b'
    """
    words = " ".join(text.split())
    if words.isascii() and words.isprintable():
        return words
    return "".join(
        sign.encode("unicode_escape").decode() if unicodedata.category(sign) in HIDDEN else sign for sign in words
    )


def shortened(text: str, longest: int = LONGEST) -> str:
    """Return a text of at most so many characters: its beginning and its end."""
    half = (longest - 3) // 2
    return text if len(text) <= longest else f"{text[:half]}...{text[-half:]}"


def meant(word: str, known: Iterable[str]) -> str:
    """Return a question after the known word that is most like a misspelt one, with a blank before it; or nothing.

    Examples
    --------
    >>> from tiskel.wording import meant
    >>> meant("bananna", ["banana", "hand"])
    " Did you mean 'banana'?"
    >>> meant("unicorn", ["banana", "hand"])
    ''
    """
    near = nearest(word.lower(), known)
    return f" Did you mean {near!r}?" if near else ""


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known word that is most like a misspelt one; empty where none is like it.

    Examples
    --------
    >>> from tiskel.wording import nearest
    >>> nearest("intervall", ["interval", "gap"]), nearest("colour", ["interval"])
    ('interval', '')
    """
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, list(known), n=1)), "")
