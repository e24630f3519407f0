# Shared by the tests of the program; sourced, not run. Sets SHEEN, SOURCE, SCENE and makes a folder of its own current.
# shellcheck shell=bash disable=SC2034
set -u

SHEEN=${SHEEN_BIN:?the path of the program}
SOURCE=${SHEEN_SOURCE_DIR:?the path of the sources}
SCENE="$SOURCE/scenes/cornell-box.xml"
# Quick also under a sanitizer: no light beyond the first bounce.
SMALL=(--size 24x16 --spp 1 --bounces 1 --gather-rays 64 --accuracy 0.5 --progress none)
FOLDER=$(mktemp -d)
trap 'rm -rf "$FOLDER"' EXIT
cd "$FOLDER" || exit 1

n_checks=0
fail() {
    echo "$0: FAILED: $*"
    [ ! -f err ] || sed 's/^/  stderr: /' err
    exit 1
}
# expect CODE WORD...: runs the program; its output goes to the files out and err.
expect() {
    local want=$1 got=0
    shift
    "$SHEEN" "$@" >out 2>err </dev/null || got=$?
    [ "$got" -eq "$want" ] || fail "exit code $got instead of $want of: sheen $*"
    n_checks=$((n_checks + 1))
}
# says PATTERN: the program's stderr is one line, and it matches.
says() {
    [ "$(wc -l <err)" -eq 1 ] || fail "stderr has $(wc -l <err) lines instead of one that matches: $1"
    grep -Eq -- "$1" err || fail "stderr does not match: $1"
    n_checks=$((n_checks + 1))
}
# refused OPTION WORD...: a wrong command line, and the one line names the option and where help is.
refused() {
    local option=$1
    shift
    expect 2 "$@"
    says "^sheen: $option.*; try 'sheen( $1)? --help'\$"
    [ ! -s out ] || fail "something on stdout of: sheen $*"
}
# wait_for TEST: until the words are true.
wait_for() {
    for _ in $(seq 3000); do
        eval "$1" && return
        sleep 0.02
    done
    fail "this never came true: $1"
}
# end_by SIGNAL: to the program in the background, $pid, which ends as one that was interrupted.
end_by() {
    local got=0
    kill "-$1" "$pid" || fail "ended before its time"
    wait "$pid" || got=$?
    [ $got -eq 130 ] || fail "exit code $got instead of 130 after SIG$1"
    n_checks=$((n_checks + 1))
}
silent() { [ ! -s err ] || fail "something on stderr"; }
passed() { echo "$n_checks checks passed"; }
