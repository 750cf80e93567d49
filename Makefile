# Two commands on a fresh machine: make demo, make test. Both make a virtual environment when there is none.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
RUNS := $(VENV)/.runs
INSTALLED := $(VENV)/.installed
TOOLS := $(VENV)-tools

.PHONY: help demo test test-commands test-library debug coverage check format data docs dissertation dist audit sbom clean

help:
	@echo "make demo    skeleton of a sample cloud: files and a picture in out/demo"
	@echo "make test    the test suite"
	@echo "make debug   the tests of kernels and library with every array index checked"
	@echo "make coverage   which branches of the code the tests run, those in processes of their own included"
	@echo "make check   lint, format and types"
	@echo "make format  format the code"
	@echo "make data    make the sample clouds in data/ anew"
	@echo "make docs    the documentation in out/docs, to be read in a browser without a network"
	@echo "make dissertation   docs/dissertation.md: every claim of the dissertation with its verdict; resumable"
	@echo "make dist    source distribution and wheel in dist/; the wheel is the same bytes from the same commit"
	@echo "make audit   known vulnerabilities of what is installed"
	@echo "make sbom    out/sbom.json: what is installed, in CycloneDX"
	@echo "make clean   remove the virtual environment and what was made"
	@echo "PYTHON=python3.12 chooses the interpreter (3.10 to 3.13), VENV=DIR the environment"

demo: $(RUNS)
	$(BIN)/tiskel run data/banana.ply -o out/demo
	@echo "open out/demo/report.html in a browser"

test: $(INSTALLED)
	$(BIN)/pytest -q

# The same in two parts, to be run side by side: make -j2 test-commands test-library
COMMANDS := tests/cli tests/batch tests/docs tests/scripts tests/fuzz tests/test_types.py

test-commands: $(INSTALLED)
	$(BIN)/pytest -q -p no:cacheprovider $(COMMANDS)

test-library: $(INSTALLED)
	$(BIN)/pytest -q -p no:cacheprovider $(addprefix --ignore=,$(COMMANDS))

debug: $(INSTALLED)
	TI_DEBUG=1 TI_OFFLINE_CACHE=0 $(BIN)/pytest -q tests/kernels tests/geometry tests/preprocess tests/methods tests/metrics tests/slicing tests/pipeline/test_stages.py

# Left out: forks of a pool, which wait for ever for a lock of coverage's, and kills, which it answers by writing its data.
coverage: $(INSTALLED)
	rm -rf out/coverage && mkdir -p out/coverage
	$(BIN)/coverage run -m pytest -q --ignore tests/kernels/test_concurrency.py --ignore tests/cli/test_kills.py
	$(BIN)/coverage combine -q
	$(BIN)/coverage json -q -o out/coverage.json
	$(BIN)/coverage report --skip-covered

check: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(INSTALLED)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

data: $(INSTALLED)
	data/make.sh $(BIN)/tiskel

docs: $(INSTALLED)
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs out/docs
	@echo "out/docs/index.html"

dissertation: $(INSTALLED)
	$(BIN)/python benchmarks/dissertation $(ARGS)

dist: $(TOOLS)/.installed
	rm -rf dist
	SOURCE_DATE_EPOCH=$${SOURCE_DATE_EPOCH:-$$(git log -1 --format=%ct)} $(TOOLS)/bin/python -m build --outdir dist .
	$(TOOLS)/bin/twine check --strict dist/*

audit: $(INSTALLED) $(TOOLS)/.installed
	$(TOOLS)/bin/pip-audit --path $$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')

sbom: $(INSTALLED) $(TOOLS)/.installed
	mkdir -p out
	$(TOOLS)/bin/cyclonedx-py environment --output-reproducible --pyproject pyproject.toml --output-file out/sbom.json $(BIN)/python

clean:
	rm -rf $(VENV) $(TOOLS) out dist build

$(TOOLS)/.installed:
	$(PYTHON) -m venv $(TOOLS)
	$(TOOLS)/bin/python -m pip install --quiet build twine pip-audit cyclonedx-bom
	touch $@

# What a user needs, pictures included; what tests and checks need comes on top, and is four times as large.
$(RUNS): pyproject.toml constraints.txt
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[full]'
	touch $@

$(INSTALLED): $(RUNS)
	PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'
	touch $@
