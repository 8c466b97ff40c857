# Two verbs for newcomers, demo and test; each sets up what it needs in .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := .venv/bin
# shapes and types checked while tests run; an int will do for a float
SHAPES := sensorfault,beartype.beartype(conf=beartype.BeartypeConf(is_pep484_tower=True))

.PHONY: demo test check real fuzz bench clean

demo: .venv/.installed        ## simulate a drive, let its sensors lie, find out
	$(BIN)/sensorfault demo --out demo

test: .venv/.dev              ## all tests that need nothing but this repository
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not real" --jaxtyping-packages="$(SHAPES)"

check: .venv/.dev             ## lint, types, import contract
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

real: .venv/.dev              ## the tests on the real logs in SENSORFAULT_DATA
	$(BIN)/python -m pytest -n 2 --dist loadfile -m real

fuzz: .venv/.dev              ## ten thousand damaged files a reader (the tests take two hundred)
	PYTHONPATH=tests $(BIN)/python -m fuzz

bench: .venv/.bench           ## ratios against peers, each within one run
	missed=0; for file in benchmarks/bench_*.py; do $(BIN)/python $$file || missed=1; done; exit $$missed

.venv/.installed: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e .
	touch $@

.venv/.dev: .venv/.installed
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $@

.venv/.bench: .venv/.installed
	$(BIN)/pip install -q --disable-pip-version-check -c constraints.txt -e '.[bench]'
	touch $@

clean:                        ## remove what make made
	rm -rf .venv demo
