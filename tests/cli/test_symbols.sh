#!/bin/bash
# Every symbol that the library defines for others has the project's prefix, or belongs to a family of inner math.
. "$(dirname "$0")/check.sh"

library=$(dirname "$SHEEN")/../libsheen.a
[ -f "$library" ] || fail "$library is missing"
# Names that begin with __ are those of compilers and sanitizers.
nm -g --defined-only "$library" | awk 'NF == 3 && $3 !~ /^__/ { print $3 }' | sort -u >symbols
[ "$(wc -l <symbols)" -gt 50 ] || fail "the library has only $(wc -l <symbols) symbols"
strangers=$(grep -Ev '^(sheen|transform|sampler)_' symbols)
[ -z "$strangers" ] || fail "symbols without a prefix of the project: $strangers"
n_checks=$(wc -l <symbols)
passed
