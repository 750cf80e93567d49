"""Words that an option takes: completed in the shell, and told apart from misspelt ones, which are wrong usage."""

from collections.abc import Callable, Iterable

import typer

from tiskel.wording import meant

Completion = Callable[[str], list[str]]


def completes(*words: str) -> Completion:
    """Return what an option that takes words, or else numbers or names, is completed with."""

    def complete(incomplete: str) -> list[str]:
        return [word for word in words if word.startswith(incomplete)]

    return complete


def completes_list(*words: str) -> Completion:
    """Return what an option that takes several of the words, with commas, is completed with."""

    def complete(incomplete: str) -> list[str]:
        before, comma, last = incomplete.rpartition(",")
        given = before.split(",")
        return [f"{before}{comma}{word}" for word in words if word.startswith(last) and word not in given]

    return complete


def shape_names(incomplete: str) -> list[str]:
    """Return the names of shapes that begin so."""
    return [name for name in all_shapes() if name.startswith(incomplete)]


def all_shapes() -> list[str]:
    """Return the names of all shapes."""
    from tiskel.gallery.families import GROUPS

    return [name for group in GROUPS.values() for name in group]


def misput(option: str, needed: str, value: object) -> typer.BadParameter:
    """Return the error, exit code 2, for a value that an option cannot take."""
    return typer.BadParameter(f"it needs {needed}, got {value!r}.", param_hint=option)


def chosen(option: str, word: str, known: Iterable[str]) -> str:
    """Return a word that is one of those known; raise typer.BadParameter, exit code 2, where it is not."""
    words = list(known)
    if word in words:
        return word
    listed = f" is not one of {', '.join(map(repr, words))}."
    raise typer.BadParameter(f"{word!r}{listed}{meant(word, words)}", param_hint=option)
