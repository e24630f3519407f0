#!/bin/bash
# sheen compare: its JSON, animations, the page, and what it refuses. The pictures are the seeds of the fuzz target,
# 8 x 6 pixels each.
. "$(dirname "$0")/check.sh"
P="$SOURCE/fuzz/corpus/image"

# value KEY: the number of the first line with the key in out, without the comma.
value() { sed -n "s/^ *\"$1\": \([^,]*\),\{0,1\}$/\1/p" out | head -n 1; }
# is KEY LOW HIGH: the value lies between; awk takes no null for a number.
is() {
    value "$1" | awk -v lo="$2" -v hi="$3" '{ n++; if ($1 ~ /[a-z]/ || $1 < lo || $1 > hi) bad = 1 } END { exit bad || !n }' ||
        fail "$1 is $(value "$1") and not in [$2, $3]"
    n_checks=$((n_checks + 1))
}

# One object for one image, with every key; null where a figure is infinite.
expect 0 compare "$P/plain.hdr" "$P/zip_half.exr"; silent
[ "$(head -c 1 out)" = "{" ] || fail "one image does not give one object"
[ "$(grep -o '"[a-z]*":' out | tr -d '":' | tr '\n' ' ')" = "image mse rmse relmse mae psnr flip ssim bias nonfinite " ] ||
    fail "the keys are not those of the manual"
[ "$(value psnr)" = null ] || fail "psnr of equal pictures is not null"
is mse 0 0; is relmse 0 0; is flip 0 0; is ssim 1 1; is bias 0 0; is nonfinite 0 0

# repeat.hdr holds the first column of plain.hdr in all columns: red is 0 instead of x / 8.
# mse = mean((x / 8)^2) / 3 = 140 / 64 / 8 / 3 = 0.0911458, mae = 28 / 8 / 8 / 3 = 0.1458333,
# bias = mean(0, 5/16, 1/2) / mean(7/16, 5/16, 1/2) - 1 = -0.35, psnr against the peak 7 / 8.
expect 0 compare "$P/plain.hdr" "$P/repeat.hdr"; silent
is mse 0.0911458 0.0911459; is rmse 0.301903 0.301904; is mae 0.145833 0.145834; is bias -0.350001 -0.349999
is psnr 9.24279 9.24280; is flip 0.1 1; is ssim 0 0.99

# Several images: an array in their order; formats mix.
expect 0 compare "$P/rgb8.png" "$P/rgb.jpg" "$P/rgb.tga"; silent
[ "$(head -c 1 out)" = "[" ] || fail "two images do not give an array"
[ "$(grep -c '"image"' out)" -eq 2 ] || fail "two images do not give two objects"
grep '"image"' out | head -n 1 | grep -q 'rgb.jpg' || fail "the images are not in the order of the command line"
is flip 0.0001 0.1

# Animations: folders and patterns, matched by number. Frame 2 differs as above and comes back in frame 3, so that in
# red |x' - x| is x / 8 twice, over (x / 8 + 0.1): flicker = sum over x of (x / 8) / (x / 8 + 0.1), / 8 / 3 = 0.2306.
mkdir ref own
for i in 1 2 3; do cp "$P/plain.hdr" "ref/r.000$i.hdr"; cp "$P/runs.hdr" "own/frame-$i.hdr"; done
cp "$P/repeat.hdr" own/frame-2.hdr
echo "not a picture" >own/notes.txt
expect 0 compare ref own; silent; mv out folders
cp "$P/plain.hdr" ref/r.005.hdr; cp "$P/plain.hdr" ref/r.00006.hdr # not what #### stands for
expect 0 compare 'ref/r.####.hdr' own/; silent
rm ref/r.005.hdr ref/r.00006.hdr
diff <(grep -v '"image"' folders) <(grep -v '"image"' out) || fail "a pattern and its folder differ"
is mse 0.0303819 0.0303820; is flicker 0.23060 0.23061; is bias -0.116667 -0.116666
[ "$(grep -c '"frame":' out)" -eq 3 ] || fail "not one object for each frame"
rm own/frame-2.hdr
expect 1 compare ref own; says '^sheen: own: frame 2 is not there'
cp "$P/plain.hdr" own/2.hdr; cp "$P/plain.hdr" own/x2.hdr
expect 1 compare ref own; says '^sheen: own: both .2.hdr. and .x2.hdr. are frame 2'
rm own/*2.hdr; cp "$P/zip_step.exr" own/2.exr
expect 1 compare ref own; says '^sheen: own/2.exr: 40 x 32 pixels'
expect 1 compare ref 'own/####.exr'; says '^sheen: own/####.exr: there are no pictures'

# Folders of pictures that have names: matched by those without the ending, each with its figures, no flicker. Two sizes.
mkdir gallery shown
cp "$P/plain.hdr" gallery/box.hdr; cp "$P/zip_step.exr" gallery/room2.exr
cp "$P/repeat.hdr" shown/box.hdr; cp "$P/zip_step.exr" shown/room2.exr
expect 0 compare gallery shown; silent
[ "$(grep '"picture"' out | tr -d '" ,\n')" = "picture:boxpicture:room2" ] || fail "not the pictures by name"
grep -q flicker out && fail "flicker of pictures that do not follow each other"
is mse 0.0455728 0.0455730 # half of that of repeat.hdr
expect 0 compare --html named.html gallery shown gallery
[ "$(grep -o 'data-picture="[a-z0-9]*" data-image="[a-z]*"' named.html | tr -d '\n')" = "\
data-picture=\"box\" data-image=\"shown\"data-picture=\"room2\" data-image=\"shown\"\
data-picture=\"box\" data-image=\"gallery\"data-picture=\"room2\" data-image=\"gallery\"" ] ||
    fail "the page does not hold each picture of each folder"
# Each reference once, where data-reference points to.
[ "$(grep -c '"reference-hdr">Iz9S' named.html)" -eq 2 ] || fail "not each reference once"
[ "$(grep -o 'data-reference="[0-9]*"' named.html | tr -dc '0-9')" = 0101 ] || fail "references are not shared"
grep -q '<th>room2, shown</th>' named.html || fail "the table does not name the pictures"
mv shown/box.hdr shown/bax.hdr
expect 1 compare gallery shown; says "^sheen: gallery: the picture 'bax' is not there, but it is in 'shown'"
cp "$P/plain.hdr" shown/box.hdr; cp "$P/rgb8.png" shown/box.png
expect 1 compare gallery shown; says "^sheen: shown: both 'box.hdr' and 'box.png' are the picture 'box'"
expect 1 compare ref shown; says "^sheen: shown: both 'box.hdr' and 'box.png'"
expect 1 compare ref gallery; says "^sheen: ref: the picture 'box' is not there, but it is in 'gallery'"

# The page: one file with everything in it, nothing from elsewhere, names harmless.
cp "$P/repeat.hdr" '<b>&.hdr'
expect 0 compare --html page.html "$P/plain.hdr" '<b>&.hdr' "$P/rle_half.exr"; silent
[ "$(grep -c 'data:image/png;base64,iVBOR' page.html)" -eq 6 ] || fail "not three PNG pictures for each image"
[ "$(grep -c '"image-hdr">Iz9SQURJQU5DR' page.html)" -eq 2 ] || fail "not the values of each image"
grep -q '&lt;b&gt;&amp;.hdr' page.html || fail "a name is not escaped"
grep -q "<b>" page.html && fail "a name is not escaped"
grep -Eq 'https?://|src="[^d]|<link' page.html && fail "the page wants something from elsewhere"
grep -q '<td>0.091146</td>' page.html || fail "the figures are not on the page"
mv out first; expect 0 compare --html page2.html "$P/plain.hdr" '<b>&.hdr' "$P/rle_half.exr"
{ cmp -s page.html page2.html && cmp -s out first; } || fail "the same pictures gave another page"
expect 0 compare --html worst.html ref "ref"; silent
expect 1 compare --html none/page.html "$P/plain.hdr" "$P/repeat.hdr"; says '^sheen: none/page.html: '
expect 1 compare --html new.html "$P/plain.hdr" "$P/cmyk.jpg"; says 'CMYK'
[ ! -e new.html ] || fail "a page of half a comparison"

# Layers of EXR files are on the page too, those of a reference once. The legend needs the range: depths of the furnace
# lie between its ball and its walls; the accuracy asked for is that of all its points.
grep -q 'class="[a-z]*-layer"' page.html && fail "pictures without layers have some"
F=(render "$SOURCE/scenes/furnace.xml" --size 24x16 --spp 4 --progress none --gather-rays 64)
expect 0 "${F[@]}" --integrator path --aov depth -o r.exr
expect 0 "${F[@]}" --accuracy 0.25 --aov depth,normal,accuracy,transport -o a.exr
expect 0 "${F[@]}" -o b.exr
expect 0 compare --html layers.html r.exr a.exr r.exr b.exr; silent
[ "$(grep -o 'class="[a-z]*-layer" data-kind="[a-z]*" data-name="[A-Za-z.]*"' layers.html | cut -d '"' -f 2,4,6 | tr '"' ' ')" = "\
reference-layer data depth.Z
image-layer data accuracy.V
image-layer data depth.Z
image-layer data normal.X
image-layer data normal.Y
image-layer data normal.Z
image-layer color transport
image-layer data depth.Z" ] || fail "not each layer of each file"
grep -q 'data-label="accuracy (V)" data-min="0[^"]*" data-max="0.25[^"]*" data-unit="" data-note="a of the records' layers.html ||
    fail "accuracy lacks its range or its note"
grep -q 'data-label="depth (Z)" data-min="[0-9.]*" data-max="[0-9.]*" data-unit="m"' layers.html || fail "depth lacks its unit"
[ "$(grep -c 'data-label="transport (RGB)" data-note="red[^"]*">Iz9S' layers.html)" -eq 1 ] || fail "transport is no colour"
[ "$(grep -c '<img hidden .* src="data:image/png;base64,iVBOR' layers.html)" -eq 7 ] || fail "data are no PNG pictures"
grep -Eq 'https?://|src="[^d]|<link' layers.html && fail "the page with layers wants something from elsewhere"

# Refused.
refused REFERENCE compare
refused IMAGE compare "$P/plain.hdr"
refused IMAGE compare ref "$P/plain.hdr"
refused --nothing compare --nothing "$P/plain.hdr" "$P/plain.hdr"
expect 1 compare "$P/plain.hdr" missing.exr; says '^sheen: missing.exr: No such file or directory$'; [ ! -s out ] || fail "output"
expect 1 compare missing.exr ref; says '^sheen: missing.exr: '
expect 1 compare "$P/plain.hdr" "$P/zip_step.exr"; says '^sheen: .*zip_step.exr: 40 x 32 pixels, but the reference .* has 8 x 6$'
expect 1 compare "$P/plain.hdr" own/notes.txt; says '^sheen: own/notes.txt: not a picture of a known format$'
expect 1 compare --strict "$P/layer.exr" "$P/rle_half.exr"; says 'layer'
passed
