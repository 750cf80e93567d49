"""Convex hulls of unit vectors, grown one vector at a time.

Points on a sphere are all corners of their hull, so that its triangulation grows as Delaunay's does (Lawson 1977): a
vector splits the face below it in three, and as long as it sees the face beyond an edge opposite to it, that edge is
flipped. Each flip takes a face into the star of the new vector, so that it ends, whatever rounding says. The face is
found by walking from the one before; vectors next to each other should come after one another.
"""

from .engine import ti

SAME = 1e-12  # what sticks out by less is a corner already, to rounding; a star about two of one place would fold
FLAT = 1e-13  # six times the volume of the first four vectors: below, they are in a plane to rounding


@ti.func
def volume(a, b, c, p) -> ti.f64:
    """Return six times the signed volume below p: positive where it sees the face a, b, c from outside."""
    return (a - p).cross(b - p).dot(p - c)


@ti.func
def farthest(vectors: ti.template(), first: ti.i32, stop: ti.i32, corners, known: ti.i32) -> ti.i32:
    """Return the vector that spans most with the corners that are known: a length, an area, a volume."""
    best = -1.0
    chosen = first
    a, b, c = vectors[corners[0]], vectors[corners[1]], vectors[corners[2]]
    for i in range(first, stop):
        p = vectors[i]
        span = (p - a).norm_sqr()
        if known == 2:
            span = (b - a).cross(p - a).norm_sqr()
        elif known == 3:
            span = ti.abs(volume(a, b, c, p))
        if span > best:
            best = span
            chosen = i
    return chosen


@ti.func
def relink(beside: ti.template(), face: ti.i32, old: ti.i32, new: ti.i32):
    """Replace a neighbour of a face."""
    for s in range(3):
        if beside[face, s] == old:
            beside[face, s] = new


@ti.func
def set_face(faces: ti.template(), beside: ti.template(), face, corners, neighbours):
    """Set the corners of a face, and its neighbours: each across the edge opposite to a corner."""
    for s in ti.static(range(3)):
        faces[face, s] = corners[s]
        beside[face, s] = neighbours[s]


@ti.func
def face_below(vectors: ti.template(), faces: ti.template(), beside: ti.template(), start: ti.i32, most: ti.i32, p):
    """Return the face that the ray to p meets, or one on the way after so many; walk from a face."""
    face, came = start, -1
    steps = 0
    walking = True
    while walking:
        a, b, c = vectors[faces[face, 0]], vectors[faces[face, 1]], vectors[faces[face, 2]]
        across = -1
        if b.cross(c).dot(p) < 0.0 and beside[face, 0] != came:
            across = 0
        elif c.cross(a).dot(p) < 0.0 and beside[face, 1] != came:
            across = 1
        elif a.cross(b).dot(p) < 0.0 and beside[face, 2] != came:
            across = 2
        steps += 1
        walking = across >= 0 and steps < most  # rounding could lead round in a circle
        if walking:
            came, face = face, beside[face, across]
    return face


@ti.func
def split(faces: ti.template(), beside: ti.template(), face: ti.i32, new: ti.i32, p: ti.i32):
    """Split a face in three at p, which becomes the last corner of each; the other two are new and the one after."""
    a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
    over_a, over_b, over_c = beside[face, 0], beside[face, 1], beside[face, 2]
    set_face(faces, beside, face, ti.Vector([a, b, p]), ti.Vector([new, new + 1, over_c]))
    set_face(faces, beside, new, ti.Vector([b, c, p]), ti.Vector([new + 1, face, over_a]))
    set_face(faces, beside, new + 1, ti.Vector([c, a, p]), ti.Vector([face, new, over_b]))
    relink(beside, over_a, face, new)
    relink(beside, over_b, face, new + 1)


