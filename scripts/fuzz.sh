#!/bin/bash
# Run every fuzz target for some seconds (10 if not said): scripts/fuzz.sh [SECONDS [TARGET]]
#
# Needs neither cargo-fuzz nor a nightly compiler: the flags are those of cargo-fuzz without its
# sanitizers. What makes a target fail is kept in fuzz/artifacts, and the name is printed.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v c++ >/dev/null || { echo "fuzz: skipped, libFuzzer needs a C++ compiler"; exit 0; }
seconds=${1:-10}
host=$(rustc -vV | sed -n 's/^host: //p')
flags="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
flags+=" -Cllvm-args=-sanitizer-coverage-inline-8bit-counters"
flags+=" -Cllvm-args=-sanitizer-coverage-pc-table"
flags+=" -Cllvm-args=-sanitizer-coverage-trace-compares"
flags+=" --cfg fuzzing -Cdebug-assertions=yes -Coverflow-checks=yes -Ccodegen-units=1"
# With a target of its own, what runs while building is not built with these flags.
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target}/fuzz
RUSTFLAGS="$flags" cargo build --manifest-path fuzz/Cargo.toml --release --quiet --target "$host"
for source in fuzz/fuzz_targets/*.rs; do
  target=$(basename "$source" .rs)
  [ "${2:-$target}" = "$target" ] || continue
  corpus=$CARGO_TARGET_DIR/corpus/$target
  mkdir -p "$corpus" fuzz/artifacts
  if [ ! -e "$corpus/.begun" ]; then
    find tests/lsystem python/bioscope/gallery bench/lsystem -type f -size -8k \
      \( -name '*.l' -o -name '*.lsys' -o -name '*.v' -o -name '*.s' -o -name '*.func' \) \
      | while read -r file; do cp "$file" "$corpus/$(echo "$file" | tr / _)"; done
    touch "$corpus/.begun"
  fi
  echo "fuzz: $target for $seconds s"
  "$CARGO_TARGET_DIR/$host/release/$target" "$corpus" -max_total_time="$seconds" -timeout=20 \
    -rss_limit_mb=2048 -max_len=4096 -artifact_prefix=fuzz/artifacts/ \
    > "$corpus.log" 2>&1 || { tail -n 60 "$corpus.log" >&2; exit 1; }
done
