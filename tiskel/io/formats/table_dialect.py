"""How a table of numbers is written: what separates its columns, and what its decimal sign is."""

import csv
import re
from collections.abc import Sequence

from tiskel.errors import TiskelError

NUMBER = re.compile(r"[+-]?[.,]*\d[\d.,]*([eEdD][+-]?\d+)?|[+-]?(nan|inf(inity)?)(\([a-z]*\))?", re.IGNORECASE)
NAN_OF_WINDOWS = re.compile(r"[+-]?nan\([a-z]+\)", re.IGNORECASE)
FORTRAN = re.compile(r"[\d.][dD][+-]?\d")  #: the exponent of double precision
EXPONENTS = str.maketrans("dD", "eE")
COMMA_AND_SPACE = re.compile(r"\d\s*,\s|\d\s+,")
NO_DECIMAL = re.compile(r"\.|,[^\s,]*,|(?<!\d),|,(?!\d)")  #: where white space separates: no decimal commas
IN_CELLS = r"(?:^|[;\t]) *[+-]?\d*{}\d*(?:[eEdD][+-]?\d+)? *(?=[;\t]|$)"
DECIMAL_COMMA = re.compile(IN_CELLS.format(","), re.MULTILINE)
DECIMAL_POINT = re.compile(IN_CELLS.format(r"\."), re.MULTILINE)
MISSING = re.compile(r"(NA|N/A|null|None|-)?", re.IGNORECASE)  #: what stands in a cell without a value
WORDS_OF_NONE = re.compile(
    r"[,;\t] *[,;\t]|[,;\t] *$|^ *[,;\t]|NA|N/A|null|None|- *(?:[,;\t]|$)", re.IGNORECASE | re.MULTILINE
)
EMPTY = r"(?:(?<=^)|(?<={0}))[ \t\r]*(?:NA|N/A|null|None|-)?[ \t\r]*(?={0}|$)"
UNLIKE_WHOLE = re.compile(r"[.eEn]")  #: a number with a point or an exponent, or NaN or Inf


def is_number(word: str) -> bool:
    """Return whether a word is a number, with a point or a comma, and an exponent of C or of Fortran."""
    return NUMBER.fullmatch(word.strip()) is not None


def is_value(word: str) -> bool:
    """Return whether a cell holds a number, or that there is none."""
    return is_number(word) or MISSING.fullmatch(word.strip()) is not None


def separator_of(rows: Sequence[str]) -> str | None:
    """Return ";", a tab or a comma; None for white space. Told from the last row, since the first may be a header."""
    row = rows[-1]
    if ";" in row:
        return ";"
    if COMMA_AND_SPACE.search(row):
        return ","
    if "\t" in row and len({row.count("\t") for row in rows}) == 1:
        return "\t"
    return "," if "," in row and not re.search(r"\s", row) else None


def cells(row: str, separator: str | None) -> list[str]:
    """Return the cells of one row without their quotes; without a separator (None) white space separates."""
    if '"' not in row:
        return [cell.strip().strip("'") for cell in row.split(separator)]
    try:
        quoted = next(csv.reader([row], delimiter=separator or " ", skipinitialspace=True))
    except csv.Error:  # a cell too long for it: no number, and no name
        quoted = [row]
    return [cell.strip() for cell in quoted]


def unquoted(rows: Sequence[str], name: str) -> list[str]:
    """Return rows of quoted cells as rows with semicolons between bare cells.

    Parameters
    ----------
    rows : sequence of str
        Rows of a table; the last tells the separator.
    name : str
        The file's name, for messages.

    Raises
    ------
    TiskelError
        Where the quotes do not match.
    """
    bare = re.sub(r'"[^"]*"', '""', rows[-1])
    separator = next((sign for sign in ";\t," if sign in bare), " ")
    try:
        table = list(csv.reader(rows, delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise TiskelError(f"{name}: its quoted cells cannot be read ({error}); save it without quotes") from None
    return [";".join(cell.replace(";", " ").strip() for cell in row) for row in table]


def with_points(rows: Sequence[str], separator: str | None, headed: bool, name: str) -> Sequence[str]:
    """Return the rows with decimal points, exponents as C has them, and plain NaN.

    A comma is the decimal sign where something else separates.

    Parameters
    ----------
    rows : sequence of str
        Rows of numbers, without a header.
    separator : str or None
        The separator of their columns, None for white space.
    headed : bool
        Whether every column has a name.
    name : str
        The file's name, for messages.

    Raises
    ------
    TiskelError
        Where the decimal sign cannot be told.
    """
    text = "\n".join(rows)
    changed = text
    if separator == ",":
        if not headed:
            _check_whole_numbers(text, rows[0].count(",") + 1, name)
    elif "," in text and _has_decimal_commas(text, separator, name):
        changed = changed.replace(",", ".")
    if "n(" in text or "N(" in text:
        changed = NAN_OF_WINDOWS.sub("nan", changed)
    if separator and WORDS_OF_NONE.search(changed):
        blank = EMPTY if separator != "\t" else EMPTY.replace("\\t", "")
        changed = re.sub(blank.format(separator), "nan", changed, flags=re.IGNORECASE | re.MULTILINE)
    if ("d" in text or "D" in text) and FORTRAN.search(changed):
        changed = changed.translate(EXPONENTS)
    return rows if changed is text else changed.split("\n")


def _has_decimal_commas(text: str, separator: str | None, name: str) -> bool:
    """Return whether the commas in cells that something else separates are decimal signs."""
    if separator is None:
        if NO_DECIMAL.search(text):
            raise TiskelError(
                f"{name}: commas and white space both separate its columns, or points and commas are both decimal "
                "signs; separate the columns by one sign"
            )
        return True
    if not DECIMAL_COMMA.search(text):
        return False  # words of a column that is not read
    if DECIMAL_POINT.search(text):
        raise TiskelError(f"{name}: some numbers have a decimal comma and some a point; export it again with points")
    return True


def _check_whole_numbers(text: str, width: int, name: str) -> None:
    """Raise where commas separate whole numbers in pairs, which may be decimal commas: 1,5,2,5,3,5."""
    if width < 6 or width % 2 or UNLIKE_WHOLE.search(text) or _has_signed_second(text):
        return
    raise TiskelError(
        f"{name}: its rows may be {width} whole numbers or {width // 2} with decimal commas; export it with points, "
        "or separate the columns by semicolons, or head all columns by name"
    )


def _has_signed_second(text: str) -> bool:
    """Return whether a second number of a pair has a sign, as no fraction has."""
    return any(cell.strip()[:1] in ("+", "-") for row in text.split("\n") for cell in row.split(",")[1::2])
