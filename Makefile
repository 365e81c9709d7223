# make run, make test, make lint, make bench: nothing else to remember.
# The first of them installs what is needed into .venv; later ones only what has changed.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

PYTHON ?= python3
ARGS ?=
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
CORE := hapticd/core
CARGO := cargo
MANIFEST := --manifest-path $(CORE)/Cargo.toml
CORE_SOURCES := $(shell find $(CORE) -name target -prune -o \( -name '*.rs' -o -name 'Cargo.*' \) -print)
PAGE_SCRIPTS := $(wildcard api/hapticd_api/page/*.js)

# $(call need,a command that shows the tool is there,one sentence that says how to get it)
need = @$(1) >/dev/null 2>&1 || { echo '$(2)' >&2; exit 1; }
need_python = $(call need,$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] < (3$(,) 11))',Python 3.11 or newer is missing: run "apt install python3 python3-venv"$(,) or name another one with "make PYTHON=python3.12".)
need_venv = $(call need,$(PYTHON) -c 'import ensurepip$(,) venv',The venv module of Python is missing: run "apt install python3-venv".)
need_cargo = $(call need,$(CARGO) --version,Rust is missing: install it as https://rustup.rs says$(,) then open a new shell.)
need_linker = $(call need,command -v cc,A C linker is missing: run "apt install build-essential".)
need_node = $(call need,node --version,Node is missing: run "apt install nodejs".)
need_mutants = $(call need,$(CARGO) mutants --version,cargo-mutants is missing: run "cargo install --locked cargo-mutants".)
need_uv = $(call need,$(BIN)/uv --version,uv is missing: run "$(BIN)/pip install uv".)
, := ,

.PHONY: help
help: ## what there is to make
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 22

.PHONY: run
run: $(VENV)/.installed ## start the daemon on twins of both devices; ARGS="--config FILE" for your own
	@exec $(BIN)/hapticd run $(ARGS)

.PHONY: test
test: lint test-core test-python ## everything that continuous integration runs

.PHONY: test-core
test-core: ## tests of the Rust core, the model check of its shared memory included
	$(need_cargo)
	$(need_linker)
	$(CARGO) test --quiet --locked $(MANIFEST) --workspace
	RUSTFLAGS='--cfg loom' $(CARGO) test --quiet --locked $(MANIFEST) --target-dir $(CORE)/target/loom \
		--package hapticd-servo --test interleavings

.PHONY: test-python
test-python: $(VENV)/.installed ## tests of everything else; ARGS="-k wall" for some of them
	$(BIN)/pytest $(ARGS)

.PHONY: lint
lint: lint-core lint-python lint-page ## formatters, linters, types and import directions; changes nothing

.PHONY: lint-core
lint-core:
	$(need_cargo)
	$(need_linker)
	$(CARGO) fmt --check $(MANIFEST) --all
	$(CARGO) clippy --quiet --locked $(MANIFEST) --workspace --all-targets -- -D warnings

.PHONY: lint-python
lint-python: $(VENV)/.installed
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

.PHONY: lint-page
lint-page:
	$(need_node)
	@for script in $(PAGE_SCRIPTS); do node --check --input-type=module - < "$$script" || { echo "in $$script" >&2; exit 1; }; done

.PHONY: format
format: $(VENV)/.installed ## put every file into its one format
	$(CARGO) fmt $(MANIFEST) --all
	$(BIN)/ruff check --fix-only --quiet
	$(BIN)/ruff format

.PHONY: bench
bench: $(VENV)/.installed ## figures: tick, twins, both loops under load; ARGS="--seconds 10" for a short look
	@$(BIN)/python -m tests.bench $(ARGS)

.PHONY: mutants
mutants: ## mutation tests of the safety layer, which take long; ARGS="--file bound.rs" for one file
	$(need_cargo)
	$(need_mutants)
	# On a copy, in place: the tests read the device models that lie beside the workspace.
	rm -rf build/mutants && mkdir -p build/mutants
	git ls-files -z $(CORE) hapticd/devices | tar --null --create --files-from - | tar --extract --directory build/mutants
	cd build/mutants/$(CORE) && CARGO_PROFILE_DEV_DEBUG=0 $(CARGO) mutants --in-place --package hapticd-control $(ARGS)

.PHONY: lock
lock: $(VENV)/.locked ## choose versions anew and pin them with their hashes
	$(need_uv)
	UV_CUSTOM_COMPILE_COMMAND="make lock" $(BIN)/uv pip compile --quiet --upgrade --universal --python-version 3.11 \
		--extra experiments --group dev --generate-hashes --no-emit-index-url --output-file requirements.lock pyproject.toml
	$(CARGO) update $(MANIFEST)

.PHONY: clean
clean: ## remove what was built, .venv included
	rm -rf $(VENV) $(CORE)/target build dist *.egg-info hapticd/_core*.so
	rm -rf .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.locked: requirements.lock
	$(need_python)
	$(need_venv)
	@echo 'Installing Python packages into $(VENV): once, about a minute.'
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) install --require-hashes --requirement requirements.lock
	@touch $@

$(VENV)/.installed: $(VENV)/.locked pyproject.toml $(CORE_SOURCES)
	$(need_cargo)
	$(need_linker)
	@echo 'Building the Rust core: the first time takes a minute or two.'
	@$(PIP) install --no-build-isolation --no-deps --editable .
	@touch $@
