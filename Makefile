# Every target makes .venv from requirements.lock when it is missing or older than the lock.
PYTHON ?= python3
BIN := .venv/bin
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
# where it is set, as in many containers, each process compiles all that it imports: 14 s for a run that takes 6
export PYTHONDONTWRITEBYTECODE :=

# One after the other, a failed one does not stop the rest. The verdicts on published claims follow from the results.
EXPERIMENTS := $(basename $(notdir $(wildcard conf/experiment/*.yaml)))

.PHONY: run test test-all test-optional optional lint bench mutate torture torture-part reliability corpus reproduction reproduction-changed site viewer ui lock dist audit clean

run: .venv/ready
	$(BIN)/surfexp run

test: .venv/ready
	$(BIN)/pytest -n 2 --dist loadfile --no-loadscope-reorder -m "not slow"

test-all: .venv/ready
	$(BIN)/pytest -n 2 --dist loadfile --no-loadscope-reorder

optional: .venv/ready # open3d, cvxpy, lapy, svglib, vtk: their tests are skipped without
	$(BIN)/python -m pip install --quiet --no-deps --no-compile --require-hashes -r requirements-optional.lock

test-optional: optional
	$(BIN)/python tests/check_licences.py requirements-optional.lock
	$(BIN)/pytest -n 2 -m "optional and not slow"

lint: .venv/ready
	$(BIN)/ruff check .
	$(BIN)/typos --quiet docs conf surfexp plugins studies examples audits *.md
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tests/check_docstrings.py
	$(BIN)/python tests/check_licences.py
	$(BIN)/python -m surfexp.reproduction.stamp check

bench: optional # the rivals come with it
	$(BIN)/python -m audits.benchmarks

mutate: .venv/ready
	$(BIN)/python -m audits.mutation planted
	$(BIN)/python -m audits.mutation random
	$(BIN)/python -m audits.mutation claims

torture: .venv/ready
	$(BIN)/python -m audits.torture

torture-part: .venv/ready
	$(BIN)/python -m audits.torture --part

reliability: optional # the other readers come with it
	$(BIN)/python -m audits.reliability

corpus: optional # downloads 200 MB by pip and apt-get into build/corpus; what cannot be had is left out with a line
	$(BIN)/python -m audits.reliability --corpus

# Exit code 3: a row did not converge, as those published schemes that stop at a number of iterations.
# In a results folder of this state of numerics and experiments: empty at first, continued when it was interrupted.
# Measured data come from a package; without it their sections stay as they are.
reproduction: .venv/ready
	results=results/reproduction/$$($(BIN)/python -m surfexp.reproduction.stamp state) && failed="" && \
	names="$(EXPERIMENTS)" && beside="$(BESIDE)" && \
	if [ -n "$(filter %_measured,$(EXPERIMENTS))" ] && ! $(BIN)/surfexp fetch brainspace; then \
		names="$(filter-out %_measured,$(EXPERIMENTS))"; beside="--beside docs"; fi && \
	for name in $$names; do \
		echo "== $$name"; $(BIN)/surfexp run experiment=$$name results=$$results || \
			case $$? in 3) ;; 1) failed="$$failed $$name" ;; *) exit 2 ;; esac; \
	done && \
	$(BIN)/surfexp report --claims $$beside --preface docs/_static/new_in_the_field.md --pages docs --results $$results $$names && \
	{ $(BIN)/python -m audits.page_numbers $$results || echo "these numbers of docs are in no result of their experiments"; } && \
	if [ -n "$$failed" ]; then echo "failed:$$failed"; exit 1; fi

# Only experiments of which a stage's key or a claim has changed; the other sections of the page are still true.
reproduction-changed: .venv/ready
	names=$$($(BIN)/python -m surfexp.reproduction.stamp stale) && \
	if [ -n "$$names" ]; then $(MAKE) reproduction EXPERIMENTS="$$names" BESIDE="--beside docs"; fi && \
	$(BIN)/python -m surfexp.reproduction.stamp renew

# Pages, API and examples with their pictures, read from disk: build/site/index.html.
site: optional
	PYTHONPATH=docs $(BIN)/python -m sphinx -b html --fail-on-warning --keep-going $(SITE) docs build/site

# The library of pages whose surfaces turn, which the package holds; needs npm, and is the same to the byte.
viewer: .venv/ready
	$(BIN)/python viewer/build.py

ui: .venv/ready
	$(BIN)/surfexp ui

.venv/ready: requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(0 if (3, 11) <= sys.version_info < (3, 14) else "surfexp needs Python 3.11, 3.12 or 3.13; set PYTHON=")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --no-deps --no-compile --require-hashes -r requirements.lock # holds all
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .
	touch .venv/ready

lock: # needs uv; writes no index address
	uv pip compile --universal --generate-hashes --no-emit-index-url --no-header --no-annotate --python-version 3.11 \
		pyproject.toml --extra dev -o requirements.lock
	uv pip compile --universal --generate-hashes --no-emit-index-url --no-header --no-annotate --python-version 3.11 \
		pyproject.toml --extra dev --extra open3d --extra conic --extra print --extra bundle --extra bench --extra reliability --extra site -c requirements.lock -o requirements-optional.lock
	uv pip compile --universal --generate-hashes --no-emit-index-url --no-header --no-annotate --python-version 3.11 \
		--group release -o requirements-release.lock

# Every entry of the lock is looked up; what could not be looked up counts as a failure.
audit:
	@command -v pip-audit > /dev/null || { echo "make audit needs pip-audit on the path: pip install pip-audit"; exit 2; }
	pip-audit --strict --disable-pip --require-hashes -r requirements.lock

dist: # needs git and the package index
	PYTHON=$(PYTHON) .ci/dist

clean:
	rm -rf results/[!R]* .snakemake
