#!/bin/bash
# A wrong command line ends with 2 and one line that names what is wrong, before anything is read or written.
. "$(dirname "$0")/check.sh"

expect 2; says "^sheen: a command is missing; try 'sheen --help'$"
expect 2 paint; says "^sheen: there is no command 'paint'; try"
expect 2 --paint; says "^sheen: there is no option '--paint'; try"
expect 2 view x.xml; says "'view' is not in this version"

R=(render "$SCENE" -o a.exr)
refused SCENE render -o a.exr
refused SCENE render "$SCENE" other.xml -o a.exr
refused --output render "$SCENE"
refused --output render "$SCENE" -o a.jpg
refused --output render "$SCENE" -o a
refused --output render "$SCENE" -o a.exr -o a.exr
refused -o render "$SCENE" -o
refused -o render "$SCENE" -o ''
refused --output render "$SCENE" --output=
refused --nosuch "${R[@]}" --nosuch
refused -z "${R[@]}" -z 3
refused --quiet "${R[@]}" --quiet=yes
refused FILE info
refused FILE info a.exr b.exr
refused --output info --output b.exr
refused "'nosuch'" help nosuch
refused "'info'" help render info

# Numbers: whole, in their range, and nothing after them. All forms with one option of each kind, two with the others.
for number in '' -1 +1 ' 1' 1x 1.5 0x10 nan inf 99999999999999999999; do
    refused --spp "${R[@]}" "--spp=$number"
done
for option in --light-samples --bounces --gather-rays --threads --seed; do
    for number in -1 1x; do refused "$option" "${R[@]}" "$option=$number"; done
done
for option in --spp --light-samples --gather-rays --threads; do refused "$option" "${R[@]}" "$option" 0; done
for number in '' x nan inf -inf 1e999 0x1 ' 1' 1,5 1.0.0 1e . 0 -0.1; do
    refused --accuracy "${R[@]}" "--accuracy=$number"
done
for option in --exposure --time-limit; do
    for number in nan 1x; do refused "$option" "${R[@]}" "$option" "$number"; done
done
refused --accuracy "${R[@]}" --accuracy 1.5
refused --time-limit "${R[@]}" --time-limit 0
refused --threads "${R[@]}" --threads 1025
refused --order "${R[@]}" --order 17
refused --brdf-error "${R[@]}" --brdf-error 0.6
refused --seed "${R[@]}" --seed 4294967296
for size in '' 10 10x x10 0x10 10x0 10x10x10 -1x10 10x-1 '10 x 10' 1e1x10 65537x1 65536x65536; do
    refused --size "${R[@]}" "--size=$size"
done

refused --reach-min "${R[@]}" --reach-min 0.4
refused --reach-min "${R[@]}" --reach-min 9 --reach-max 8
refused --reach-max "${R[@]}" --reach-max 1001

# Names.
for option in --integrator --error-metric --gradients --basis --secondary --adaptive --neighbor-clamping --gradient-clamping --progress --aov; do
    refused "$option" "${R[@]}" "$option" nosuch
    refused "$option" "${R[@]}" "$option="
    refused "$option" "${R[@]}" "$option"
done
refused --aov "${R[@]}" --aov depth,nosuch
refused --aov "${R[@]}" --aov depth,
refused --aov "${R[@]}" --aov depth,,normal
refused --time-limit "${R[@]}" --time-limit 1

# Options and values of later versions say so.
refused --frame "${R[@]}" --frame 1
grep -q 'not in this version' err || fail "--frame does not say that it is not in this version"
for value in integrator=light-vectors; do
    refused "--${value%%=*}" "${R[@]}" "--$value"
    grep -q 'not in this version' err || fail "--$value does not say that it is not in this version"
done

# What only the scene can tell.
refused --camera "${R[@]}" --camera nosuch
refused --camera "${R[@]}" --camera 99
[ ! -e a.exr ] || fail "a wrong command line left a picture"

# The forms in which a right one may be written.
expect 0 render "${SMALL[@]}" -oa.exr -- "$SCENE"
expect 0 render --output=b.exr "$SCENE" "${SMALL[@]}" --camera 0 --spp=1 --spp 2
expect 0 render "$SCENE" -o c.exr -o c.hdr -o c.pfm -o c.png "${SMALL[@]}" --quiet
silent
for file in a.exr b.exr c.exr c.hdr c.pfm c.png; do [ -s "$file" ] || fail "$file is missing"; done
passed
