# SPDX-License-Identifier: MIT
"""Sphinx's settings for the site; prepare.py makes the pages, build.sh starts both."""

import os
import pathlib
import re
import sys

from pygments.lexers.special import TextLexer

sys.path.insert(0, os.path.dirname(__file__))
import debian_furo  # noqa: E402

root = pathlib.Path(os.environ["GATEWALK_ROOT"])

project = "gatewalk"
author = copyright = "the gatewalk authors"
cmake = (root / "CMakeLists.txt").read_text(encoding="utf-8")
release = version = re.search(r"^project\(gatewalk VERSION ([\d.]+)", cmake, re.M)[1]
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]

myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 4
highlight_language = "none"
smartquotes = False  # "--set" is an option

autodoc_typehints = "none"
autodoc_member_order = "bysource"
default_role = "py:obj"  # `predict` in a docstring
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_custom_sections = [("Keys of the result", "params_style")]

breathe_projects = {"gatewalk": os.environ["GATEWALK_XML"]}
breathe_default_project = "gatewalk"
breathe_show_include = False  # the heading above says it whole

html_theme = "furo"
html_title = f"gatewalk {version}"
html_css_files = ["site.css"]
html_static_path = [os.path.join(os.path.dirname(__file__), "static")]
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # which only a web server could give
html_theme_options = {"navigation_with_keys": True}


def setup(app):
    app.add_lexer("csv", TextLexer)
    app.connect("build-finished", lambda app, error: error or debian_furo.repair(pathlib.Path(app.outdir, "_static")))
