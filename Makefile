# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

# Four words do the work: check, test, prove, demo. Each installs what it needs.

RAVENCHART := .venv/bin/ravenchart
PYTHON     := .venv/bin/python
# A warning stops a build of our own; it does not stop a user's.
export RAVENCHART_WARNINGS := errors
# The results of the last run of the tests, for the evidence of the examples.
RESULTS    := build/tests.xml
# Tests that wait on the host's clock and failed beside others: they run once more, alone.
AGAIN      := build/tests-again
again       = || { test $$? -eq 8 && $(PYTHON) -P -m pytest -q @$(AGAIN) --junit-xml=$(AGAIN).xml; }
# They run on other machines too, where their compilers and emulators are.
ELSEWHERE  := tests/system/test_other_machines.py tests/system/test_codecs.py
EXAMPLES   := $(patsubst %/model.yaml,%,$(sort $(wildcard examples/*/model.yaml)))

.PHONY: help setup setup-tests demo test test-all test-long coverage hw-test board-test check prove generate bench bench-proof
.PHONY: mutate mutate-runtime docs pages pictures site
.PHONY: lock clean

help:
	@echo 'make demo      check, generate, build and run the Cartesian robot; a report'
	@echo 'make test      the tests of a change: minutes; the slow ones are named and left out'
	@echo 'make test-all  every test, as .ci/run does'
	@echo 'make coverage  the same tests as make test; which statements and branches of the Python they execute'
	@echo 'make test-long  the same with 2,000 random charts, millions of frames and lines: hours'
	@echo 'make hw-test   drivers on SocketCAN and CTU CAN FD in a guest of QEMU, tests on other machines: minutes'
	@echo 'make board-test  controllers and runtime on an emulated board; what cannot run is skipped'
	@echo 'make check     style, types, warnings as errors'
	@echo 'make prove     gnatprove on all records; ONLY="pump", or a group: runtime, examples, models'
	@echo 'make generate  the examples'' generated/ from their models'
	@echo 'make bench     figures: waits of a user, generated Ada, runtime, codecs (beside C), buses, charts, generator, analysis (beside a Rust crate), workbench, live view'
	@echo 'make bench-proof  does the proof of a chart grow linearly?'
	@echo 'make mutate    break generated code in small ways: who notices?'
	@echo 'make mutate-runtime  the same of runtime and HAL; ARGS="--unit queues --all"'
	@echo 'make docs      the pages that are written from the sources (make pages), and the site (make site)'
	@echo 'make pages     model reference, JSON Schemas, manual page and error list; pictures of the examples'
	@echo 'make pictures  the pictures of local pages in the documentation, taken in Chromium'
	@echo 'make site      the documentation as a site, which needs no network: build/site/docs/index.html'

setup:
	@scripts/setup.sh

setup-tests:
	@scripts/setup.sh tests

demo: setup
	@$(RAVENCHART) run examples/cartesian_robot/model.yaml --scenario examples/cartesian_robot/scenario.yaml --report build/demo

test: setup-tests
	@RAVENCHART_TESTS_AGAIN=$(AGAIN) $(PYTHON) -P -m pytest -q -n auto --junit-xml=$(RESULTS) $(again)

test-all: setup-tests
	@RAVENCHART_ALL_TESTS=1 RAVENCHART_TESTS_AGAIN=$(AGAIN) $(PYTHON) -P -m pytest -q -n auto --durations=25 --junit-xml=$(RESULTS) $(again)

coverage: setup-tests
	@$(PYTHON) -P -m pytest -q -n auto --cov --cov-report=term:skip-covered --cov-report=html:build/coverage

test-long: setup-tests
	@RAVENCHART_ALL_TESTS=1 RAVENCHART_LONG_TESTS=1 $(PYTHON) -P -m pytest -q -n auto

hw-test: setup
	@scripts/setup.sh guest || true
	@$(PYTHON) -P -m pytest -q -rs tests/hardware $(ELSEWHERE) -k 'hardware or s390x or armhf' --timeout=3600 --junit-xml=build/hw-test/results.xml

board-test: setup
	@scripts/setup.sh board || true
	@$(PYTHON) -P -m pytest -q -rs tests/system/test_bare_images.py tests/system/test_boards.py

check: setup
	@$(PYTHON) -P -m ruff check .
	@$(PYTHON) -P -m ruff format --check .
	@$(PYTHON) -P -m mypy
	@.venv/bin/lint-imports --no-cache --no-logo
	@$(PYTHON) -P -m pytest -q -p no:cacheprovider tests/sources
	@$(PYTHON) -P -m tests.house check

prove: setup
	@$(PYTHON) -P -m tests.house prove $(ONLY)

generate: setup
	@for e in $(EXAMPLES); do $(RAVENCHART) generate $$e/model.yaml || exit 1; done

bench:
	@scripts/setup.sh arm
	@$(PYTHON) -P -m tests.bench

bench-proof: setup
	@$(PYTHON) -P -m tests.bench.proof

mutate: setup
	@$(PYTHON) -P -m tests.mutation

mutate-runtime: setup
	@$(PYTHON) -P -m tests.mutation.hand_written $(ARGS)

docs: pages site

pages: setup
	@$(PYTHON) -P -m ravenchart.gen.files.reference
	@$(PYTHON) -P -m ravenchart.reference
	@$(PYTHON) -P -m tests.support.faults
	@$(PYTHON) -P -m tests.support.rooms
	@for e in $(EXAMPLES); do \
	   $(RAVENCHART) draw $$e/model.yaml --out docs/pictures/$$(basename $$e) || exit 1; done

pictures: setup
	@scripts/setup.sh browser
	@$(PYTHON) -P -m tests.support.page_pictures

site: setup
	@for e in pump cartesian_robot two_nodes; do \
	   $(RAVENCHART) evidence examples/$$e/model.yaml --out build/site_extra/evidence/$$e \
	      $$(find examples/$$e -name requirements.csv -printf '--requirements %p') \
	      $(if $(wildcard $(RESULTS)),--tests $(RESULTS)) || test $$? -eq 1 || exit 1; done
	@.venv/bin/sphinx-build -q -W --keep-going -b html -c docs/site . build/site
	@echo build/site/docs/index.html

lock:
	@.venv/bin/pip-compile --quiet --generate-hashes --strip-extras --allow-unsafe --extra dev \
	   --no-header --no-emit-index-url --no-emit-find-links --output-file requirements.lock pyproject.toml
	@echo 'asammdf>=8.8' | .venv/bin/pip-compile --quiet --generate-hashes --strip-extras --no-annotate \
	   --unsafe-package numpy --unsafe-package lxml --constraint requirements.lock \
	   --no-header --no-emit-index-url --no-emit-find-links --output-file requirements-mdf.lock -

clean:
	rm -rf build obj .venv
