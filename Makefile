# SPDX-License-Identifier: Apache-2.0
# Front door: make demo, make test. What is built where is CMake's business (CMakePresets.json).
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help build demo test package bench evidence format tidy web clean

help:  ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-9s %s\n", $$1, $$2 }' Makefile

build:  ## installs what is missing and builds the program, build/release/saccade
	@scripts/build.sh

demo: build  ## explores a simulated table and opens the report; results in out/demo
	@scripts/demo.sh

test:  ## installs what is missing, builds and runs every test, sanitizers, fuzzing, lint
	@scripts/test.sh

package:  ## Debian packages of the program, the library and the Python module, in build/release/packages
	@scripts/package.sh

bench:  ## builds and runs the benchmarks
	@scripts/bench.sh

evidence: build  ## long acceptance runs, resumable; figures go to docs/results/evidence.md
	@scripts/evidence.sh

format:  ## lays out the code with clang-format
	@scripts/format.sh --fix

tidy:  ## runs clang-tidy over the library and the apps
	@scripts/tidy.sh

web:  ## makes web/dist, the page that the program shows, from web/src (needs npm)
	@scripts/web.sh build

clean:  ## removes build/ and out/
	rm -rf build out
