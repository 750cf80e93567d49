import numpy as np

from tiskel import skeletonize

points = np.load("scan.npy")
graph = skeletonize(points, bridge_gaps=0).to_networkx()
ends = [node for node in graph if graph.degree[node] == 1]
print(len(graph), "nodes,", len(ends), "ends, radius at the first", graph.nodes[ends[0]]["radius"])
