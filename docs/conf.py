"""Sphinx settings, and what is written before each build: the API page, tables, and the paper from end to end.

Everything written lies in ``_generated``, ``gallery`` or ``tutorials`` or is one of the pages ``api*.rst``; none
of it is kept under version control.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Sequence
from importlib import import_module
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from sphinx.application import Sphinx
from sphinx.util import logging

HERE = Path(__file__).resolve().parent
SOURCES = HERE.parent / "src"
EXAMPLES = HERE.parent / "examples"
GENERATED = HERE / "_generated"
PAPER = GENERATED / "paper"
VERIFICATION = GENERATED / "verification"
sys.path[:0] = [str(SOURCES), str(HERE)]
# Linear algebra in one thread, before NumPy is loaded: threads that wait for one another beside other checks take
# several times the processor time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import demonstration.page  # noqa: E402

import stridula  # noqa: E402

project = "stridula"
author = "The stridula developers"
copyright = "the stridula developers, BSD-3-Clause"
release = version = stridula.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    # Formulas without a network: MathJax is copied into the pages.
    "sphinx-mathjax-offline",
    "numpydoc",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]
templates_path = ["_templates"]
exclude_patterns = [
    "_build",
    "_generated/*.rst",
    "_generated/**/*.md",
    "_generated/examples/**",
    "paper-search.rst",
    "convergence-table.rst",
    "step-first-contacts-table.rst",
    "step-table.rst",
    "step-near-table.rst",
    "step-cutoff-table.rst",
    "peers.rst",
]
highlight_language = "python"
# Every name in a role has a page here; words of other projects are written as code.
nitpicky = True

autosummary_generate = True
autosummary_imported_members = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False
# Every public docstring is there, begins with one line that ends with a full stop, and names no argument that is not
# there, each with its type and in order. Not PR01: where names and units say it all, one line is enough.
numpydoc_validation_checks = {"GL03", "GL08", "PR02", "PR03", "PR04", "PR10", "SS03", "SS06"}

# Scripts are copied and run there, so that what they write lies with the rest of what is generated.
GALLERIES = {"gallery": EXAMPLES, "tutorials": EXAMPLES / "tutorials"}
sphinx_gallery_conf = {
    "examples_dirs": [f"_generated/examples/{name}" for name in GALLERIES],
    "gallery_dirs": list(GALLERIES),
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "capture_repr": ("_repr_html_",),
    "image_scrapers": ("shown",),
    "first_notebook_cell": "%matplotlib inline",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "write_computation_times": False,
    "min_reported_time": 1e6,
    "show_signature": False,
}

html_theme = "pydata_sphinx_theme"
html_title = f"stridula {version}"
html_static_path = ["_static"]
html_css_files = ["stridula.css", "demonstration/style.css"]
html_js_files = ["films.js"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "navbar_end": ["theme-switcher"],
    "navbar_persistent": ["search-button"],
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_toc_level": 1,
    "show_prev_next": False,
    "header_links_before_dropdown": 6,
}
# Pages without pages below them.
html_sidebars = {name: [] for name in ("index", "start", "coming-from", "limits", "glossary", "changelog")}

logger = logging.getLogger(__name__)

FIGURES = (
    "overview",
    "timeline",
    "friction",
    "mobility",
    "mac",
    "mode_shapes",
    "root_loci",
    "mode_probability",
    "mode_sensitivity",
    "calibration",
    "regime_map",
    "squeal_map",
    "squeal_events",
    "order_spectrum",
    "spectrogram",
    "spectrum",
    "waterfall",
    "third_octaves",
    "directivity",
    "surface",
    "system",
    "meshes",
    "bodies",
    "animate",
    "animate_surface",
    "animate_mode",
    "view",
    "view_mode",
    "Film",
    "save",
)
# The public names that do not live in the package root: module, title, names unless they are its ``__all__``.
MODULES: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("stridula.analysis", "Analysis of records", ()),
    ("stridula.plot", "Figures", FIGURES),
    ("stridula.scenarios", "More on scenarios", ()),
    ("stridula.studies", "More on ensembles and sweeps", ()),
    ("stridula.papers.laulagnet_2011", "Laulagnet 2011", ()),
)
# The tables of scenarios with which a page of keys begins: its name and title.
KEYS = {
    "": ("pair", "Keys of two beams"),
    "bodies: finite-element beam": ("bodies", "Keys of bodies"),
    "bodies: axisymmetric": ("meshed", "Keys of bodies with meshes"),
    "contacts": ("contacts", "Keys of contacts and surfaces"),
    "connections: spring": ("connections", "Keys of connections, drives and simulation"),
}
HOMES = {
    "bodies": "Bodies",
    "contact": "Contacts and friction",
    "checks": "Refused arguments",
    "connections": "Connections",
    "doubtful": "Doubtful values",
    "acoustics.levels": "Sound levels",
    "acoustics.sensation": "Psychoacoustics",
    "acoustics.squeals": "Squeal events",
    "acoustics.listening": "Sound in notebooks",
    "acoustics.wav": "Sound files",
    "drives": "Drives",
    "histories": "Histories of drives",
    "signals": "Measured signals",
    "system": "System",
    "records": "Probes",
    "records.files": "Files of records",
    "records.export": "Export",
    "records.plain": "Plain records",
    "records.compare": "Comparison of records",
    "records.repeated": "Limit cycles over time",
    "integration": "Integration in time",
    "analysis": "Regimes",
    "analysis.record_card": "Cards of records",
    "analysis.identification": "Modes of measured mobilities",
    "analysis.mobilities": "Mobilities",
    "analysis.mode_effects": "Effects of parameters",
    "analysis.shape_agreement": "Agreement of mode shapes",
    "analysis.stability": "Linear stability",
    "bars": "Progress",
    "cycles": "Limit cycles",
    "acoustics": "Radiated sound",
    "reports": "Reports",
    "scenarios": "Scenarios",
    "studies": "Studies of many runs",
}


# Beginnings of the homes of names on the second page.
MEASURES = ("acoustics", "analysis", "bars", "cycles", "reports", "signals", "studies")


def write(path: Path, text: str) -> None:
    """Write a text unless it is already there, so that unchanged pages are not built again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def write_pages(folder: Path, pages: dict[str, str]) -> None:
    """Write the pages of a folder, and forget those that are no more."""
    for old in folder.glob("*.rst"):
        if old.stem not in pages:
            old.unlink()
    for name, text in pages.items():
        write(folder / f"{name}.rst", text)


