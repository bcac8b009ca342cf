#!/bin/sh
# Cargo runs every compiler call through this file, and asks the compiler for its version first.
# At that first question we look whether a C compiler is there: linking needs one, and so do the
# crates that bring C along (zstd for recordings). Without this the same lack shows minutes later
# as a page of linker errors. Costs about a millisecond per call.
#
# Environment RUSTC_WRAPPER (sccache and the like) replaces this file; nothing is lost but the line.

if [ "$2" = "-vV" ] && ! command -v "${CC:-cc}" >/dev/null 2>&1; then
    echo "jamgrip needs a C compiler and linker. On Debian or Ubuntu install them with:" \
        "apt-get update && apt-get install -y gcc libc6-dev" >&2
    exit 1
fi
exec "$@"
