"""Imports between modules, cost of a plain import, documentation of public names."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import re
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path

import pytest

import stridula

ROOT = Path(stridula.__file__).parent
FILES = sorted(path for path in ROOT.rglob("*.py") if "__pycache__" not in path.parts)
HEAVY = ("numba", "xarray", "matplotlib", "scipy", "pandas", "pydantic", "typer", "rich", "h5netcdf", "dask")
# Packages and the modules that own them.
OWNED = {
    "skfem": ["bodies.revolution.fourier_elements", "bodies.solids.elements"],
    "meshio": ["bodies.revolution.mesh_files", "bodies.solids.mesh_files"],
}
# Each takes a quarter of a second or more to import, or imports others that do.
SLOW_PARTS = ("scipy.signal", "scipy.stats", "scipy.ndimage", "scipy.optimize", "scipy.interpolate")


def module_of(path: Path) -> str:
    """Dotted name of a file of the package, without the package itself."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports_of(source: str, module: str, package: bool) -> set[str]:
    """Absolute names of everything a module imports, at the top or inside functions, relative ones resolved."""
    found = set()
    home = ["stridula", *(module.split(".") if module else [])]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = home[: len(home) - node.level + (1 if package else 0)]
                base = ".".join([*above, *([base] if base else [])])
            found |= {f"{base}.{alias.name}" for alias in node.names} | {base}
    return found


@cache
def imports(path: Path) -> frozenset[str]:
    return frozenset(imports_of(path.read_text(encoding="utf-8"), module_of(path), path.name == "__init__.py"))


def violating(rule: Callable[[Path], object], paths: Sequence[Path] = FILES) -> dict[str, object]:
    """Return the violations of a rule by module, without the modules that have none."""
    found = {module_of(path) or "stridula": rule(path) for path in paths}
    return {module: violation for module, violation in found.items() if violation}


def roots(names: Iterable[str]) -> set[str]:
    return {name.split(".")[0] for name in names}


def messages_read(source: str) -> list[int]:
    """Return the lines on which a handler parses the text of an exception, other than stripping spaces."""
    found = []
    for handler in ast.walk(ast.parse(source)):
        for node in ast.walk(handler) if isinstance(handler, ast.ExceptHandler) and handler.name else ():
            looked_into = [node.value] if isinstance(node, ast.Attribute | ast.Subscript) else []
            if isinstance(node, ast.Compare):
                looked_into = [node.left, *node.comparators]
            texts = [f"str({handler.name})", f"{handler.name}.args[0]"]
            found += [node.lineno for part in looked_into if ast.unparse(part) in texts]
    return found


# The exception of TOML's parser has no fields: only its text has the end of the document.
READS_MESSAGES = {"scenarios.read"}


def test_no_code_parses_messages():
    assert set(violating(lambda path: messages_read(path.read_text(encoding="utf-8")))) == READS_MESSAGES


@pytest.mark.parametrize("use", ["str(error).replace('a', 'b')", "'got None' in str(error)", "str(error)[0]"])
def test_message_harness_finds_parsing_of_a_message(use):
    """Negative control."""
    assert messages_read(f"try:\n    f()\nexcept ValueError as error:\n    g({use})")
    assert not messages_read("try:\n    f()\nexcept ValueError as error:\n    g(str(error), error.argument)")


def test_arguments_are_refused_with_their_name_value_and_range():
    """Other kinds of ValueError have no argument: they are about a whole file or scenario."""
    left = [
        f"{module_of(path)}:{number}"
        for path in FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if re.search(r"raise ValueError\(f?\"(\{?[\w.]+\}?(\[.*\])?) must ", line)
    ]
    assert left == [] or all(one.startswith("bodies.mat") for one in left), left


def sees_kernels(names: Iterable[str]) -> bool:
    return any(name.startswith("stridula._kernels") for name in names)


def test_only_lowering_and_integration_see_the_kernels():
    seeing = violating(lambda path: sees_kernels(imports(path)))
    assert {module.split(".")[0] for module in seeing} == {"lowering", "integration", "_kernels"}


def test_kernels_import_only_numpy_numba_and_the_standard_library():
    allowed = {
        "numpy",
        "numba",
        "llvmlite",
        "collections",
        "inspect",
        "math",
        "operator",
        "types",
        "typing",
        "stridula",
    }

    def other(path: Path) -> set[str]:
        own = {name for name in imports(path) if name.startswith("stridula")}
        return (roots(imports(path)) - allowed) | {name for name in own if not name.startswith("stridula._kernels")}

    assert violating(other, sorted((ROOT / "_kernels").rglob("*.py"))) == {}