def list_table(head: Sequence[str], rows: Iterable[Sequence[str]], widths: Sequence[int]) -> str:
    """Return a table in reStructuredText."""
    lines = [".. list-table::", "   :header-rows: 1", f"   :widths: {' '.join(map(str, widths))}", ""]
    for row in (head, *rows):
        lines += [f"   * - {row[0]}", *(f"     - {cell}" for cell in row[1:])]
    return "\n".join(lines) + "\n"


def plain(text: str) -> str:
    """Return a text with the signs that reStructuredText reads as markup made harmless."""
    for sign in "\\*`|_":
        text = text.replace(sign, f"\\{sign}")
    return text


# The API page


def api_page() -> str:
    """Return the page of the public names of the package itself, grouped like the folders."""
    parts = [
        "API",
        "===",
        "",
        "Attributes of ``stridula`` itself, grouped like the folders of the package; :doc:`api-measures` has those of",
        "measures, sound and studies. :doc:`api-modules` lists the public names of its modules.",
        "",
        ".. toctree::",
        "   :hidden:",
        "",
        "   api-measures",
        "   api-modules",
        "",
    ]
    return "\n".join([*parts, *api_groups(False)])


def api_measures_page() -> str:
    """Return the page of the public names of the package that take records, signals and sound, or make many runs."""
    title = "API of measures, sound and studies"
    return "\n".join([title, "=" * len(title), "", *api_groups(True)])


