# Every target sets up what it needs: a virtual environment in .venv from a bare Python 3.11 or newer.
PYTHON ?= $(shell for p in python3.14 python3.13 python3.12 python3.11 python3; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
VENV := .venv
BIN := $(VENV)/bin

# Where the shell forbids to keep what Python compiles, each of hundreds of processes would compile every source anew.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: walk test tests quick map unit interpreted physics check long gate format coverage mutants signs bench results texts docs dist dist-test scenario changelog clean

walk: $(VENV)/.installed
	$(BIN)/surefoot run walk

# The gate takes one core for a while, so that the tests begin beside it.
test:
	$(MAKE) -j2 gate tests
	$(MAKE) check

gate: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/deptry planner wbc sim models scenarios studies apps surefoot
	$(BIN)/deptry tests benchmarks docs $(wildcard examples) --exclude runs --ignore DEP002,DEP004

# All at once is quicker than one tier after the other: each begins with reading all tests. In their order, the last ones
# are short, and no core waits for a long one.
tests: $(VENV)/.installed-dev
	$(BIN)/pytest -m "(unit or physics) and not long" -n auto --dist loadscope --no-loadscope-reorder

# The tests that a change touches, as many as fit into a minute; make quick BASE=v0.1.0 compares with another commit.
quick: $(VENV)/.installed-dev
	$(BIN)/python tests/touched/quick.py $(addprefix --base ,$(BASE))

# Which tests touch what, by watching each; make map MORE=--missing goes on with one that was interrupted.
map: $(VENV)/.installed-dev
	$(BIN)/python tests/touched/survey.py $(MORE)

# make unit AREA=planner runs the unit tests of one folder, make unit those of all.
unit: $(VENV)/.installed-dev
	$(BIN)/pytest -m "unit and not physics and not long" -n auto --dist loadscope tests/$(AREA)

# The same modules without compiling, in a clone of their own.
interpreted: $(VENV)/.installed-dev
	rm -rf build/interpreted && mkdir -p build
	git clone --quiet . build/interpreted
	cd build/interpreted && export PYTHONPATH=$$PWD PATH=$(CURDIR)/$(BIN):$$PATH && \
	python -m surefoot.native --interpreted && \
	python -m pytest -q -p no:cacheprovider -m "unit and not physics and not long" -n auto --dist loadscope tests/$(AREA) && \
	python -m surefoot check --out runs walk control-push

physics: $(VENV)/.installed-dev
	$(BIN)/pytest -m "physics and not long" -n auto --dist loadscope

check: $(VENV)/.installed-dev
	$(BIN)/surefoot check control-fall control-slide control-push control-sensors control-motors paper-brisk stairs-tall walk-sideways walk

long: $(VENV)/.installed-dev
	$(BIN)/pytest -m long

# The plug-in of pytest is imported before the measurement begins, and all that it imports with it.
coverage: $(VENV)/.installed-dev
	$(BIN)/pytest -m "unit and not physics and not long" -n auto --dist loadscope -p no:surefoot --cov --cov-report=term tests/$(AREA)

# make mutants MODULE=planner/laws/qp.py [TESTS=tests/planner/laws] [LIMIT=40]
mutants: $(VENV)/.installed-dev
	$(BIN)/python tests/sabotage/mutants.py $(MODULE) $(addprefix --tests ,$(TESTS)) $(addprefix --limit ,$(LIMIT))

# make signs SEED=3 [COUNT=20] [MODULES="planner/quintic.py wbc/zmp.py"]
signs: $(VENV)/.installed-dev
	$(BIN)/python tests/sabotage/signs.py $(MODULES) --seed $(or $(SEED),0) --count $(or $(COUNT),20)

format: $(VENV)/.installed-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# make bench SECTIONS="tick startup" measures some of it.
bench: $(VENV)/.installed-dev
	OMP_NUM_THREADS=1 $(BIN)/python -m benchmarks $(SECTIONS)

# Results that a change can have touched are made again in the background; begun again, it goes on where it stopped.
# `python docs/results.py` lists all with what is known of them.
results: $(VENV)/.installed-dev
	nice $(BIN)/python docs/results.py --run --background $(NAMES)

# What follows from the sources: texts of commands in the package, tables and numbers of pages.
texts: $(VENV)/.installed-dev
	$(BIN)/python docs/texts.py
	$(BIN)/python docs/reference.py

# The documentation site in build/site, strictly; its index.html opens without a server.
docs: $(VENV)/.installed-docs
	$(BIN)/python docs/site/build.py

# make scenario NAME=walk SUMMARY=file walks one scenario against its baseline, and adds its table to a file.
scenario: $(VENV)/.installed
	$(BIN)/surefoot check $(NAME) --out runs/check --markdown runs/check.md --force; \
	code=$$?; cat runs/check.md >> $(or $(SUMMARY),/dev/stdout); exit $$code

# Wheel and sdist in dist/, and whether an index would take them.
dist: $(VENV)/.installed-release
	rm -rf dist
	$(BIN)/python -m hatchling build
	$(BIN)/twine check --strict dist/*

# Each in an empty environment, where it walks.
dist-test: dist
	$(BIN)/python tests/packaging/empty_environment.py dist/*

# Put the files of changes/ into CHANGELOG.md.
changelog: $(VENV)/.installed
	$(BIN)/python docs/changelog.py

clean:
	rm -rf $(VENV) runs dist build

$(VENV)/bin/python:
	@test -n "$(PYTHON)" || { echo "Surefoot needs Python 3.11 or newer; set PYTHON=/path/to/python3.11"; exit 2; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e .
	@$(BIN)/python -m surefoot.native
	@touch $@

$(VENV)/.installed-dev: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@$(BIN)/python -m surefoot.native
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-release: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[release]'
	@touch $@ $(VENV)/.installed
