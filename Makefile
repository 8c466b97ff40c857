# Two verbs for newcomers, demo and test; each sets up what it needs in .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
# An interpreter that is asked for, as by make test PYTHON=python3.12, has an environment of its own.
ifneq ($(origin PYTHON),file)
VERSION := $(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])')
$(if $(VERSION),,$(error PYTHON=$(PYTHON) does not run; name an interpreter of Python 3.11 or later))
VENV := .venv-$(VERSION)
endif
BIN := $(VENV)/bin
# shapes and types checked while tests run; an int will do for a float
SHAPES := sensorfault,beartype.beartype(conf=beartype.BeartypeConf(is_pep484_tower=True))

.PHONY: demo test check real wheel fuzz bench clean

demo: $(VENV)/.installed      ## simulate a drive, let its sensors lie, find out
	$(BIN)/sensorfault demo --out demo

test: $(VENV)/.dev            ## all tests that need nothing but this repository
	$(BIN)/python -m pytest -n 2 -m "not real" --jaxtyping-packages="$(SHAPES)"

check: $(VENV)/.dev           ## lint, types, import contract
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

real: $(VENV)/.dev            ## the tests on the real logs in SENSORFAULT_DATA
	$(BIN)/python -m pytest -n 2 -m real

wheel: $(VENV)/.dev           ## build sdist and wheel; install them elsewhere and run the demo from there
	$(BIN)/python .ci/wheel.py

fuzz: $(VENV)/.dev            ## ten thousand damaged files a reader (the tests take two hundred)
	PYTHONPATH=tests $(BIN)/python -m fuzz

bench: $(VENV)/.bench         ## ratios against peers, each within one run
	missed=0; for file in benchmarks/bench_*.py; do $(BIN)/python $$file || missed=1; done; exit $$missed

$(VENV)/.installed: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e '.[all]'
	touch $@

$(VENV)/.dev: $(VENV)/.installed
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $@

$(VENV)/.bench: $(VENV)/.installed
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e '.[bench]'
	touch $@

clean:                        ## remove what make made
	rm -rf .venv .venv-* build dist demo
