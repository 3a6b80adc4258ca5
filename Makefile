# Everything runs in .venv, made on first use; nothing but Python 3.11 or later, its venv module and make is needed.
PYTHON ?= python3
BIN := .venv/bin

.PHONY: help paper verify peers test lint docs bench convergence clean

help:
	@echo "make paper        run every case of the paper into results/paper (sets itself up)"
	@echo "make verify       run every case whose answer is known into results/verify; fails if one falls short"
	@echo "make peers        the same systems in Siconos and here; needs Debian's python3-siconos, skipped without"
	@echo "make test         lint, types, layers and tests (sets itself up)"
	@echo "make docs         build the documentation into docs/_build/html, warnings are errors"
	@echo "make bench        speed as a table of ratios, each measured in one run: C, Siconos, real time, scaling, start-up; minutes"
	@echo "make convergence  the tables of docs/convergence.rst and the figures there and in docs/trust.rst, in a quarter of an hour"
	@echo "make clean        remove .venv and everything built"

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[all]"
	@touch $@

.venv/installed-%: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[$*]"
	@touch $@

paper: .venv/installed
	$(BIN)/stridula paper

verify: .venv/installed
	$(BIN)/stridula verify

peers: .venv/installed
	$(BIN)/python benchmarks/against_siconos.py
	$(BIN)/python benchmarks/cones.py

lint: .venv/installed-dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

test: lint
	$(BIN)/python -m pytest --numprocesses 2

docs: .venv/installed-docs
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html

bench: .venv/installed
	$(BIN)/python benchmarks/suite.py

convergence: .venv/installed
	$(BIN)/python examples/papers/laulagnet_2011/convergence.py
	$(BIN)/python examples/papers/laulagnet_2011/convergence_of_statistics.py
	$(BIN)/python examples/papers/laulagnet_2011/first_contacts.py
	$(BIN)/python examples/papers/laulagnet_2011/step_of_the_exact_scheme.py

clean:
	rm -rf .venv docs/_build results .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
