"""Files around the package: workflows, forms, recipe and container agree with Makefile and pyproject.toml."""

from __future__ import annotations

import hashlib
import json
import re
import runpy
import tomllib
from pathlib import Path

import check_jsonschema
import pytest
import rattler_build
import yaml
from click.testing import CliRunner

from stridula.version import __version__

ROOT = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
FORMS = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
OLDEST = runpy.run_path(str(ROOT / "packaging" / "oldest.py"))
TARGETS = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
# Packages with other names in conda.
OF_CONDA = {"soundfile": "pysoundfile", "matplotlib": "matplotlib-base"}


def read(path: Path) -> dict:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def refused(command: str) -> list[str]:
    """Return the parts of a command that are neither the whole check nor existing targets of make."""
    parts = [part.split() for part in command.split("&&")]
    good = [words == [".ci/run"] or (words[0] == "make" and words[1] in TARGETS) for words in parts]
    return [" ".join(words) for words, is_good in zip(parts, good, strict=True) if not is_good]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_workflows_call_targets_that_exist(path):
    commands = [step["run"] for job in read(path)["jobs"].values() for step in job["steps"] if "run" in step]
    assert commands
    assert (ROOT / ".ci" / "run").is_file()
    assert [part for command in commands for part in refused(command)] == []


@pytest.mark.parametrize("command", ["make tset", "python -m pytest", "make dist && pip install ."])
def test_the_rule_can_fail(command):
    assert refused(command)


def test_every_python_of_the_classifiers_is_tested():
    said = [text.rpartition(" ")[2] for text in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", text)]
    matrix = read(ROOT / ".github" / "workflows" / "check.yml")["jobs"]["systems"]["strategy"]["matrix"]
    assert matrix["python"] == said
    assert PROJECT["requires-python"] == f">={said[0]}"


def unpinned(text: str) -> list[str]:
    """Return the actions that a workflow names by a tag, which may move, or without the release of their commit."""
    uses = re.findall(r"uses: *(.*)", text)
    return [use for use in uses if not re.fullmatch(r"[\w.-]+/[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", use)]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_actions_are_pinned_to_commits(path):
    text = path.read_text(encoding="utf-8")
    assert "uses:" in text
    assert unpinned(text) == []


@pytest.mark.parametrize("use", ["actions/checkout@v4", f"actions/checkout@{'a' * 40}", "actions/checkout"])
def test_actions_by_tag_are_found(use):
    """Negative control."""
    assert unpinned(f"      - uses: {use}\n") == [use]


def test_updates_cover_what_is_pinned():
    kinds = {one["package-ecosystem"] for one in read(ROOT / ".github" / "dependabot.yml")["updates"]}
    assert {"github-actions", "docker"} <= kinds


# SHA-256 of the files in three 0.180.0 on npm.
VENDORED = {
    "LICENSE-three.txt": "bfe119ea4fd413f5f7ca3fcd63adb0c4a073ed39daa2fe7d3e6b769e21272601",
    "three.core.min.js": "61ba0df005b05991361d040d8ff670e1aadfd0ce7aeebd1fdb0725957a8957de",
    "three.module.min.js": "e2b5ee6bccd38fd6d8a2428546b83c5f2426d84b152ef82be8055556e3b40eb6",
}


def test_files_of_third_parties_are_those_published():
    folder = ROOT / "src" / "stridula" / "app" / "page" / "vendor"
    assert {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()} == VENDORED


def misfits(schema: str, path: Path) -> str:
    """Return the output on a file that does not fit its published schema, empty if it does."""
    done = CliRunner().invoke(check_jsonschema.main, ["--builtin-schema", f"vendor.{schema}", str(path)])
    assert done.exit_code in (0, 1), done.output
    return done.output if done.exit_code else ""


SCHEMAS = [
    *[("github-workflows", path) for path in WORKFLOWS],
    *[("github-issue-forms", path) for path in FORMS],
    ("dependabot", ROOT / ".github" / "dependabot.yml"),
    ("citation-file-format", ROOT / "CITATION.cff"),
]


@pytest.mark.parametrize(("schema", "path"), SCHEMAS, ids=lambda word: getattr(word, "name", word))
def test_files_fit_their_published_schema(schema, path):
    assert misfits(schema, path) == ""


def test_a_workflow_with_a_wrong_key_does_not_fit(tmp_path):
    """Negative control."""
    text = WORKFLOWS[0].read_text(encoding="utf-8")
    (tmp_path / "wrong.yml").write_text(text.replace("timeout-minutes:", "timeout:"), encoding="utf-8")
    assert "timeout" in misfits("github-workflows", tmp_path / "wrong.yml")


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.name)
def test_forms_have_labelled_fields(path):
    form = read(path)
    assert {"name", "description", "body"} <= set(form)
    assert all(field["attributes"]["label"] and field["id"] for field in form["body"])


def test_hooks_are_those_of_lint():
    hooks = [hook for repo in read(ROOT / ".pre-commit-config.yaml")["repos"] for hook in repo["hooks"]]
    assert [hook["entry"] for hook in hooks] == ["python -m ruff format", "python -m ruff check"]


def test_versions_are_equal():
    assert read(ROOT / "packaging" / "conda" / "recipe.yaml")["context"]["version"] == __version__
    assert read(ROOT / "CITATION.cff")["version"] == __version__


def test_the_recipe_requires_what_the_project_does():
    extras = PROJECT["optional-dependencies"]
    texts = [*PROJECT["dependencies"], *(text for extra in OLDEST["EXTRAS"] for text in extras[extra])]
    needed = {tuple(line.split("==")) for line in OLDEST["oldest"](texts)}
    recipe = read(ROOT / "packaging" / "conda" / "recipe.yaml")
    found = {tuple(text.split(" >=")) for text in recipe["requirements"]["run"]} - {("python", "3.11")}
    assert found == {(OF_CONDA.get(name, name), release) for name, release in needed}
    assert recipe["about"]["license_file"] == PROJECT["license-files"]
    assert recipe["about"]["license"] == PROJECT["license"]


def test_the_recipe_is_rendered_by_its_builder(tmp_path):
    text = (ROOT / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    (rendered,) = rattler_build.Stage0Recipe.from_yaml(text).render()
    recipe = rendered.recipe
    assert (recipe.package.name, str(recipe.package.version)) == ("stridula", __version__)
    assert "numba >=0.62" in [str(one) for one in recipe.requirements.run]
    # Negative control.
    with pytest.raises(rattler_build.RecipeParseError):
        rattler_build.Stage0Recipe.from_yaml(text.replace("requirements:", "requirement:"))


def test_oldest_releases_are_the_lower_bounds():
    assert OLDEST["oldest"](["numpy>=2.0", "stridula[cli]", "tomli-w>=1.0"]) == ["numpy==2.0", "tomli-w==1.0"]
    with pytest.raises(SystemExit, match="a dependency must be name>=release, got 'numpy<3'"):
        OLDEST["oldest"](["numpy<3"])


def test_the_container_starts_the_page(stridula, monkeypatch):
    asked = []
    monkeypatch.setattr("stridula.app.serve.serve", lambda *words: asked.append(words))
    lines = dict(re.findall(r"^(ENTRYPOINT|CMD|EXPOSE) (.*)$", (ROOT / "Dockerfile").read_text("utf-8"), re.MULTILINE))
    assert json.loads(lines["ENTRYPOINT"]) == ["stridula"]
    assert stridula(*json.loads(lines["CMD"]))[0] == 0
    assert asked == [("0.0.0.0", int(lines["EXPOSE"]), True, False)]