def api_groups(measures: bool) -> list[str]:
    """Return the groups of names of one of the two pages."""
    parts: list[str] = []
    for home, names in stridula._HOME.items():
        if home.startswith(MEASURES) == measures:
            parts += api_group(HOMES.get(home, home), f"stridula.{home}", "stridula", names)
    return parts


def api_modules_page() -> str:
    """Return the page of the public names of modules."""
    parts = ["API of modules", "==============", ""]
    for module, title, names in MODULES:
        there = import_module(module)
        # A figure and what it draws may have one name.
        own = [one for one in names or there.__all__ if getattr(there, one) is not getattr(stridula, one, None)]
        if own:
            parts += api_group(title, module, module, own)
    return "\n".join(parts)


def drop_stale_stubs(page: str) -> None:
    """Delete the pages of names that are public no longer."""
    listed, module = set(), ""
    for line in page.splitlines():
        if line.startswith(".. currentmodule::"):
            module = line.split()[-1]
        elif line.startswith("   ") and line.strip().isidentifier():
            listed.add(f"{module}.{line.strip()}.rst")
    for stub in (GENERATED / "api").glob("*.rst"):
        if stub.name not in listed:
            stub.unlink()


def api_group(title: str, home: str, module: str, names: Iterable[str]) -> list[str]:
    """Return one group of the page."""
    listed = [name for name in names if documented(getattr(import_module(module), name))]
    return [
        title,
        "-" * len(title),
        "",
        f"``{home}``",
        "",
        f".. currentmodule:: {module}",
        "",
        ".. autosummary::",
        "   :toctree: _generated/api",
        "   :nosignatures:",
        "",
        *(f"   {name}" for name in listed),
        "",
    ]


def documented(value: Any) -> bool:
    """Return whether autosummary has a page for a value: a class or a function, not a constant."""
    return callable(value)


# Tables from the sources


def variables_table() -> str:
    """Return the table of recorded variables."""
    from stridula.records.variables import CONTACT, ENERGY, PROBES, STATUS, STATUS_SHARE

    groups = ((*CONTACT, STATUS, STATUS_SHARE), ENERGY, PROBES.values())
    rows = [
        [f"``{v.name}``", v.units.replace("m/s2", "m/s²"), plain(v.long_name), v.cell_methods]
        for group in groups
        for v in group
    ]
    return list_table(["variable", "unit", "meaning", "over the interval"], rows, [24, 8, 52, 16])


def equilibrium_table() -> str:
    """Return the table of what linear theory says of the equilibrium."""
    from stridula.records.variables import EQUILIBRIUM

    rows = [[f"``{v.name}``", plain(v.units), plain(v.long_name)] for v in EQUILIBRIUM.values()]
    return list_table(["variable", "unit", "meaning"], rows, [26, 14, 60])


def scenario_pages() -> dict[str, str]:
    """Return pages with a table of keys for every table of a scenario file, by their names."""
    from stridula.scenarios.schema import ScenarioTable

    seen: dict[type, str] = {}
    collect(ScenarioTable, "", seen)
    pages: dict[str, str] = {}
    for model, path in seen.items():
        if path in KEYS:
            name, title = KEYS[path]
            pages[name] = f"{title}\n{'=' * len(title)}\n\n"
        texts = model.descriptions()  # type: ignore[attr-defined]
        rows = [[f"``{key}``", default(field), plain(texts.get(key, ""))] for key, field in fields(model).items()]
        head = path or "Top of the file"
        pages[name] += f"{head}\n{'-' * len(head)}\n\n{list_table(['key', 'default', 'meaning'], rows, [22, 18, 60])}\n"
    return pages


def fields(model: type) -> dict[str, Any]:
    """Return the keys of a table."""
    return model.model_fields  # type: ignore[attr-defined, no-any-return]


def collect(model: type, path: str, seen: dict[type, str]) -> None:
    """Note the title of a table and of those inside it, each once."""
    seen[model] = path
    for key, field in fields(model).items():
        inner = list(tables_in(field.annotation))
        for table in inner:
            if table not in seen:
                word = kind_of(table) if len(inner) > 1 else ""
                collect(table, f"{key}: {word}" if word else key, seen)


