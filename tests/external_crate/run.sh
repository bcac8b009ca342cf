#!/bin/sh
# Builds a crate outside the tree that depends on the library without features, and runs it.
# Usage: tests/external_crate/run.sh [cargo arguments, such as --offline]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sed "s|@JAMGRIP@|$root|" "$here/Cargo.toml.in" > "$folder/Cargo.toml"
cp "$here/program.rs" "$folder/main.rs"
cp "$root/Cargo.lock" "$folder/Cargo.lock" # the same versions as the library's own
CARGO_TARGET_DIR="${EXTERNAL_TARGET_DIR:-$folder/target}" \
    cargo run --release --quiet --manifest-path "$folder/Cargo.toml" "$@"
