# Start with `make run` and `make test`. Both install missing packages first.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
SETUP = tools/setup.sh

.PHONY: run lab page python train-example test test-long test-engines test-arm64 test-portability arm64 demo test-demo package test-package test-reproducible package-arm64 test-package-arm64 setup build bench accuracy reproduce format lint asan tsan dev fuzz docs clean help

run: build            ## build the program and run scenes/steer.toml: a swarm is steered along a route
	@build/faba run scenes/steer.toml --seed 1 --force --out runs/steer

lab: build            ## open the live lab in a browser: watch, steer and record a swarm
	@build/faba lab $(SCENE)

CTEST = ctest --no-tests=error --output-on-failure
test:                 ## build and run the tests, without those of test-long
	@$(SETUP) test python
	@cmake --preset release --log-level=WARNING > /dev/null
	@cmake --build build -j $(JOBS)
	@# Some of these tests wait for most of their time: one more than processors.
	@$(CTEST) --test-dir build --label-exclude long -j $$(($(JOBS) + 1))

test-long:            ## build, and run the tests in a browser and those that compute or control a bench for a minute
	@$(SETUP) test python
	@cmake --preset release --log-level=WARNING > /dev/null
	@cmake --build build -j $(JOBS)
	@$(CTEST) --test-dir build --label-regex long -j $(JOBS)

test-engines: build   ## install Slurm, Dask and GNU parallel, and test studies on each, also with workers, nodes and the command killed
	@$(SETUP) engines
	@# Exit code 77: nothing failed, but checks could not run; they are printed.
	@/usr/bin/python3 tests/e2e/study_engines_test.py --program build/faba --kills || \
	  { code=$$?; [ $$code -eq 77 ] || exit $$code; echo "make test-engines: some checks were SKIPPED; their reasons are above"; }

demo:                 ## build the demonstration in a browser, with Emscripten: build/demo/index.html
	@$(SETUP) demo
	@JOBS=$(JOBS) tools/demo.sh

test-demo: build      ## build and test the demonstration in Chromium: state hashes of the program, speed, size, accessibility
	@$(SETUP) demo || command -v em++ > /dev/null || { echo "make test-demo: SKIPPED: Emscripten is not installed"; exit 0; }; \
	  JOBS=$(JOBS) tools/demo.sh && node tests/e2e/demo_test.mjs --program build/faba --root . --demo build/demo

test-arm64:           ## cross-build the engine for arm64 and run its tests under emulation: golden hashes, physics, contract, field, control
	@$(SETUP) arm64
	@cmake --preset engine-arm64 --log-level=WARNING > /dev/null
	@cmake --build build/engine-arm64 -j $(JOBS)
	@$(CTEST) --test-dir build/engine-arm64 -j $(JOBS) $(CTEST_OPTIONS)

test-portability:     ## run the same tests on this machine with unsigned char, as on arm64, and compiled by clang
	@$(SETUP) portability
	@for leg in engine-unsigned-char engine-clang; do \
	  cmake --preset $$leg --log-level=WARNING > /dev/null && cmake --build build/$$leg -j $(JOBS) && \
	  $(CTEST) --test-dir build/$$leg -j $(JOBS) || exit 1; done

# Exit code 77 of arm64_sysroot.sh: no package can be downloaded.
arm64: build          ## cross-build the program and the Python package for arm64 in build/arm64/, run them under emulation and compare with build/faba
	@$(SETUP) arm64 python
	@tools/arm64_sysroot.sh build/arm64/sysroot || { code=$$?; [ $$code -eq 77 ] || exit $$code; \
	  echo "make arm64: SKIPPED; the reason is above"; exit 0; }; \
	cmake --preset arm64 --log-level=WARNING > /dev/null && \
	cmake --build build/arm64 -j $(JOBS) --target faba python tests_core tests_vision tests_rig && \
	$(CTEST) --test-dir build/arm64 -j $(JOBS) -R '^(core|vision|rig)\.|^e2e\.arm64$$'

python:               ## build the Python package: build/python/faba; use it with PYTHONPATH=build/python /usr/bin/python3
	@$(SETUP) python
	@cmake --preset release --log-level=WARNING > /dev/null
	@cmake --build build -j $(JOBS) --target python faba-coil-guard faba-capture

# Gymnasium is not in Debian: installed with pip, or a copy in the folder GYMNASIUM.
GYMNASIUM ?= ../shared/clients/gymnasium
train-example: python ## install PyTorch, train the policy of examples/ that holds a swarm, about ten minutes, and compare it with controllers
	@$(SETUP) python torch
	@export PYTHONPATH=$(CURDIR)/build/python:$(PYTHONPATH):$(GYMNASIUM); \
	  /usr/bin/python3 examples/train_hold.py && \
	  /usr/bin/python3 examples/evaluate_hold.py --bench --curve docs/img/hold-learning.svg

