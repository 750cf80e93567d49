"""Method "robust": fronts over the original cloud, the graph of their sections, round cones fitted to the cloud.

docs/robust.md shows each step on a cloud. The algorithm:

1. Large clouds are thinned to what their surface needs, noise is averaged. Neighbours along the surface of every
   point, its normal and its spacing, in the cloud's own axes.
2. A front runs from an end over this graph; the connected pieces of each bin of geodesic distance are sections.
3. Points move to the axes of their sections; two more fronts run over the contracted cloud.
4. The sections, joined where their points are neighbours, are a Reeb graph; cycles that bound a disc inside the
   body are closed, spurs go, junctions that are close become one.
5. Round cones are fitted to the cloud along the graph; branches that they miss grow, branches that explain nothing
   go, junctions move to where their branches meet, ends grow into the tips, gaps in the scan are bridged.
6. The misfit says how far the curve is to be trusted: places outside the body, points far from the cones, loops
   unlike the handles of the solid. While there is much of it, further fronts from other ends are tried.
7. Three regimes: what is thinner than its points are apart is a wire, whose curve follows the points (wire/, chosen in
   regimes.py), thick limbs among them are tubes still; where less of the turn about a node was seen than tells an
   axis, the curve lies on what was seen (sheets.py). Nodes say their regime and what their radius is worth.
8. What a user should doubt is drawn from the curve, the cloud and the solid alone (doubts.py), whatever made the curve.

Sources: Reeb graphs of geodesic distance, Verroust and Lazarus 2000, Ge et al. 2011; axes from normals, Tagliasacchi
et al. 2009 (ROSA); models of round cones, Thiery et al. 2013; winding numbers of clouds, Barill et al. 2018; curves of
wires, Sato et al. 2000 (TEASAR).
"""
