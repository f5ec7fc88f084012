# Needs Python >= 3.11, git and make; everything else goes into the folder .venv.
# Each target installs what it needs from the pinned versions in requirements/, with their hashes.

# Python keeps what it has compiled, whatever the shell says: each process of the tests would compile all it imports anew
unexport PYTHONDONTWRITEBYTECODE

VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check
# the newest Python that is tested, then any other that is new enough
PYTHONS := python3.13 python3.12 python3.11 python3.14 python3 python
PYTHON ?= $(shell for p in $(PYTHONS); do \
	$$p -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)

.DEFAULT_GOAL := help
.PHONY: help demo demo-fleet test test-slow test-all lint docs bench wheel offline program lock clean

help: ## Say what can be made
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(firstword $(MAKEFILE_LIST))

demo: $(VENV)/run ## Sail the simulated tug and identify it; results in demo/
	$(BIN)/shaftprint demo -o demo

demo-fleet: $(VENV)/web ## Eight sister ships over five years in a store; demo-fleet/
	$(BIN)/shaftprint demo --fleet -o demo-fleet

# Each core has a worker of its own.
PYTEST := pytest -n auto --dist loadfile --no-loadscope-reorder
test test-slow test-all docs: export OPENBLAS_NUM_THREADS ?= 1
test: $(VENV)/test ## Run the tests that a change needs
	$(BIN)/python -m $(PYTEST) -m "not slow and not long and not wrong_recordings"

test-slow: $(VENV)/test ## Run them, the slow tests and one wrong recording in eight, with the coverage of the calculating rooms
	@mkdir -p build
	$(BIN)/python -m slipcover --json --out build/coverage.json -m $(PYTEST) -m "not long"
	$(BIN)/python -m slipcover --merge build/coverage.json --out build/coverage.json --fail-under 95 >build/coverage.txt || { cat build/coverage.txt; exit 1; }
	@tail -n 1 build/coverage.txt

test-all: test-slow ## Run the long searches and Monte Carlos too, as before a release
	$(BIN)/python -m pytest -n auto --dist worksteal -m long

lint: $(VENV)/lint ## Check style, types and the direction of imports
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: $(VENV)/docs ## Build the pages into build/docs; a warning is an error
	$(BIN)/python -m sphinx -W --keep-going -j auto -b html docs build/docs

bench: $(VENV)/benchmark ## Run shaftprint beside its peers and print the ratios
	$(BIN)/python -m benchmarks

wheel: $(VENV)/run ## Build the wheel into dist/
	rm -f dist/*.whl
	$(BIN)/python -m hatchling build -t wheel

offline: wheel ## Write a zip that installs without a network; OPTIONS=--help
	$(BIN)/python requirements/offline.py $(OPTIONS)

program: wheel ## Write a program with its own Python, for this system, into dist/: a double click opens the pages
	@echo "Installing requirements/program.txt into build/python (a few minutes) ..."
	@$(BIN)/python -m venv --clear build/python
	@build/python/bin/python -m pip --disable-pip-version-check install --quiet --no-deps --no-compile --require-hashes --requirement requirements/program.txt
	@build/python/bin/python -m pip --disable-pip-version-check install --quiet --no-deps dist/shaftprint-*.whl
	build/python/bin/python requirements/program/build.py

lock: $(VENV)/bin/python ## Choose new versions for requirements/ (needs the network)
	$(PIP) install --quiet uv
	PATH="$(CURDIR)/$(BIN):$$PATH" requirements/lock

clean: ## Delete the environment and everything that was made
	rm -rf $(VENV) dist build demo demo-fleet .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/bin/python:
	@test -n "$(PYTHON)" || { echo "Python 3.11 or newer with the modules venv and ensurepip is needed; found none" \
		"among $(PYTHONS). On Debian and Ubuntu: apt install python3-venv."; exit 1; }
	$(PYTHON) -m venv $(VENV)

# One stamp a set of requirements; the project itself is installed so that changes to src/ take effect at once.
# The lists are complete: pip resolves nothing, or a newer release of what a dependency asks for by an extra would stop it.
# What runs the program is compiled at once, as pip does: shells with PYTHONDONTWRITEBYTECODE would compile it in every run.
# For tests and pages Python compiles what is used when it is used, which is a third of what is installed.
$(VENV)/run $(VENV)/web $(VENV)/test $(VENV)/lint $(VENV)/docs $(VENV)/benchmark: $(VENV)/%: requirements/%.txt pyproject.toml | $(VENV)/bin/python
	@echo "Installing requirements/$*.txt into $(VENV) (a minute or two) ..."
	@$(PIP) install --quiet --no-deps $(if $(filter run web,$*),,--no-compile) --require-hashes --requirement requirements/$*.txt
	@$(PIP) install --quiet --no-deps --no-build-isolation --editable .
	@$(BIN)/python -m compileall -q src
	@touch $@
