#!/bin/bash
# Outputs are looked at before the work, appear whole or not at all, and leave an existing file alone on failure.
. "$(dirname "$0")/check.sh"

# A render that would take hours: it ends at once when the outputs are looked at first.
LONG=(--size 1024x1024 --spp 1000000 --integrator path)
expect 1 render "$SCENE" -o nosuch/a.exr "${LONG[@]}"; says "^sheen: nosuch/a.exr: "
mkdir folder.exr
expect 1 render "$SCENE" -o folder.exr "${LONG[@]}"; says "^sheen: folder.exr: is a folder"
touch file
expect 1 render "$SCENE" -o file/a.exr "${LONG[@]}"; says "^sheen: file/a.exr: "
expect 1 render "$SCENE" -o a.exr --stats nosuch/s.json "${LONG[@]}"; says "^sheen: nosuch/s.json: "
mkfifo pipe.exr
expect 1 render "$SCENE" -o pipe.exr "${LONG[@]}"; says "^sheen: pipe.exr: is not a regular file"
if [ "$(id -u)" != 0 ]; then # root may write everywhere
    mkdir closed; chmod 555 closed
    expect 1 render "$SCENE" -o closed/a.exr "${LONG[@]}"; says "^sheen: closed/a.exr: "
    chmod 755 closed
fi
rm -r folder.exr file pipe.exr

# An existing file stays when the new one cannot be written, and nothing lies beside it.
for ending in exr hdr pfm png; do
    echo "old" >"a.$ending"
    before=$(ls)
    (ulimit -f 1; expect 1 render "$SCENE" -o "a.$ending" "${SMALL[@]}" --size 64x64
        says "^sheen: a.$ending: ") || exit 1
    [ "$(cat "a.$ending")" = old ] || fail "a.$ending was changed by a write that failed"
    [ "$(ls)" = "$before" ] || fail "a failed write left something: $(ls)"
    expect 0 render "$SCENE" -o "a.$ending" "${SMALL[@]}" --quiet; silent
    [ "$(stat -c %s "a.$ending")" -gt 64 ] || fail "a.$ending was not replaced"
done

if [ -w /dev/full ]; then
    expect 1 render "$SCENE" -o b.exr "${SMALL[@]}" --stats /dev/full; says "^sheen: /dev/full: "
    [ -c /dev/full ] || fail "/dev/full was replaced"
    "$SHEEN" render "$SCENE" -o b.exr "${SMALL[@]}" --stats - >/dev/full 2>err
    [ $? -eq 1 ] || fail "statistics that did not arrive are not noticed"
    says '^sheen: standard output: '
fi

# The picture carries how it was made, and its layers.
expect 0 render "$SCENE" -o c.exr "${SMALL[@]}" --seed 7 --aov depth,normal,indirect
expect 0 info c.exr
for words in 'size +24, 16' 'depth\.Z' 'normal\.X' 'indirect\.R' 'sheen\.version [0-9]' 'sheen\.seed 7' \
    'sheen\.scene cornell-box\.xml' '"accuracy":0\.5'; do
    grep -Eq "$words" out || fail "the EXR file does not tell: $words"
done
expect 0 render "$SCENE" -o c.png "${SMALL[@]}" --aov depth; says '^sheen: warning: --aov: '
expect 1 render "$SCENE" -o d.png "${SMALL[@]}" --aov depth --strict; says '^sheen: --aov: '
[ ! -e d.png ] || fail "--strict wrote a picture after a warning"
passed
