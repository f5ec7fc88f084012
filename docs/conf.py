"""How the documentation is built: `make docs`, or `python -m sphinx -W -b html docs build/docs`.

The pages ask nothing of the network: theme, icons and search lie beside them, formulas are MathML, and the references
of other projects (intersphinx) are off.
"""

import os
import sys
from pathlib import Path

import shaftprint

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))
# where a page that shows an example finds it to run it
os.environ["SHAFTPRINT_EXAMPLES"] = str(HERE.parent / "examples")
# and what it needs to show a command with its output
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(HERE / "_extensions"), os.environ.get("PYTHONPATH")]))

project = "shaftprint"
author = "the shaftprint authors"
copyright = "the shaftprint authors"
version = release = shaftprint.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.viewcode",
    "numpydoc",
    "mathml",
    "generated_reference",
    "glossary_tables",
    "made_once",
    "no_requests",
    "short_types",
]
exclude_patterns = ["_extensions"]
default_role = "code"
# Several rooms have a noun of the same name (WorkingPoint of a vessel and of signals); a link from a signature, where
# it stands without its room, then leads to the first of them.
suppress_warnings = ["ref.python"]

myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 4
html_math_renderer = "mathml"

# Tutorials are run when the pages are built, each in a folder of its own; what fails there fails the build.
nb_execution_mode = "cache"
nb_execution_in_temp = True
# a machine that tests beside it takes minutes for a cell of seconds
nb_execution_timeout = 1800
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_class_signature = "mixed"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

html_theme = "pydata_sphinx_theme"
html_title = "shaftprint"
html_static_path = ["_static"]
html_css_files = ["shaftprint.css"]
html_search_scorer = str(HERE / "_static" / "search_scorer.js")
html_context = {"default_mode": "auto"}
html_show_sourcelink = False
html_copy_source = False
html_sidebars = {page: [] for page in ("index", "start", "glossary")}
html_theme_options = {
    "show_prev_next": False,
    "header_links_before_dropdown": 8,
    "navigation_with_keys": True,
    "show_nav_level": 1,
    # hundreds of names: only the room that is being read is opened
    "collapse_navigation": True,
    "navigation_depth": 3,
    "navbar_align": "left",
    "navbar_persistent": ["search-button"],
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}
