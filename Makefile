# Two commands do everything: `make run` and `make test`. Both set the machine up first where something is missing.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
SETUP = tools/setup.sh

.PHONY: run lab page test setup build bench accuracy reproduce format lint asan tsan dev fuzz docs clean help

run: build            ## build the program and run the main job: a swarm steered along a route
	@build/faba run scenes/steer.toml --seed 1 --force --out runs/steer

lab: build            ## open the live lab in a browser: watch, steer and record a swarm
	@build/faba lab $(SCENE)

test:                 ## build and run every test
	@$(SETUP) test
	@cmake --preset release --log-level=WARNING > /dev/null
	@cmake --build build -j $(JOBS)
	@ctest --test-dir build --no-tests=error --output-on-failure -j $(JOBS)

setup:                ## install what building needs (apt; with sudo when not root)
	@$(SETUP)

build: setup          ## build the program: build/faba
	@cmake --preset release --log-level=WARNING -DBUILD_TESTING=OFF > /dev/null
	@cmake --build build -j $(JOBS) --target faba

bench: build          ## measure speed beside NumPy, Octave and the machine's limits; table in bench/results/
	@$(SETUP) test bench
	@tools/page.sh install
	@cmake --build build -j $(JOBS) --target bench_agents bench_coils bench_video
	@/usr/bin/python3 bench/agents.py
	@/usr/bin/python3 bench/coils.py
	@/usr/bin/python3 bench/video.py
	@/usr/bin/python3 bench/study.py
	@/usr/bin/python3 bench/loop.py
	@node bench/lab.mjs --program build/faba --root . --out bench/results/lab.md

accuracy: build       ## render studies with known truth and see whether it is found; SEEDS=20 EXPERIMENTS=40 takes two hours
	@$(SETUP) test bench
	@cmake --build build -j $(JOBS) --target bench_exposure
	@/usr/bin/python3 bench/tracking.py
	@/usr/bin/python3 bench/exposure.py --seeds $(or $(SEEDS),2)
	@/usr/bin/python3 bench/recovery.py --experiments $(or $(EXPERIMENTS),6) --keep build/recovery --out $(if $(EXPERIMENTS),bench/results,build/recovery)

reproduce: build      ## reproduce the results of the 2016 thesis: runs/reproduce/index.html; 10 to 20 minutes
	@$(SETUP) test
	@/usr/bin/python3 tools/reproduce.py

format:               ## clang-format every source
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

lint:                 ## clang-format and clang-tidy as checks
	@$(SETUP) lint
	@git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
	@cmake --preset release -B build/lint --log-level=WARNING -DBUILD_TESTING=OFF -DFABA_UNITY=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
	@git ls-files 'src/*.cpp' | xargs -P $(JOBS) -n 1 clang-tidy --quiet -p build/lint

asan tsan dev: setup  ## build and run the tests under sanitizers, or without any optimisation
	@$(SETUP) test
	@cmake --preset $@ --log-level=WARNING > /dev/null
	@cmake --build build/$@ -j $(JOBS)
	@ctest --test-dir build/$@ --no-tests=error --output-on-failure -j $(JOBS)

fuzz: setup           ## fuzz the scenario loader, the lab's messages and the coil board's line for a minute each (SECONDS_TO_FUZZ=600 for longer)
	@$(SETUP) fuzz
	@tests/fuzz/run.sh $(or $(SECONDS_TO_FUZZ),60)

page:                 ## build the lab's page from web/src into web/dist (needs Node 18 or newer)
	@$(SETUP) test
	@tools/page.sh build

docs: build           ## regenerate docs/reference from the parts' own descriptions, and the README's picture
	@$(SETUP) docs
	@/usr/bin/python3 tools/make_docs.py --picture

clean:                ## remove the build; runs/ stays
	@rm -rf build

help:                 ## this list
	@grep -E '^[a-z ]+:.*##' Makefile | sed -E 's/:[^#]*## /\t/' | expand -t 14
