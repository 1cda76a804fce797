# Everything one types in this repository. `make` alone lists the words.

VENV := .venv
BIN := $(VENV)/bin
PYTHON ?= python3
STAMPS := .setup
PAGE := python/bioscope/live/page/index.html

RUST_SOURCES := Cargo.toml Cargo.lock pyproject.toml $(shell find crates -type f -not -path '*/tests/*' -not -path '*/examples/*')
WEB_SOURCES := $(shell find web -type f -not -path '*/node_modules/*' -not -path '*/dist/*' 2>/dev/null)

.PHONY: help setup demo live test test-rust test-fuzz test-python test-web lint bench docs wheel format clean chromium

help: ## list these words
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

setup: $(STAMPS)/tools $(STAMPS)/page $(STAMPS)/engine ## build everything into this checkout

demo: setup ## make reef.mp4: ten seconds of the living reef, with sound
	@$(BIN)/bioscope film reef -o reef.mp4 --seconds 10 --seed 7
	@echo
	@echo "Watch reef.mp4. To watch the reef live in the browser: make live"

live: setup ## open the reef live in the browser
	@$(BIN)/bioscope live reef --seed 7

test: test-rust test-fuzz test-python test-web ## run every test

test-rust:
	cargo test --workspace --quiet

test-fuzz: ## feed the readers of files with random bytes, for some seconds each
	scripts/fuzz.sh 5

test-python: setup chromium
	$(BIN)/python -m pytest

test-web: $(STAMPS)/page
	cd web && npm test --silent

lint: setup ## check format, types, layers, sizes and quoted paths
	cargo fmt --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	cd python && ../$(BIN)/python -m mypy.stubtest bioscope._engine --allowlist ../scripts/stubtest-allowlist.txt --mypy-config-file ../pyproject.toml
	cd web && npm run check --silent
	$(BIN)/python scripts/check_house.py

format: setup ## put all sources in their format
	cargo fmt
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	cd web && npm run format --silent

bench: setup ## run the benchmarks: a table, and bench/results.json
	$(BIN)/bioscope bench --json bench/results.json

docs: setup ## build the documentation into site/
	$(BIN)/python scripts/reproductions.py
	$(BIN)/python scripts/model_sizes.py
	$(BIN)/python scripts/parameters.py
	$(BIN)/python scripts/gallery.py
	$(BIN)/python scripts/films.py
	$(BIN)/zensical build --strict

wheel: $(STAMPS)/tools $(STAMPS)/page ## build the abi3 wheel into dist/
	rm -rf dist
	$(BIN)/maturin build --release --out dist

clean: ## remove everything that was built
	rm -rf $(VENV) $(STAMPS) target dist site web/node_modules web/dist python/bioscope/live/page
	find . -name '*.abi3.so' -not -path './target/*' -delete

$(STAMPS)/tools: pyproject.toml
	@mkdir -p $(STAMPS)
	@command -v cargo >/dev/null || { echo "make setup: Rust's cargo is missing (https://rustup.rs)" >&2; exit 1; }
	@command -v npm >/dev/null || { echo "make setup: Node.js with npm is missing (version 20 or newer)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "make setup: Python 3.11 or newer is missing; name one with PYTHON=…" >&2; exit 1; }
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV) || { echo "make setup: python3 -m venv failed; on Debian: apt install python3-venv" >&2; exit 1; }
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --group dev
	@touch $@

$(STAMPS)/engine: $(STAMPS)/tools $(RUST_SOURCES)
	. $(BIN)/activate && maturin develop --release --extras all --quiet
	@touch $@

$(STAMPS)/node: web/package-lock.json
	@mkdir -p $(STAMPS)
	cd web && npm install --no-save --silent --no-audit --no-fund
	@touch $@

$(STAMPS)/page: $(STAMPS)/node $(WEB_SOURCES)
	cd web && npm run build --silent
	@test -s $(PAGE)
	@touch $@

chromium:
	@command -v chromium >/dev/null || command -v google-chrome >/dev/null || { \
	  echo "Chromium is missing: the page's tests need it; trying apt-get"; \
	  (apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq chromium) >/dev/null 2>&1 \
	  || { echo "make test: install Chromium (Debian: sudo apt install chromium)" >&2; exit 1; }; }
