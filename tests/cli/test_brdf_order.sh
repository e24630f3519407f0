#!/bin/bash
# `sheen info --brdf-order`: figures of known lobes, a picture that is whole, mistakes that are told.
. "$(dirname "$0")/check.sh"

cat >lobes.xml <<'XML'
<scene version="3.0.0">
    <emitter type="constant"/><sensor type="perspective"/>
    <shape type="rectangle"><bsdf type="phong" id="dull"><float name="exponent" value="15"/></bsdf></shape>
    <shape type="rectangle"><bsdf type="roughconductor" id="shiny"><float name="alpha" value="0.03"/></bsdf></shape>
    <shape type="rectangle"><bsdf type="diffuse" id="matt"/></shape>
</scene>
XML
expect 0 info --brdf-order orders.png lobes.xml; silent
# Phong 15 needs orders 7 to 10 for half a per cent of its energy; a mirror-like metal has none, and what is diffuse is not listed.
grep -Eq '^harmonics +material dull, orders \(7, 10\), error 0\.00[34][0-9]*, cached 0\.9[0-9]*; material shiny, orders \(0, 0\), error 0, cached 0$' \
    out || fail "other figures: $(grep ^harmonics out)"
expect 0 info orders.png
grep -Eq '^size +419, 282$' out || fail "another size: $(grep ^size out)" # two rows of three panels
expect 0 info --json --brdf-order stricter.exr --order 16 --brdf-error 0.01 lobes.xml; silent
grep -Eq '"cached": 0\.9' out || fail "order 16 does not represent what it should"
cp out first
expect 0 info --json --brdf-order stricter.exr --order 16 --brdf-error 0.01 lobes.xml
cmp -s out first || fail "a second run has other figures"
expect 0 info --brdf-order none.png "$SCENE"
grep -Eq '^harmonics +$' out || fail "the box has glossy materials: $(grep ^harmonics out)"

refused --brdf-order info --brdf-order orders.txt lobes.xml
refused --order info --brdf-order orders.png --order 33 lobes.xml
refused --brdf-error info --brdf-order orders.png --brdf-error 0.6 lobes.xml
expect 1 info --brdf-order nosuch/orders.png lobes.xml; says "^sheen: nosuch/orders.png: "
passed
