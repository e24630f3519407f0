# Shared by demo, test, fuzz and .ci/run; sourced, not run. Sets ROOT and JOBS.
# shellcheck shell=bash disable=SC2034

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
JOBS=$(nproc 2>/dev/null || echo 2)

# What building needs on Debian 12. libc6-dev is only recommended by gcc, so a minimal system may lack it.
BUILD_PACKAGES=(gcc libc6-dev cmake make pkg-config libembree-dev libopenexr-dev libpng-dev libjpeg-dev libstb-dev
    libexpat1-dev libjansson-dev zlib1g-dev libzstd-dev libxxhash-dev)
TEST_PACKAGES=(libcmocka-dev)

say() { printf '%s\n' "$*" >&2; }
die() { say "$0: $*"; exit 1; }

missing_packages() {
    local package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
    done
}

# need_packages PACKAGE...: installs those that are not there. Asks for root's rights only when something is missing.
need_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "This is not a Debian system: the packages are taken to be there ($*)."
        return
    fi
    local missing
    read -r -d '' -a missing <<<"$(missing_packages "$@")" || true
    [ ${#missing[@]} -gt 0 ] || return 0

    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        # Without a terminal sudo cannot ask for a password: take it only when it needs none.
        if command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
            as_root=(sudo)
        else
            die "missing packages; as root, run: apt-get install --no-install-recommends ${missing[*]}"
        fi
    fi
    say "Installing missing packages: ${missing[*]}"
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300)
    "${apt[@]}" update -qq || say "apt-get update failed; going on with the package lists that are there"
    "${apt[@]}" install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
        die "apt-get could not install: ${missing[*]}"
}

# build PRESET [CMAKE OPTION...]: configures and builds; says nothing when all is up to date.
build() {
    local preset=$1 log
    shift
    log="$ROOT/build/$preset.log"
    mkdir -p "$ROOT/build"
    if ! (cd "$ROOT" && cmake --preset "$preset" "$@" && cmake --build "build/$preset" -j "$JOBS") >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        die "building '$preset' failed; all of its output is in $log"
    fi
}
