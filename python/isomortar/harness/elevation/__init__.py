"""Order-elevation convergence: what orders and meshes make of a scene's error, smoothness and cost."""
