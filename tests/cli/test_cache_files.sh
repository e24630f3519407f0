#!/bin/bash
# Records in files: a later picture from them is the same, bit by bit; other views add to them; what is broken is refused.
. "$(dirname "$0")/check.sh"

GLOSSY="$(dirname "$SCENE")/glossy-box.xml"
# Several rounds of filling, and records of the picture's own.
VIEW=(--size 32x24 --spp 8 --noise 0 --bounces 2 --gather-rays 64 --accuracy 0.4 --progress none)
# count NAME: a number of stats.json.
count() { sed -n "s/^ *\"$1\": \([0-9]*\),*\$/\1/p" stats.json | head -n 1; }
# records FILE: how many a cache file holds.
records() {
    expect 0 info --json "$1"
    sed -n 's/^ *"records": \([0-9]*\),*$/\1/p' out | awk '{ n += $1 } END { print n }'
}
# warned PATTERN: one warning, and it matches.
warned() { says "^sheen: warning: $1"; }

# ---- the same bits ----------------------------------------------------------------------------------------------
for integrator in radiance irradiance; do
    scene=$SCENE
    [ $integrator = radiance ] && scene=$GLOSSY
    same=("$scene" "${VIEW[@]}" --integrator $integrator)
    rm -f ./*.shc ./*.exr
    expect 0 render "${same[@]}" -o plain.exr; silent
    expect 0 render "${same[@]}" -o first.exr --cache-out a.shc --threads 1 --stats stats.json; silent
    cmp plain.exr first.exr || fail "--cache-out changes the picture"
    [ "$(count reused)" -eq 0 ] || fail "records are reused without --cache-in"
    expect 0 render "${same[@]}" --records-only --cache-out b.shc --threads 2; silent
    [ "$(echo ./*.exr)" = "./first.exr ./plain.exr" ] || fail "--records-only writes a picture"
    cmp a.shc b.shc || fail "--records-only makes other records, or other threads do"
    n=$(records a.shc)
    [ "$n" -gt 50 ] || fail "only $n records"
    for threads in 1 5; do
        expect 0 render "${same[@]}" -o later.exr --cache-in b.shc --cache-out c.shc --threads $threads \
            --stats stats.json
        silent
        cmp plain.exr later.exr || fail "$integrator: a picture from a file differs at $threads threads"
        cmp a.shc c.shc || fail "$integrator: the records have changed on their way through a picture"
        [ "$(count reused)" -eq "$n" ] || fail "$(count reused) records are reused instead of $n"
    done
    n_checks=$((n_checks + 10))
done
# So many records that the order in which look-ups meet them shows.
for scene in "$SCENE" "$GLOSSY"; do
    many=("$scene" --size 64x48 --spp 1 --bounces 1 --gather-rays 64 --quiet)
    expect 0 render "${many[@]}" -o first.exr --cache-out a.shc
    expect 0 render "${many[@]}" -o later.exr --cache-in a.shc
    cmp first.exr later.exr || fail "a picture from a file of many records differs"
done
# Rays are saved: with one bounce what is left are those of the few records of the picture's own.
expect 0 render "$SCENE" "${VIEW[@]}" --bounces 1 -o plain.exr --cache-out a.shc --stats stats.json
made=$(count gather)
expect 0 render "$SCENE" "${VIEW[@]}" --bounces 1 -o plain.exr --cache-in a.shc --stats stats.json
[ "$((5 * $(count gather)))" -lt "$made" ] || fail "$(count gather) gather rays with records, $made without"

# ---- other views ------------------------------------------------------------------------------------------------
sed 's/<lookat origin="[^"]*"/<lookat origin="0.4, 1.2, 4.5"/; s/<look_at origin="[^"]*"/<look_at origin="0.4, 1.2, 4.5"/;
     s/<lookAt origin="[^"]*"/<lookAt origin="0.4, 1.2, 4.5"/' "$GLOSSY" >other.xml
cmp -s "$GLOSSY" other.xml && fail "the camera of glossy-box.xml is not moved by this test"
expect 0 render "$GLOSSY" "${VIEW[@]}" --records-only --cache-out a.shc
expect 0 render other.xml "${VIEW[@]}" -o o.exr --cache-in a.shc --cache-out b.shc --stats stats.json; silent
[ "$(count reused)" -eq "$(records a.shc)" ] || fail "another view does not reuse all records"
[ "$(records b.shc)" -gt "$(records a.shc)" ] || fail "another view adds no record"
expect 0 render "$GLOSSY" "${VIEW[@]}" -o both.exr --cache-in b.shc --stats stats.json; silent
# The first records are those of the first file; look-ups meet them with more around them, in the same picture.
expect 0 compare plain.exr both.exr
# Files add up, and a file may be replaced by what is made from it.
expect 0 render other.xml "${VIEW[@]}" --records-only --cache-out o.shc
expect 0 render "$GLOSSY" "${VIEW[@]}" --records-only --cache-in a.shc --cache-in o.shc --cache-out a.shc \
    --stats stats.json
silent
[ "$(records a.shc)" -ge "$(count reused)" ] || fail "records are lost"
expect 0 render "$GLOSSY" "${VIEW[@]}" -o both.exr --cache-in o.shc --cache-in b.shc --stats stats.json
[ "$(count reused)" -eq $(($(records o.shc) + $(records b.shc))) ] || fail "the records of two files do not add up"

# ---- other scenes and options -----------------------------------------------------------------------------------
sed '0,/<rgb name="reflectance" value="[^"]*"/s//<rgb name="reflectance" value="0.11, 0.12, 0.13"/' "$GLOSSY" >painted.xml
cmp -s "$GLOSSY" painted.xml && fail "the walls of glossy-box.xml are not painted by this test"
expect 0 render painted.xml "${VIEW[@]}" -o p.exr --cache-in b.shc; warned 'b.shc: its records were made in another scene'
expect 1 render painted.xml "${VIEW[@]}" -o no.exr --cache-in b.shc --strict; says '^sheen: b.shc: .* another scene'
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --seed 2
warned 'b.shc: its records were made with --seed 0, which is 2 now'
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --brdf-error 0.02
warned 'b.shc: its records were made with --brdf-error 0.05, which is 0.02 now'
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --order 4; warned 'b.shc: .*--order 10, which is 4'
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --basis sh; warned 'b.shc: .*--basis "auto"'
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --integrator irradiance
warned 'b.shc: .*--integrator "radiance"'
expect 1 render "$GLOSSY" "${VIEW[@]}" -o no.exr --cache-in b.shc --bounces 1 --strict; says '^sheen: b.shc: .*--bounces 2'
# What records do not depend on may change.
expect 0 render "$GLOSSY" "${VIEW[@]}" -o p.exr --cache-in b.shc --spp 2 --noise 0 --size 20x10 --exposure 1 --filter box
silent

# ---- broken files -----------------------------------------------------------------------------------------------
# refuses REASON: bad.shc is refused, and leaves neither picture nor records.
refuses() {
    expect 1 render "$SCENE" "${VIEW[@]}" -o no.exr --cache-in bad.shc --cache-out no.shc
    says "^sheen: bad.shc: $1"
    [ ! -e no.exr ] && [ ! -e no.shc ] || fail "a broken cache file leaves a picture or records"
    expect 1 info bad.shc; says "^sheen: bad.shc: $1"
    [ ! -s out ] || fail "info tells something of a broken file"
}
expect 0 render "$SCENE" "${SMALL[@]}" --records-only --cache-out small.shc
size=$(wc -c <small.shc)
for length in 0 8 47 $((size - 1)); do
    head -c "$length" small.shc >bad.shc
    refuses '(the file is (empty|cut off)|not a cache file|the file ends in its header)'
done
for place in 0 8 16 $((size / 2)); do
    cp small.shc bad.shc
    byte=$(od -An -tu1 -j "$place" -N 1 small.shc)
    printf "\\x$(printf %x $((byte ^ 16)))" | dd of=bad.shc bs=1 seek="$place" conv=notrunc status=none
    refuses '(not a cache|a cache file of version|the file (is cut|goes on|is damaged))'
done
cp small.shc bad.shc; echo >>bad.shc; refuses 'the file goes on after its end, by 1 bytes'
cp "$SCENE" bad.shc; refuses 'not a cache file'
rm bad.shc; refuses 'No such file'
mkdir bad.shc; refuses 'Is a directory'; rmdir bad.shc

# ---- wrong command lines ----------------------------------------------------------------------------------------
R=(render "$SCENE" "${SMALL[@]}")
refused --cache-in "${R[@]}" -o no.exr --cache-in small.shc --integrator path
refused --cache-out "${R[@]}" -o no.exr --cache-out no.shc --integrator path
refused --cache-out "${R[@]}" -o no.exr --cache-out no.exr
refused --cache-out "${R[@]}" -o no.exr --cache-out no
refused --cache-in "${R[@]}" -o no.exr --cache-in small.shc --cache-in small.shc
refused --records-only "${R[@]}" --records-only
refused --output "${R[@]}" --records-only --cache-out no.shc -o no.exr
expect 1 "${R[@]}" -o no.exr --cache-out nosuch/no.shc; says '^sheen: nosuch/no.shc: '
[ ! -e no.exr ] && [ ! -e no.shc ] || fail "a wrong command line leaves something"

# ---- no light to keep -------------------------------------------------------------------------------------------
expect 0 render "$SCENE" "${VIEW[@]}" -o none.exr --bounces 0
expect 0 render "$SCENE" "${VIEW[@]}" -o later.exr --bounces 0 --cache-out none.shc; silent
cmp none.exr later.exr || fail "--cache-out changes a picture of direct light"
expect 0 render "$SCENE" "${VIEW[@]}" -o later.exr --bounces 0 --cache-in none.shc; silent
cmp none.exr later.exr || fail "a cache without records changes a picture of direct light"
passed
