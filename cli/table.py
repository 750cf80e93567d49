"""The table of commands: what each is for, and where it is."""

from typing import NamedTuple


class Entry(NamedTuple):
    """Where a command is, what it is for, and the first paragraph of its help."""

    module: str
    function: str
    purpose: str
    summary: str
    bare: bool = False  # does something without arguments, where the others show their help


CURVE, JUDGE, SURFACE, WHOLE, FILES, HERE = PURPOSES = (
    "From a cloud to its curve", "How good a curve is", "Surfaces and rolling", "All in one go, many and large clouds",
    "Files, pictures and shapes", "This installation",
)  # fmt: skip
COMMANDS = {
    "contract": Entry("contract", "contract", CURVE, "Contract a cloud or mesh towards its medial curve."),
    "skeleton": Entry("skeleton", "skeleton", CURVE, "Turn a contracted cloud, or a cloud, into a curve skeleton."),
    "metrics": Entry(
        "metrics", "metrics", JUDGE,
        "Say how good skeletons are: topology, boundedness, inside, medialness, air, centredness and more.",
    ),
    "stability": Entry(
        "stability", "stability", JUDGE,
        "Say whether a contraction is stable: how normals and curvatures change from step to step.",
    ),
    "compare": Entry(
        "compare", "compare", JUDGE,
        "Say whether two skeletons of one body are alike: the same graph, ends and length, how far apart both ways.",
    ),
    "slice": Entry(
        "slice", "slice_command", SURFACE,
        "Fit a smooth surface around every branch of a skeleton, slice by slice, and one surface to the whole body.",
    ),
    "roll": Entry("roll", "roll", SURFACE, "Roll a sphere over a surface."),
    "plan": Entry(
        "plan", "plan", SURFACE,
        "Plan how to roll a sphere from a contact to another, and to an attitude, without slip.",
    ),
    "run": Entry(
        "run", "run", WHOLE,
        "Do everything in one go: stage files, exports, measures, surfaces, a roll, pictures and a report in one "
        "folder.",
    ),
    "batch": Entry(
        "batch", "batch", WHOLE,
        "Do many clouds: all that run does, a sub-folder each; resumable, on one machine or many.",
    ),
    "split": Entry(
        "split", "split", WHOLE, "Cut a cloud that is too large into tiles that overlap, or into its objects.",
    ),
    "join": Entry("join", "join", WHOLE, "Make one skeleton of those of tiles or objects."),
    "info": Entry(
        "info", "info", FILES,
        "Say what a file holds: points and extent of a cloud, steps of a contraction, counts of a skeleton, surfaces.",
    ),
    "convert": Entry("convert", "convert", FILES, "Convert a cloud, a mesh or a skeleton to another format."),
    "view": Entry(
        "view", "view", FILES,
        "Show clouds, curves, surfaces and runs together: a page that turns under the mouse, or a picture.",
    ),
    "shape": Entry(
        "shape", "shape", FILES, "Make a cloud whose curve skeleton is known: tubes, plants, blocks, torsos, wires.",
        bare=True,
    ),
    "doctor": Entry(
        "doctor", "doctor", HERE, "Check the installation: versions, optional parts, threads, and that a kernel runs.",
        bare=True,
    ),
}  # fmt: skip
