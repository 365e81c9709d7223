# make run, make test, make lint, make bench: nothing else to remember.
# The first one installs what is needed into .venv; later ones only what has changed.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

PYTHON ?= python3
ARGS ?=
VENV := .venv
BIN := $(VENV)/bin
CORE := hapticd/core
CARGO := cargo
CARGO_FLAGS := --locked --manifest-path $(CORE)/Cargo.toml
CORE_SOURCES := $(shell find $(CORE) -path $(CORE)/target -prune -o \( -name '*.rs' -o -name 'Cargo.*' \) -print)
PAGE_SCRIPTS := $(wildcard api/hapticd_api/page/*.js)

# $(call need,command that shows the tool is there,what is missing and how to get it)
need = @$(1) >/dev/null 2>&1 || { echo "$(2)" >&2; exit 1; }

.PHONY: help
help: ## what there is to make
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 22

.PHONY: run
run: $(VENV)/.installed ## start the daemon on twins of both devices; ARGS="--config FILE" for your own
	@$(BIN)/hapticd run $(ARGS)

.PHONY: test
test: lint test-core test-python ## everything that continuous integration runs

.PHONY: test-core
test-core: | have-cargo ## tests of the Rust core
	$(CARGO) test --quiet $(CARGO_FLAGS) --workspace

.PHONY: test-python
test-python: $(VENV)/.installed ## tests of everything else; ARGS="-k wall" for some of them
	$(BIN)/pytest $(ARGS)

.PHONY: lint
lint: lint-core lint-python lint-page ## formatters, linters, types and import directions; changes nothing

.PHONY: lint-core
lint-core: | have-cargo
	$(CARGO) fmt --check --manifest-path $(CORE)/Cargo.toml --all
	$(CARGO) clippy --quiet $(CARGO_FLAGS) --workspace --all-targets -- -D warnings

.PHONY: lint-python
lint-python: $(VENV)/.installed
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

.PHONY: lint-page
lint-page: | have-node
	for script in $(PAGE_SCRIPTS); do node --check "$$script"; done

.PHONY: format
format: $(VENV)/.installed | have-cargo ## put every file into its one format
	$(CARGO) fmt --manifest-path $(CORE)/Cargo.toml --all
	$(BIN)/ruff check --fix-only --quiet
	$(BIN)/ruff format

.PHONY: mutants
mutants: | have-cargo ## mutation tests of the bounding layer; takes long
	$(call need,cargo mutants --version,cargo-mutants is missing: run 'cargo install cargo-mutants'.)
	$(CARGO) mutants $(CARGO_FLAGS)

.PHONY: lock
lock: ## choose versions anew and pin them with their hashes
	$(call need,uv --version || $(BIN)/uv --version,uv is missing: run '$(BIN)/pip install uv'.)
	PATH="$$PATH:$(CURDIR)/$(BIN)" UV_CUSTOM_COMPILE_COMMAND="make lock" uv pip compile --quiet --upgrade \
		--universal --python-version 3.11 --group dev --generate-hashes --no-emit-index-url \
		--output-file requirements.lock pyproject.toml
	$(CARGO) update --manifest-path $(CORE)/Cargo.toml

.PHONY: clean
clean: ## remove what was built, .venv included
	rm -rf $(VENV) $(CORE)/target build dist *.egg-info hapticd/_core*.so
	rm -rf .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.locked: requirements.lock | have-python
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements.lock
	touch $@

$(VENV)/.installed: $(VENV)/.locked pyproject.toml $(CORE_SOURCES) | have-cargo
	$(BIN)/pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps --editable .
	touch $@

.PHONY: have-python
have-python:
	$(call need,$(PYTHON) -c 'import sys; assert sys.version_info >= (3$(comma) 11)',Python 3.11 or newer is missing: run 'apt install python3 python3-venv' or name one with 'make PYTHON=python3.11'.)
	$(call need,$(PYTHON) -c 'import ensurepip$(comma) venv',Python's venv is missing: run 'apt install python3-venv'.)

.PHONY: have-cargo
have-cargo:
	$(call need,$(CARGO) --version,Rust is missing: install it with rustup as https://rustup.rs says$(comma) then open a new shell.)
	$(call need,command -v cc,A C linker is missing: run 'apt install build-essential'.)

.PHONY: have-node
have-node:
	$(call need,node --version,Node is missing: run 'apt install nodejs'.)

comma := ,
