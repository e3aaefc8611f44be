# SPDX-License-Identifier: Apache-2.0
# The front door. Every target sets up what it needs: Debian packages (tools/setup) and a CMake preset.
# A build for use is without tests, which need packages of their own; where make test has configured, it stays with them.

JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
configure = cmake --preset release $(if $(wildcard build/release/CMakeCache.txt),,-DKONTUR_BUILD_TESTS=OFF) >/dev/null

.DEFAULT_GOAL := help
.PHONY: wasm fuzzer help setup build demo test asan tsan coverage torture-short torture tidy bench accuracy wheel docs format install clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s%s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: ## install the Debian packages that are missing to build and to test (as root or with sudo)
	@tools/setup build python test

build: ## build the release into build/release: the program, the library and the Python package
	@tools/setup build python
	@$(configure)
	@cmake --build --preset release -j $(JOBS)
	@echo "built build/release/bin/kontur"

demo: ## build the program, generate a phantom into demo/, segment it, compare with the truth
	@tools/setup build
	@$(configure)
	@cmake --build --preset release -j $(JOBS) --target kontur_app
	@tools/demo build/release/bin/kontur demo

test: setup ## build and run every test; what failed beside others runs once more by itself, and has to pass there
	@cmake --preset release -DKONTUR_BUILD_TESTS=ON >/dev/null
	@cmake --build --preset release -j $(JOBS)
	@ctest --preset release -j $(JOBS) || { echo "What failed, once more by itself:"; ctest --preset release --rerun-failed; }

asan: setup ## run every test under AddressSanitizer and UBSan
	@cmake --preset asan >/dev/null
	@cmake --build --preset asan -j $(JOBS)
	@ctest --preset asan -j $(JOBS)

tsan: setup ## run every test under ThreadSanitizer
	@cmake --preset tsan >/dev/null
	@cmake --build --preset tsan -j $(JOBS)
	@ctest --preset tsan -j $(JOBS)

coverage: setup ## run every test and print which share of the lines each folder's tests run (installs gcovr)
	@tools/setup gcovr
	@cmake --preset coverage >/dev/null
	@cmake --build --preset coverage -j $(JOBS)
	@find build/coverage -name '*.gcda' -delete
	@ctest --preset coverage -j $(JOBS) || true
	@tools/coverage build/coverage

fuzzer: setup
	@tools/setup clang
	@cmake --preset fuzz >/dev/null
	@cmake --build --preset fuzz -j $(JOBS) --target kontur_fuzz

torture-short: fuzzer ## fuzz every parser and the pipeline for 30 s each (installs clang)
	@tools/torture 30

torture: fuzzer ## the same for an hour each; all malformed files, 20 drawings on 1 to 8 threads, 200 cancellations
	@cmake --preset release -DKONTUR_BUILD_TESTS=ON >/dev/null
	@cmake --build --preset release -j $(JOBS)
	@KONTUR_MALFORMED_ALL=1 KONTUR_BIG=1 KONTUR_DETERMINISM_CASES=20 KONTUR_DETERMINISM_RUNS=3 KONTUR_TIMED=1 KONTUR_CANCEL_ROUNDS=200 \
	    ctest --preset release -R '^(malformed|determinism|big)\.|^Cancellation\.'
	@tools/torture 3600

tidy: setup ## clang-tidy over the library and the programs (installs clang-tidy)
	@tools/setup clang-tidy
	@cmake --preset dev >/dev/null
	@git ls-files 'src/*.cpp' 'apps/*.cpp' | xargs -n 1 -P $(JOBS) clang-tidy -p build/dev --quiet

bench: build ## time the paper's cases and show the tables (some minutes)
	@build/release/bin/kontur_bench --json build/bench.json
	@bench/tables.py build/bench.json

accuracy: build ## organs of DATA, a folder of scans, by kontur and its peers, into build/organs (an hour; docs/accuracy/organs.md)
	@test -d "$(DATA)" || { echo "make accuracy: say where the scans are: make accuracy DATA=FOLDER"; exit 1; }
	@/usr/bin/python3 bench/organs.py "$(DATA)" build/organs --kontur build/release/bin/kontur --jobs $(JOBS)
	@cat build/organs/tables.md

wheel: ## build a Python wheel that needs the C library and NumPy alone into build/wheels (installs dpkg-dev and patchelf, builds DCMTK once)
	@tools/setup build python dpkg-dev patchelf
	@packaging/build_wheel

wasm: ## build the npm package kontur-wasm into build/kontur-wasm (installs clang, lld and libc++ for WebAssembly)
	@tools/setup build wasm
	@$(configure)
	@wasm/build

docs: ## write the C++ reference to build/release/reference/html (installs doxygen)
	@tools/setup build doxygen
	@$(configure)
	@cmake --build --preset release --target kontur_reference

format: ## format the C++ sources (needs clang-format-14) and the page's TypeScript
	@git ls-files '*.h' '*.cpp' | xargs clang-format-14 -i
	@cd apps/viewer/web && { test -x node_modules/.bin/prettier || npm ci --ignore-scripts --no-audit --no-fund --loglevel=error; } && npm run --silent format

install: build ## install kontur under PREFIX (default /usr/local)
	@cmake --install build/release --prefix $(PREFIX)

clean: ## remove build/ and demo/
	@rm -rf build demo
