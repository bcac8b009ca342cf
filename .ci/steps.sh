# Shared functions of `.ci/run` and `.ci/full`.
#
# A step that cannot run here is listed as `NOT RUN`, never among those that passed.

passed=()
not_run=()
failed=

# step NAME COMMAND...: runs a command or function, with its wall time. The first failure ends the script.
step() {
    local name=$1 begin=$SECONDS
    shift
    printf '\n== %s\n' "$name"
    failed=$name
    "$@"
    failed=
    printf '== %s: %s s\n' "$name" "$((SECONDS - begin))"
    passed+=("$name: $((SECONDS - begin)) s")
}

# skip NAME WHY: a step that cannot run here.
skip() {
    printf '\nNOT RUN: %s: %s\n' "$1" "$2"
    not_run+=("NOT RUN: $1: $2")
}

# Printed at the end, also after a failure.
summary() {
    local code=$?
    printf '\n== %s s in all\n' "$SECONDS"
    ((${#passed[@]} == 0)) || printf 'passed: %s\n' "${passed[@]}"
    ((${#not_run[@]} == 0)) || printf '%s\n' "${not_run[@]}"
    [[ -z $failed ]] || printf 'FAILED: %s\n' "$failed"
    exit "$code"
}
trap summary EXIT

# as_root COMMAND...
as_root() {
    if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

# need_packages COMMAND=PACKAGE...: installs the packages of the commands that are missing.
need_packages() {
    local pair missing=()
    for pair in "$@"; do
        command -v "${pair%%=*}" >/dev/null || missing+=("${pair#*=}")
    done
    ((${#missing[@]})) || return 0
    printf '== installing %s\n' "${missing[*]}"
    as_root apt-get update -q
    as_root apt-get install -y -q --no-install-recommends ${missing[*]}
}

# The checker of dependencies, built once; two cores take three minutes.
get_deny() {
    PATH=$PWD/target/ci/bin:$PATH
    cargo deny --version >/dev/null 2>&1 ||
        cargo install --quiet --locked cargo-deny@0.20.2 --root target/ci --target-dir target/ci/build
}
