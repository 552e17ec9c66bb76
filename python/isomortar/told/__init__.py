"""What people are told of a scene and of its run: what is doubtful, and what it may be due to that nothing comes of it.

`before` a run by the scene, `during` it by what it comes to, and `after` it has given up.
"""
