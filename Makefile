# What a person does with a working copy. `make` alone prints this list.
.DEFAULT_GOAL := help
.PHONY: help setup setup-mumps demo verify nightly manual wheel test lint format

# One BLAS thread is as fast as two on systems of this size; the cores go to cases, and threads of each would be in others' way.
export OPENBLAS_NUM_THREADS ?= 1
test verify nightly: export OMP_NUM_THREADS ?= 1

# Compiled modules are kept, whatever the machine says: tests and cells start hundreds of processes, and a third of a start is compiling.
unexport PYTHONDONTWRITEBYTECODE

BIN := .venv/bin
READY := .venv/set-up

help: ## print this list
	@sed -n 's/^\([a-z-]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 20

setup: $(READY) ## install what is missing, build, once

setup-mumps: ## the same with the engine mumps, for runs on several machines: docs/engines.md
	@bash tools/setup.sh --mumps

$(READY): pyproject.toml meson.build tools/setup.sh
	@bash tools/setup.sh

demo: $(READY) ## run the ironing scene; curve and picture go to results/
	$(BIN)/isomortar run iron --overwrite
	@printf '==> Curves and pictures:\n'
	$(BIN)/isomortar plot results/iron.h5

verify: $(READY) ## run the verification cases of the gate; the report goes to results/verification/
	$(BIN)/isomortar verify

nightly: $(READY) ## nightly tier, extremes, published, orders, benchmarks: hours; one page, results/nightly/index.html, and one exit code
	$(BIN)/python tools/run_nightly.py

manual: $(READY) ## run the blocks of the manual and build it; it goes to results/manual/html/index.html
	$(BIN)/python tools/build_manual.py

wheel: $(READY) ## a wheel that needs nothing of the machine, in dist/, tried in an empty environment
	@bash tools/build_wheel.sh

# One process more than there are cores: where one waits, for the disk or for processes of its own, another one goes on.
test: lint ## linters, then all tests
	$(BIN)/python -m pytest -n $$(($$(env -u OMP_NUM_THREADS nproc) + 1)) --dist loadfile

lint: $(READY) ## formatters and linters, nothing is changed
	@bash tools/lint.sh

format: $(READY) ## put Python and Fortran files into the common format
	$(BIN)/ruff check --quiet --fix-only .
	$(BIN)/ruff format .
	@bash tools/format_fortran.sh
