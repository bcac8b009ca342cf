#!/bin/sh
# Cargo runs every compiler call through this file, and asks the compiler for its version first.
# At that first question we look whether a C program can be built: linking needs that, and so do
# the crates that bring C along (zstd for recordings). Without this the same lack shows minutes
# later as a page of linker errors. The question is asked once per toolchain; every other call
# costs about a millisecond.
#
# A RUSTC_WRAPPER in the environment (sccache, or nothing at all where there is no sh) replaces
# this file; all that is lost is the line below.

builds_c() {
    cc=${CC:-cc}
    echo '#include <stdio.h>
int main(void) { return 0; }' | ${cc%% *} -x c -o /dev/null - >/dev/null 2>&1
}

if [ "$2" = "-vV" ] && ! builds_c; then
    echo "jamgrip needs a C compiler and linker; on Debian or Ubuntu:" \
        "apt-get update && apt-get install -y gcc libc6-dev" >&2
    exit 1
fi
exec "$@"
