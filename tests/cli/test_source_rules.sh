#!/bin/bash
# The tree's own rules: layers, unique names, no printing, no globals; every cited source is in docs/refs.bib; layout.
. "$(dirname "$0")/check.sh"

if ! command -v python3 >/dev/null; then
    echo "skipped: there is no python3"
    exit 0
fi
for tool in check_layers check_refs; do
    python3 "$SOURCE/tools/$tool.py" || fail "tools/$tool.py"
    n_checks=$((n_checks + 1))
done

# The layout is that of the clang-format of Debian 12; others differ in detail.
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    find "$SOURCE"/{src,apps,tests,fuzz,bench} -name '*.[ch]' -print0 |
        xargs -0 clang-format --dry-run -Werror 2>err || fail "a file is not as clang-format makes it"
    n_checks=$((n_checks + 1))
fi

# The checks must be able to fail: a tree that breaks each rule once.
mkdir -p src/base src/math docs
echo '@misc{ward1988,' >docs/refs.bib
cat >src/base/bad.c <<'END'
#include "math/vec.h"
static int counter;
static RTCScene scene;
void f(void)
{
    static int calls = 0;
    printf("hello");
    fprintf(stderr, "hello");
    exit(1); // Source: nobody1999 eq. (3)
}
static const char *const fine = "printf(";
END
cp src/base/bad.c src/math/bad.c
python3 "$SOURCE/tools/check_layers.py" . >findings && fail "check_layers.py takes everything"
for rule in 'bad.c:1: base includes' 'bad.c:2: a writable' 'bad.c:3: only src/ray' 'bad.c:6: a writable' 'bad.c:7: the library' \
    'bad.c:8: the library' 'bad.c:9: the library' 'same file name'; do
    grep -q "$rule" findings || fail "check_layers.py does not find: $rule"
done
grep -q 'bad.c:11' findings && fail "check_layers.py takes a constant for a variable"
python3 "$SOURCE/tools/check_refs.py" . >findings && fail "check_refs.py takes everything"
grep -q 'bad.c:9: nobody1999 ' findings || fail "check_refs.py does not find the unknown source"
passed