@ti.func
def flipped(vectors: ti.template(), faces: ti.template(), beside: ti.template(), face: ti.i32) -> ti.i32:
    """Flip the edge opposite to the last corner where that sees the face beyond; return that face, -1 without a flip.

    Both faces have the corner last then.
    """
    a, b, p = faces[face, 0], faces[face, 1], faces[face, 2]
    other = beside[face, 2]
    k = 0
    for s in range(3):
        if faces[other, s] != a and faces[other, s] != b:
            k = s
    d = faces[other, k]
    result = -1
    if d != p and volume(vectors[b], vectors[a], vectors[d], vectors[p]) > 0.0:
        over_a, over_b = beside[face, 0], beside[face, 1]
        over_ad, over_db = beside[other, (k + 1) % 3], beside[other, (k + 2) % 3]
        set_face(faces, beside, face, ti.Vector([a, d, p]), ti.Vector([other, over_b, over_ad]))
        set_face(faces, beside, other, ti.Vector([d, b, p]), ti.Vector([over_a, face, over_db]))
        relink(beside, over_a, face, other)
        relink(beside, over_ad, other, face)
        result = other
    return result


@ti.func
def insert(
    vectors: ti.template(), faces: ti.template(), beside: ti.template(), stack: ti.template(), low, used, face, i
):
    """Put vector i into the hull at a face that it sees; the faces from low on are used in all."""
    split(faces, beside, face, low + used, i)
    stack[low], stack[low + 1], stack[low + 2] = face, low + used, low + used + 1
    waiting = 3
    while waiting > 0:
        top = stack[low + waiting - 1]
        other = flipped(vectors, faces, beside, top)
        if other < 0:
            waiting -= 1
        else:
            stack[low + waiting] = other
            waiting += 1


@ti.func
def first_faces(vectors: ti.template(), faces: ti.template(), beside: ti.template(), low: ti.i32, corners):
    """Set the four faces of a tetrahedron, seen from outside in counter-clockwise order."""
    a, b, c, d = corners[0], corners[1], corners[2], corners[3]
    if volume(vectors[a], vectors[b], vectors[c], vectors[d]) > 0.0:  # d sees the face: turn it round
        a, b = b, a
    set_face(faces, beside, low, ti.Vector([a, b, c]), ti.Vector([low + 2, low + 3, low + 1]))
    set_face(faces, beside, low + 1, ti.Vector([b, a, d]), ti.Vector([low + 3, low + 2, low]))
    set_face(faces, beside, low + 2, ti.Vector([c, b, d]), ti.Vector([low + 1, low + 3, low]))
    set_face(faces, beside, low + 3, ti.Vector([a, c, d]), ti.Vector([low + 2, low + 1, low]))


@ti.func
def grown(vectors: ti.template(), faces: ti.template(), beside: ti.template(), stack: ti.template(), low: ti.i32,
          used: ti.i32, face: ti.i32, slack: ti.f64, i: ti.i32):  # fmt: skip
    """Put vector i into a hull where it is further than the slack from it; return the face below and all in use."""
    p = vectors[i]
    below = face_below(vectors, faces, beside, face, used, p)
    a, b, c = vectors[faces[below, 0]], vectors[faces[below, 1]], vectors[faces[below, 2]]
    above, inside = volume(a, b, c, p), a.cross(b).dot(c)
    count = used
    # The ray meets the face at the share inside / (inside + above) of its way.
    if above > 0.0 and above * p.norm() > ti.max(slack, SAME) * (above + inside):
        insert(vectors, faces, beside, stack, low, used, below, i)
        count += 2
    return below, count


@ti.func
def area_of(vectors: ti.template(), faces: ti.template(), low: ti.i32, used: ti.i32) -> ti.f64:
    """Return the area of so many faces from low on."""
    total = 0.0
    for f in range(low, low + used):
        p = vectors[faces[f, 2]]
        total += 0.5 * (vectors[faces[f, 0]] - p).cross(vectors[faces[f, 1]] - p).norm()
    return total