def kind_of(table: type) -> str:
    """Return what tells a table from its alternatives, such as ``ramp``."""
    tag = next((key for key in ("shape", "kind", "law", "quantity") if key in fields(table)), None)
    return " or ".join(get_args(fields(table)[tag].annotation)) if tag else ""


def tables_in(annotation: Any) -> Iterable[type]:
    """Yield the tables that an annotation allows."""
    if hasattr(annotation, "model_fields"):
        yield annotation
    elif get_origin(annotation) in (Union, UnionType, Annotated, list, dict):
        for argument in get_args(annotation):
            yield from tables_in(argument)


def default(field: Any) -> str:
    """Return the default of a key in words."""
    if field.is_required():
        return "needed"
    value = field.get_default(call_default_factory=True)
    if value is None or value in ("", []):
        return "none"
    return f"``{value:.6g}``" if isinstance(value, float) else f"``{value}``"


def shipped_table() -> str:
    """Return the table of shipped scenarios."""
    from stridula.scenarios import list_scenarios, load_scenario

    cases = [(case, load_scenario(case.name).description) for case in list_scenarios()]
    rows = [[f"``{case.name}``", plain(words), plain(case.source)] for case, words in cases]
    return list_table(["name", "what happens", "source"], rows, [20, 52, 28])


def check_measures() -> None:
    """Warn if a measure is missing on its page."""
    from stridula import analysis

    page = (HERE / "measures.rst").read_text(encoding="utf-8")
    for name in analysis.__all__:
        if not any(
            words in page
            for words in (f":func:`{name}`", f":func:`{name} <", f":class:`{name}`", f"``analysis.{name}``")
        ):
            logger.warning("measures.rst does not say what %s is", name)


# The examples


def copy_examples() -> None:
    """Copy the scripts of the galleries with their headers, decks and tables, and forget those that are no more."""
    for name, folder in GALLERIES.items():
        kinds = ("py", "rst", "inp", "csv", "sti", "mas", "dof")
        sources = {path.name: path for kind in kinds for path in folder.glob(f"*.{kind}")}
        for old in (GENERATED / "examples" / name).glob("*"):
            if old.name not in sources:
                old.unlink()
        for path in sources.values():
            write(GENERATED / "examples" / name / path.name, path.read_text(encoding="utf-8"))


# The paper


def is_stale(written: Path) -> bool:
    """Return whether what was written is missing or older than the sources."""
    newest = max(path.stat().st_mtime for path in SOURCES.rglob("*") if path.suffix in (".py", ".toml"))
    return not written.exists() or written.stat().st_mtime < newest


def reproduce_paper() -> None:
    """Run every case of the paper into ``_generated/paper`` unless what is there is newer than the sources."""
    from stridula.papers.laulagnet_2011 import reproduce

    if is_stale(PAPER / "claims.json"):
        logger.info("the paper from end to end (about two minutes)")
        reproduce(PAPER, lambda name: logger.info("  %s", name))


def claims_page() -> str:
    """Return the table of claims and what lies behind some of them."""
    from stridula.papers.laulagnet_2011.reproduce import measured

    rows = json.loads((PAPER / "claims.json").read_text(encoding="utf-8"))
    held = sum(row["holds"] for row in rows)
    cells = []
    for row in rows:
        holds = "yes" if row["holds"] else "**no**"
        first = [row["section"], row["claim"], row["printed"], measured(row), row["tolerance"]]
        cells.append([*map(plain, first), holds, row["basis"]])
    head = ["section", "claim", "printed", "measured", "holds when", "holds", "basis"]
    words = [f"{row['section']} {row['claim']}: {row['detail']}" for row in rows if "detail" in row]
    details = [f"- {plain(word)}" for word in words]
    table = list_table(head, cells, [7, 28, 15, 13, 17, 8, 12])
    return "\n".join([f"{held} of {len(rows)} hold.", "", table, *details, ""])


