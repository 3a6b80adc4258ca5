# Everything runs in .venv, made on first use; nothing but Python 3.11 or later, its venv module and make is needed.
ifeq ($(OS),Windows_NT)
PYTHON ?= python
PROGRAMS := Scripts
else
PYTHON ?= python3
PROGRAMS := bin
endif
# Hundreds of processes import the package: none of them compiles it again, whatever the surroundings say.
unexport PYTHONDONTWRITEBYTECODE
BIN := .venv/$(PROGRAMS)
OLDEST := .venv-oldest/$(PROGRAMS)
FAST := .venv-fast/$(PROGRAMS)
# A part of the tests that goes through the package and takes neither a browser nor what Debian has.
SMOKE := tests/unit/test_simulate.py tests/unit/test_scenarios.py tests/unit/test_files.py tests/unit/test_extras.py \
	tests/unit/test_plot.py tests/hearing/test_wav.py tests/kernels/test_plain_python.py tests/physics/test_natural_frequencies.py

# Tests of modes of meshes, which the libraries of the extra `fast` factorise.
MESHES := tests/unit/test_block_lanczos.py tests/unit/test_sparse_bodies.py tests/unit/test_solid_body.py \
	tests/physics/test_solid_bodies.py

.PHONY: help paper verify peers test examples smoke oldest fast lint docs dist bench convergence clean

help:
	@echo "make paper        run every case of the paper into results/paper (sets itself up)"
	@echo "make verify       run every case whose answer is known into results/verify; fails if one falls short"
	@echo "make peers        the same systems in Siconos and here, cycles in pyHarm and here; each is skipped where it is not installed"
	@echo "make test         lint, types, layers and tests (sets itself up)"
	@echo "make examples     all code and commands of the documentation, all examples, the short form of every benchmark"
	@echo "make smoke        a part of the tests, for other systems and Pythons"
	@echo "make oldest       the same with the oldest dependencies that pyproject.toml allows, on Python 3.11 or 3.12"
	@echo "make fast         the tests of meshes with the extra that factorises them faster, of 0.8 GB"
	@echo "make docs         build the documentation into docs/_build/html, warnings are errors"
	@echo "make dist         wheel and sdist into dist, both checked, the wheel run on its own; minutes"
	@echo "make bench        speed as a table of ratios, each measured in one run: C, Siconos, real time, scaling, start-up; minutes"
	@echo "make convergence  the tables and figures of docs/convergence.rst, docs/step-of-two-beams.rst and docs/trust.rst, in a quarter of an hour"
	@echo "make clean        remove .venv and everything built"

# Python compiles on import what is used: pip would compile all of every package, which takes as long as installing it.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable

.venv/created:
	$(PYTHON) -m venv .venv
	@touch $@

.venv/installed-%: pyproject.toml | .venv/created
	$(INSTALL) ".[$*]"
	@touch $@

paper: .venv/installed-all
	$(BIN)/stridula paper

verify: .venv/installed-all
	$(BIN)/stridula verify

peers: .venv/installed-all
	$(BIN)/python benchmarks/against_siconos.py
	$(BIN)/python benchmarks/cones.py
	$(BIN)/python benchmarks/against_pyharm.py

lint: .venv/installed-dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

# What describes and measures the package is tested apart from it.
DESCRIBED := tests/examples tests/benchmarks

# Every kind of march, once: processes of the tests that need one at the same time would each compile it.
compiled-%: .venv/installed-dev
	PYTHONPATH=tests $(BIN)/python -m kernels.every_kind $* > .venv/$@

test: .venv/installed-dev
	$(MAKE) --jobs=3 --output-sync=target compiled-alone compiled-abreast lint
	$(BIN)/python -m pytest --numprocesses 2 $(addprefix --ignore=,$(DESCRIBED))

examples: .venv/installed-dev
	$(BIN)/python -m pytest --numprocesses 2 $(DESCRIBED)

smoke: .venv/installed-test
	$(BIN)/python -m pytest --numprocesses 2 $(SMOKE)

.venv-oldest/installed: pyproject.toml packaging/oldest.py
	$(PYTHON) -m venv .venv-oldest
	$(PYTHON) packaging/oldest.py > .venv-oldest/oldest.txt
	$(OLDEST)/python -m pip install --quiet --disable-pip-version-check --constraint .venv-oldest/oldest.txt --editable ".[test]"
	@touch $@

# Compiled code of another numba goes elsewhere: beside the sources it would take the place of ours.
oldest: .venv-oldest/installed
	NUMBA_CACHE_DIR=$(CURDIR)/.venv-oldest/compiled $(OLDEST)/python -m pytest -W default --numprocesses 2 $(SMOKE)

.venv-fast/installed: pyproject.toml
	$(PYTHON) -m venv .venv-fast
	$(FAST)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable ".[fast,test]"
	@touch $@

fast: .venv-fast/installed
	NUMBA_CACHE_DIR=$(CURDIR)/.venv-fast/compiled $(FAST)/python -m pytest --numprocesses 2 $(MESHES)

docs: .venv/installed-docs
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html

dist: .venv/installed-dev
	$(BIN)/python packaging/check_distributions.py

bench: .venv/installed-all
	$(BIN)/python benchmarks/suite.py

convergence: .venv/installed-all
	$(BIN)/python examples/papers/laulagnet_2011/convergence.py
	$(BIN)/python examples/papers/laulagnet_2011/convergence_of_statistics.py
	$(BIN)/python examples/papers/laulagnet_2011/first_contacts.py
	$(BIN)/python examples/papers/laulagnet_2011/step_of_the_exact_scheme.py

clean:
	rm -rf .venv .venv-oldest .venv-fast dist docs/_build results .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
