"""The table of levels that warnings are raised at; what each warning is, says :mod:`tiskel.methods.robust.doubts`.

Found by trial on the shapes of the gallery, clean, noisy and with parts missing.
"""

import numpy as np

from tiskel.params import MetricParams

PLACES = MetricParams().curve_samples  # on the curve: those of the measures, so that shares agree
MOST_PLACES = 20_000  # on the curve, where points look for the nearest
SURFACE_POINTS = 16_384  # of larger clouds so many are taken to ask for inside and outside
AIR_SHARE = 0.01  # of the length in the air, bridges aside
HOLE = 1.5  # radii; half the length of a hole in the scan: points before and behind it count as about the curve
AIR_SERIOUS = 0.02  # of the length that is in the air even so: from there on it is a warning
# Of the length in the air, over holes and bridges too: from there on it is a warning [true curves of which a fifth of
# the surface is missing to 0.052].
AIR_MUCH = 0.06
CLEARLY_OUTSIDE = 0.25  # winding number; holes in the scan take some away from places inside
THICK = 2.0  # spacings in a radius; where nothing is thicker there is no inside to speak of
OUTSIDE_SHARE = 0.05  # of the places outside the body
OUTSIDE_SURELY_NOT = OUTSIDE_SHARE / 2  # the same by the solid that the curve was made with: nobody looks twice
FAR_RADII = 2.5  # radii of the curve; a flattened limb of 4 : 1 reaches twice its mean half-width
FAR_SPACINGS = 3.0  # spacings on top of these: points are noisy
FAR_SHARE = 0.02  # of the points so far away
FLAT = 0.15  # ratio of how much normals spread both ways across the curve; flat below it
FLAT_SHARE = 0.2  # of the points at such nodes
MOSTLY = 0.5  # of the flat points: from there on it is known that they are a sheet
MOST = 0.9  # of the flat points, whose distance from their node is half a width
LONG = 3.0  # widths that a flat body is long at least, to have a middle line [straps and flat tubes from 4; plates 2]
TO_AND_FRO = 1.5  # extents of a flat body, from which on a curve runs along its rims rather than its middle
INSIDE = 0.9  # of the points behind which is an inside: with fewer a tube may be none [right smooth tubes from 0.93]
TUBES = 0.75  # of the nodes on tubes that are thick, from which on a body has to have an inside
# Spacings that points are beside the planes of the nearest ones, up to which a cloud is smooth [bundles of strands 0.14
# to 0.46; noise that hides the inside from 0.51, which says nothing against the curve].
ROUGH = 0.48
SHORT = 1.0  # largest radii that a curve is long at least, to be one
BRIDGED_SHARE = 0.2  # of the length over gaps: from there on it is more guess than curve
LEFT_OUT_SHARE = 0.05  # of the points: from there on they are no dust
ONE_SIDED_SHARE = 0.2  # of the nodes with points on one side only
# Of the turn about tubes without points, in radians, and of the length of the curve that has so much of it: from there
# on what was seen says too little of the middle [right curves of shapes that lack 30 % of their surface have less].
EMPTY, EMPTY_SHARE = 2 * np.pi / 3, 0.9
THIN_SHARE = 0.05  # of the nodes whose radius is a bound
OPEN_SHARE = 0.1  # of the ends that face another part over a gap: below it a crown lacks a twig or two
TOUCHING = 3.0  # spacings, besides its radius, between an end and another part of the curve that it lies at
APART = 10.0  # spacings along the curve from an end, at least, to be another part
APART_RADII = 4.0  # the same in the sum of the radii at both
CONTACTS = 0.1  # of the ends that lie at another part: from there on it is told
CONTACTS_SERIOUS = 0.4  # from there on limbs may be cut and joined wrongly, where points are noisy:
NOISY = 0.45  # spacings that points lie from the cones, root mean square, from which on noise says which limbs touch
SELDOM = 0.1  # loops for each end of a crown, up to which they may be limbs that touch [networks have more than ends]
NET = 10  # loops of wires, from which on they may be chance: ways from one wire to the next beside it
MESH = 80.0  # spacings of length for each such loop, below which they are taken for that [coils 46, stents from 172]