package: setup        ## build the Debian packages faba and faba-camera: build/package/*.deb; needs no other build
	@$(SETUP) python package
	@packaging/package.sh

test-package: package ## install the packages in a bare Debian 12 and use them there as an unprivileged user
	@/usr/bin/python3 tests/packaging/package_test.py --camera || { code=$$?; [ $$code -eq 77 ] || exit $$code; }

test-reproducible: package ## build the packages a second time, in another folder, and compare the bytes
	@tests/packaging/same_bytes.sh

package-arm64: package ## also cross-build them for arm64
	@$(SETUP) arm64 python package
	@FABA_ARCH=arm64 packaging/package.sh

test-package-arm64: package-arm64 ## install those in a bare Debian 12 for arm64, under emulation, and use them there
	@/usr/bin/python3 tests/packaging/package_test.py --arch arm64 || { code=$$?; [ $$code -eq 77 ] || exit $$code; }

setup:                ## install the packages for building (apt-get; with sudo if not root)
	@$(SETUP)

build: setup          ## build the program: build/faba
	@cmake --preset release --log-level=WARNING -DBUILD_TESTING=OFF > /dev/null
	@cmake --build build -j $(JOBS) --target faba share

bench: build          ## measure speed and compare it with NumPy, Octave and hardware limits; tables in bench/results/
	@$(SETUP) test bench python
	@tools/page.sh install
	@cmake --preset release --log-level=WARNING > /dev/null
	@cmake --build build -j $(JOBS) --target bench_agents bench_coils bench_video bench_jobs bench_python python
	@/usr/bin/python3 bench/agents.py
	@/usr/bin/python3 bench/coils.py
	@/usr/bin/python3 bench/video.py
	@/usr/bin/python3 bench/study.py
	@/usr/bin/python3 bench/loop.py
	@/usr/bin/python3 bench/jobs.py
	@/usr/bin/python3 bench/python.py
	@$(SETUP) engines
	@/usr/bin/python3 bench/engines.py
	@node bench/lab.mjs --program build/faba --root . --out bench/results/lab.md
	@node bench/capture.mjs --program build/faba --root . --out bench/results/capture.md

accuracy: build       ## test measurements on rendered videos with known ground truth; with SEEDS=20 EXPERIMENTS=40: two hours
	@$(SETUP) test bench
	@cmake --build build -j $(JOBS) --target bench_exposure
	@/usr/bin/python3 bench/tracking.py
	@/usr/bin/python3 bench/quality.py --held-out
	@/usr/bin/python3 bench/exposure.py --seeds $(or $(SEEDS),2)
	@/usr/bin/python3 bench/recovery.py --experiments $(or $(EXPERIMENTS),6) --keep build/recovery --out $(if $(EXPERIMENTS),bench/results,build/recovery)

reproduce: build      ## reproduce the results of the 2016 thesis: runs/reproduce/index.html; 10 to 20 minutes
	@$(SETUP) test
	@/usr/bin/python3 tools/reproduce.py

format:               ## format all C++ sources with clang-format
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

lint:                 ## check the sources with clang-format and clang-tidy
	@$(SETUP) lint
	@git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
	@cmake --preset release -B build/lint --log-level=WARNING -DBUILD_TESTING=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
	@tools/lint.py build/lint --jobs $(JOBS)

asan tsan dev: setup  ## build and run the tests under sanitizers (asan, tsan) or without optimisation (dev)
	@$(SETUP) test
	@cmake --preset $@ --log-level=WARNING > /dev/null
	@cmake --build build/$@ -j $(JOBS)
	@ctest --test-dir build/$@ --no-tests=error --output-on-failure -j $(JOBS)

fuzz: setup           ## fuzz the scenario loader, the messages of the live lab and the serial line of the coil board, a minute each (SECONDS_TO_FUZZ=600: ten minutes)
	@$(SETUP) fuzz
	@tests/fuzz/run.sh $(or $(SECONDS_TO_FUZZ),60)

page:                 ## build the page of the live lab from web/src into web/dist (needs Node 18 or newer)
	@$(SETUP) test
	@tools/page.sh build

docs: build           ## regenerate docs/reference from the program, and the picture of README.md
	@$(SETUP) docs
	@/usr/bin/python3 tools/make_docs.py --picture

clean:                ## delete build/; runs/ is kept
	@rm -rf build

help:                 ## list the targets
	@grep -E '^[a-z0-9 -]+:.*##' Makefile | sed -E 's/:[^#]*## /\t/' | expand -t 20
