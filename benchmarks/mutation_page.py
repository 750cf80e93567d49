"""What became of the mutants of benchmarks/mutation.py: benchmarks/mutation.md, with every survivor."""

import ast
import difflib
import json
import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

SWITCH = "__mutmut_"  #: in the name of a mutant, between that of its function and its number
VERDICTS = ("killed", "out of time", "died", "survived", "no test")
UNSEEN = ("survived", "no test")
TOKENS = re.compile(r"""[rbf]*"[^"]*"|[rbf]*'[^']*'|\d[\d_.e+-]*|\w+|<=|>=|==|!=|\*\*|//|\S""")
COMPARISONS = {"<", "<=", ">", ">=", "==", "!=", "is", "in", "not"}
LONGEST = 150  #: characters of a line that is shown


class Change(NamedTuple):
    """A mutant: where it is, the changed lines before and after, and what became of it."""

    module: str
    function: str
    old: str
    new: str
    verdict: str

    @property
    def kind(self) -> str:
        """What was changed."""
        old, new = TOKENS.findall(self.old), TOKENS.findall(self.new)
        parts = difflib.SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
        gone = [word for what, a, b, _, _ in parts if what != "equal" for word in old[a:b]]
        come = [word for what, _, _, c, d in parts if what != "equal" for word in new[c:d]]
        if come and all(word[-1] in "\"'" for word in gone + come):
            return "text"
        if come == ["None"]:
            return "None in place of a value"
        if not [word for word in come if word not in ",)"]:
            return "argument left out"
        if all(word[0].isdigit() for word in gone + come):
            return "number"
        if COMPARISONS & {*gone, *come}:
            return "comparison"
        return "condition" if {"and", "or", "True", "False"} & {*gone, *come} else "operator or name"


def told_of(state: Path) -> Iterator[list[Any]]:
    """Yield name, verdict and seconds of all mutants that were run, each once."""
    lines = (line for path in sorted(state.glob("told.*.jsonl")) for line in path.read_text().splitlines())
    yield from {one[0]: one for one in map(json.loads, lines)}.values()


def changes(state: Path) -> Iterator[Change]:
    """Yield all mutants that were run."""
    sources: dict[str, dict[str, list[str]]] = {}
    for mutant, verdict, _ in sorted(told_of(state)):
        module, _, name = mutant.rpartition(".")
        if module not in sources:
            place = state / "tree" / module.replace(".", "/")
            text = (place / "__init__.py" if place.is_dir() else place.with_suffix(".py")).read_text()
            nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
            lines = text.splitlines()
            sources[module] = {node.name: lines[node.lineno : node.end_lineno] for node in nodes}
        function = name.split(SWITCH)[0]
        before, after = (sources[module][one] for one in (f"{function}{SWITCH}orig", name))
        pairs = list(difflib.unified_diff(before, after, lineterm="", n=0))[2:]
        old, new = (" ".join(one[1:].strip() for one in pairs if one[0] == sign) for sign in "-+")
        yield Change(module.removeprefix("tiskel."), function.removeprefix("x_"), old, new, verdict)


def table(head: str, counts: dict[str, "Counter[str]"]) -> str:
    """Return a table of verdicts, a row each and one of all."""
    rows = {**dict(sorted(counts.items())), "all": sum(counts.values(), Counter())}
    lines = [f"| {head} | mutants | {' | '.join(VERDICTS)} | noticed |", "|---" * (len(VERDICTS) + 3) + "|"]
    for name, row in rows.items():
        total = sum(row.values())
        noticed = 100 * (1 - sum(row[one] for one in UNSEEN) / max(total, 1))
        lines.append(f"| {name} | {total} | {' | '.join(str(row[one]) for one in VERDICTS)} | {noticed:.0f} % |")
    return "\n".join(lines)


def rooms(state: Path) -> str:
    """Return the table by room, for the page of reliability."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for mutant, verdict, _ in told_of(state):
        words = mutant.split(".")
        counts["/".join(words[1:-2] if "equations" not in words else words[1:-1])][verdict] += 1
    return table("room", counts)


def page(state: Path, why: str) -> str:
    """Return the page: counts, why mutants survive, and each that did."""
    found = list(changes(state))
    made = sum(map(len, json.loads((state / "mutants.json").read_text()).values()))
    modules: dict[str, Counter[str]] = defaultdict(Counter)
    kinds: dict[str, Counter[str]] = defaultdict(Counter)
    for one in found:
        modules[one.module][one.verdict] += 1
        kinds[one.kind][one.verdict] += 1
    listed: dict[str, list[Change]] = defaultdict(list)
    for one in found:
        if one.verdict in UNSEEN:
            listed[one.kind].append(one)
    parts = [why.format(run=len(found), made=made), table("change", kinds), table("module", modules), "## Survivors"]
    for kind, some in sorted(listed.items()):
        lines = [f"{o.module}.{o.function}\n  - {o.old[:LONGEST]}\n  + {o.new[:LONGEST]}" for o in some]
        parts.append(f"### {kind.capitalize()}\n\n```diff\n" + "\n".join(lines) + "\n```")
    return "\n\n".join(parts) + "\n"
