"""How accurate results are: a scene in other discretisations, fields at the same material points, and how far apart they are."""