def figures_page() -> str:
    """Return the figures, case by case."""
    from stridula.papers.laulagnet_2011.figures import FIGURES

    lines: list[str] = []
    for figure in FIGURES:
        lines += [
            f".. figure:: /_generated/paper/{figure.file_name}",
            f"   :alt: {plain(figure.caption)}",
            "   :width: 100%",
            "",
            f"   Figure {figure.number} of the paper, case ``{figure.case}``: {plain(figure.caption)}.",
            "",
        ]
    return "\n".join(lines)


# The verification


def run_verification() -> None:
    """Run every verification case into ``_generated/verification`` unless that is newer than the sources."""
    from stridula.verification import verify

    if is_stale(VERIFICATION / "verification.json"):
        logger.info("the verification (about two minutes)")
        verify(VERIFICATION, report=lambda line: logger.info("  %s", line))


def verified() -> list[dict[str, Any]]:
    """Return the rows of all cases."""
    return json.loads((VERIFICATION / "verification.json").read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def verification_summary() -> str:
    """Return a table of the cases, each with a link to its page."""
    from stridula.verification.cases import CASES

    rows = verified()
    good = sum(row["holds"] for row in rows)
    cells = []
    for case in CASES:
        own = [row["holds"] for row in rows if row["case"] == case.name]
        within = f"{sum(own)} of {len(own)}" if own else "not run here"
        cells.append([f":doc:`/_generated/verified/{case.name}`", plain(case.source), within])
    tree = [".. toctree::", "   :hidden:", "", *(f"   /_generated/verified/{case.name}" for case in CASES)]
    table = list_table(["case", "source", "quantities within"], cells, [34, 50, 16])
    return "\n".join([f"{good} of {len(rows)} quantities are within their tolerance.", "", table, *tree, ""])


def verification_pages() -> dict[str, str]:
    """Return a page for each case, its figure and its rows, by its name."""
    from stridula.verification.cases import CASES

    head = ["quantity", "scheme", "expected", "obtained", "error", "tolerance", "within", "tolerance from"]
    rows, pages = verified(), {}
    for case in CASES:
        lines = [case.title, "=" * len(case.title), "", f"Source: {plain(case.source)}.", ""]
        lines += [f".. figure:: /_generated/verification/{case.name}.png", f"   :alt: {plain(case.title)}", ""]
        cells = [verification_cells(row) for row in rows if row["case"] == case.name]
        lines += [list_table(head, cells, [17, 10, 12, 12, 9, 9, 6, 25]) if cells else "Not run here.\n"]
        pages[case.name] = "\n".join(lines)
    return pages


def verification_cells(row: dict[str, Any]) -> list[str]:
    """Return the cells of one quantity."""
    unit = "" if row["units"] == "1" else f" {row['units']}"
    numbers = [
        "none" if row[name] is None else f"{row[name]:.{digits}g}{unit}"
        for name, digits in (("expected", 7), ("obtained", 7), ("error", 2), ("tolerance", 2))
    ]
    words = map(plain, (row["quantity"], row["scheme"] or "-", *numbers))
    return [*words, "yes" if row["holds"] else "**no**", plain(row["reason"])]


def setup(app: Sphinx) -> None:
    """Write what is generated, before Sphinx looks for pages."""
    pages = {"api": api_page(), "api-measures": api_measures_page(), "api-modules": api_modules_page()}
    drop_stale_stubs("\n".join(pages.values()))
    for name, text in pages.items():
        write(HERE / f"{name}.rst", text)
    write(GENERATED / "variables.rst", variables_table())
    write(GENERATED / "equilibrium.rst", equilibrium_table())
    write_pages(GENERATED / "keys", scenario_pages())
    write(GENERATED / "shipped.rst", shipped_table())
    write(GENERATED / "demonstration.html", demonstration.page.html())
    check_measures()
    copy_examples()
    reproduce_paper()
    write(GENERATED / "claims.rst", claims_page())
    write(GENERATED / "figures.rst", figures_page())
    run_verification()
    write(GENERATED / "verification.rst", verification_summary())
    write_pages(GENERATED / "verified", verification_pages())