def test_matplotlib_is_for_figures_only():
    """In plot, in the figures of papers and verification, and for the picture formats of the command line."""
    using = violating(lambda path: "matplotlib" in roots(imports(path)))
    allowed = r"plot(\..*)?|papers\..*figures.*|verification\.figures|cli\.outputs"
    assert [module for module in using if not re.fullmatch(allowed, module)] == []


@pytest.mark.parametrize("package", OWNED)
def test_packages_with_an_owner_are_imported_there_alone(package):
    assert [module_of(path) for path in FILES if package in roots(imports(path))] == OWNED[package]


def test_nothing_inside_imports_the_package_root():
    """Public names are imported from their home."""
    known = {entry.stem for entry in ROOT.iterdir()} | {""}

    def from_root(path: Path) -> set[str]:
        names = imports(path) - {"stridula.version", "stridula.version.__version__"}
        return {name.split(".")[1] for name in names if name.startswith("stridula.")} - known

    assert violating(from_root) == {}


def test_import_harness_sees_a_forbidden_import():
    """Negative control: relative and absolute imports of the kernels, and one inside a function."""
    for source in (
        "from .._kernels import layout",
        "import stridula._kernels.march",
        "def f():\n    from .. import _kernels",
    ):
        assert sees_kernels(imports_of(source, "bodies.sections", package=False))
    assert sees_kernels(imports_of("from .._kernels.march import march", "bodies", package=True))
    assert not sees_kernels(imports_of("from ..checks import positive", "bodies.sections", package=False))


