"""The measures of Tables 4.1 and 4.2, and where a report of tiskel metrics holds them."""

KEYS = {
    "d_B": ("topology", "bottleneck"), "d_W": ("topology", "wasserstein"),
    "bounded points": ("boundedness", "points"), "bounded curve": ("boundedness", "curve"),
    "centred points": ("centredness", "points"), "centred curve": ("centredness", "curve"),
    "smooth points": ("smoothness", "points"), "smooth curve": ("smoothness", "curve"),
}  # fmt: skip
