"""How Sphinx makes pages of this folder's files; `make manual` runs it, after the blocks of the pages."""

from __future__ import annotations

from importlib import metadata

project = "isomortar"
author = "the isomortar developers"
release = metadata.version("isomortar")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx-mathjax-offline", "numpydoc"]  # formulas without a network, too
myst_enable_extensions = ["deflist", "dollarmath"]
mathjax3_config = {"tex": {"macros": {"thickspace": r"\;"}}}
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # tables that are generated begin at the level of a page's parts
html_theme = "furo"
html_title = f"isomortar {release}"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_show_sphinx = False
html_show_copyright = False
numpydoc_show_class_members = False
autodoc_typehints = "none"  # numpydoc's sections have them