def loaded_after(code: str) -> set[str]:
    """Heavy packages loaded after `code` in a fresh interpreter."""
    listing = f"{code}; import sys; print(*(m for m in {(*HEAVY, *SLOW_PARTS, *OWNED)!r} if m in sys.modules))"
    done = subprocess.run([sys.executable, "-c", listing], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_plain_import_is_light():
    assert loaded_after("import stridula") == set()


def test_descriptions_need_no_compiler_and_no_records():
    code = "import stridula as st; st.ModalBeam(st.Material(1.0, 1.0), st.Circle(1.0), 1.0)"
    assert not loaded_after(code) & {"numba", "xarray", "matplotlib", *OWNED}


def test_a_body_of_revolution_loads_its_elements_when_modes_are_requested():
    code = (
        "import stridula as st; b = st.AxisymmetricBody("
        "st.RectangleProfile({'disc': ((0.1, 0.2), (0.0, 0.01))}), st.Material(2e11, 7800.0), 2e3, 'inner')"
    )
    assert not loaded_after(code) & {"numba", "xarray", "matplotlib", "meshio", *SLOW_PARTS, "skfem"}
    assert "skfem" in loaded_after(f"{code}; b.modes()")


def test_the_list_of_scenarios_needs_nothing_heavy():
    assert loaded_after("import stridula as st; st.list_scenarios()") == set()


def test_a_run_and_a_study_need_no_slow_parts():
    code = "import stridula.cli.running, stridula.cli.sweeping, stridula.cli.points, stridula.studies.ensembles"
    assert not loaded_after(code) & {"matplotlib", "dask", *SLOW_PARTS}


def test_light_import_harness_sees_a_heavy_one():
    """Negative control."""
    assert "numba" in loaded_after("import stridula; stridula.simulate")
    assert set(SLOW_PARTS) <= loaded_after("import scipy.signal")


def public() -> list[tuple[str, object]]:
    return [(name, getattr(stridula, name)) for name in stridula.__all__ if name != "__version__"]


def test_public_names_are_listed_once_and_resolve():
    assert len(set(stridula.__all__)) == len(stridula.__all__)
    assert set(dir(stridula)) >= set(stridula.__all__)
    with pytest.raises(AttributeError, match="no attribute 'squeal'"):
        _ = stridula.squeal


def modules_that_docs_name() -> set[str]:
    """Return the modules of the API page, and names in its code that are not public."""
    docs = Path(__file__).resolve().parents[2] / "docs"
    code = "".join(page.read_text(encoding="utf-8") for page in (*docs.glob("*.rst"), docs.parent / "README.md"))
    names = set(re.findall(r"\bst\.([a-z_]+(?:\.\w+)*)", code))
    api = re.findall(r'^    \("stridula\.([\w.]+)",', (docs / "conf.py").read_text(encoding="utf-8"), re.MULTILINE)
    return {name for name in names if name.partition(".")[0] not in stridula.__all__} | set(api)


# Each name in a copy of a process that has imported the package and nothing of it; other packages are loaded once.
EACH_ALONE = """
import os, sys
import matplotlib.figure, numba, pydantic, scipy.signal, scipy.sparse.linalg, scipy.stats, xarray
import stridula as st
assert "stridula.bodies" not in sys.modules
for name in sys.argv[1:]:
    child = os.fork()
    if not child:
        eval(f"st.{name}")
        os._exit(name.partition(".")[0] not in dir(st))
    if os.waitpid(child, 0)[1]:
        print(name)
"""


def test_modules_named_in_the_docs_exist_in_a_fresh_interpreter():
    def missing(*names: str) -> list[str]:
        done = subprocess.run([sys.executable, "-c", EACH_ALONE, *names], capture_output=True, text=True, check=True)
        return done.stdout.split()

    assert missing(*sorted(modules_that_docs_name())) == []
    # Negative control; the child prints its error.
    assert missing("plot", "nothing") == ["nothing"]


def test_names_of_the_api_page_exist_after_a_plain_import():
    """Packages and modules of names are attributes, and also have these names."""
    code = "import stridula as st; print(*(f'{name}:{hasattr(st, name)}' for name in dir(st)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = dict(one.split(":") for one in done.stdout.split())
    assert set(found.values()) == {"True"}
    assert {"acoustics", "analysis", "bodies", "contact", "drives", "integration", "plot", "records"} <= set(found)
    for home in ("acoustics", "acoustics.levels", "acoustics.sensation", "acoustics.wav"):
        assert set(stridula._HOME[home]) <= set(stridula.acoustics.__all__)
    for name in stridula.acoustics.__all__:
        assert getattr(stridula.acoustics, name) is getattr(stridula, name)


def test_docs_name_modules():
    assert {"analysis", "papers.laulagnet_2011", "plot", "studies.share_of"} <= modules_that_docs_name()


@pytest.mark.parametrize(("name", "thing"), public(), ids=[name for name, _ in public()])
def test_public_names_are_documented(name, thing):
    """Own docstring, not the signature from dataclass; and one for each public method and property."""
    if not (inspect.isclass(thing) or inspect.isroutine(thing)):
        return
    text = inspect.getdoc(thing) or ""
    assert len(text) > 10, name
    assert not text.startswith(f"{name}("), f"{name} has only the docstring that dataclass writes"
    if inspect.isclass(thing):
        for attribute, value in vars(thing).items():
            if not attribute.startswith("_") and (inspect.isroutine(value) or isinstance(value, property)):
                assert inspect.getdoc(value), f"{name}.{attribute}"


def documented_names(text: str) -> set[str]:
    """Names in the Parameters and Attributes of a numpydoc docstring."""
    found: set[str] = set()
    section = ""
    lines = inspect.cleandoc(text).splitlines()
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if below and set(below) == {"-"}:
            section = line.strip()
        elif section in ("Parameters", "Attributes") and re.match(r"^[\w, *]+ : ", line):
            found |= {name.strip(" *") for name in line.split(" : ")[0].split(",")}
    return found


def dataclasses_of_package() -> list[type]:
    """Every dataclass defined in the package whose name is public."""
    classes = set()
    for path in FILES:
        module = importlib.import_module(".".join(["stridula", module_of(path)]).rstrip("."))
        for name, thing in vars(module).items():
            own = inspect.isclass(thing) and thing.__module__ == module.__name__
            if own and dataclasses.is_dataclass(thing) and not name.startswith("_"):
                classes.add(thing)
    return sorted(classes, key=lambda thing: thing.__qualname__)


def test_each_field_of_a_dataclass_is_documented():
    """A time scheme's fields are the constants of its protocol, documented there."""
    missing = {}
    for thing in dataclasses_of_package():
        fields = {field.name for field in dataclasses.fields(thing) if not field.name.startswith("_")}
        if hasattr(thing, "first_increment"):
            fields -= {"name", "default_fraction"}
        missing[f"{thing.__module__}.{thing.__qualname__}"] = fields - documented_names(thing.__doc__ or "")
    assert {name: fields for name, fields in missing.items() if fields} == {}


def test_field_harness_sees_a_missing_field():
    """Negative control."""
    text = "Thing.\n\nParameters\n----------\nyoung : float\n    Modulus.\nx, y : float, optional\n    Place.\n"
    assert documented_names(text) == {"young", "x", "y"}
    assert not {"density"} <= documented_names(text)


def test_modules_have_a_docstring():
    assert violating(lambda path: not ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))) == {}


def opens_files(path: Path) -> bool:
    """Return whether a module calls `open`."""
    calls = (node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call))
    return any(isinstance(call.func, ast.Name) and call.func.id == "open" for call in calls)


def test_only_disk_opens_files():
    assert set(violating(opens_files)) == {"disk"}
