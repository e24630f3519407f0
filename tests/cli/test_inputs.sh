#!/bin/bash
# Whatever is wrong with an input ends with 1 and one line that begins with the file's name; info tells of good ones.
. "$(dirname "$0")/check.sh"

bad() {
    local file=$1 command more
    for command in info render; do
        more=()
        [ $command = info ] || more=(-o bad.exr)
        expect 1 $command "$file" "${more[@]}"; says "^sheen: $file(:[0-9]+:[0-9]+)?: "
        [ ! -e bad.exr ] || fail "a bad scene left a picture"
    done
}
bad nosuch.xml
mkdir folder.xml; bad folder.xml
: >empty.xml; bad empty.xml
echo 'not a scene' >text.xml; bad text.xml
head -c 2000 "$SCENE" >cut.xml; bad cut.xml
echo '<scene version="3.0.0"><shape type="sphere"></scene>' >tags.xml; bad tags.xml
says '^sheen: tags.xml:1:[0-9]+: '
head -c 4096 /dev/urandom >random.xml; bad random.xml
cp "$SCENE" scene.nosuch; bad scene.nosuch
head -c 4096 /dev/urandom >random.ply
echo '<scene version="3.0.0"><shape type="ply"><string name="filename" value="random.ply"/></shape></scene>' >mesh.xml
expect 1 render mesh.xml -o bad.exr; says '^sheen: random.ply:1: not a PLY file$'
cp random.ply random.serialized; sed s/ply/serialized/g mesh.xml >serialized.xml
expect 1 render serialized.xml -o bad.exr; says '^sheen: random.serialized: mesh 0: not a serialized mesh'
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >bad.obj; bad_obj() { expect 1 render bad.obj -o bad.exr; says "$1"; }
bad_obj '^sheen: bad.obj:4: vertex index 4 is out of range: there are 3 so far$'
printf 'mtllib bad.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >bad.obj
printf 'newmtl a\nKd 1 red 0\n' >bad.mtl; bad_obj "^sheen: bad.mtl:2: 'Kd' needs finite numbers\$"
rm bad.obj bad.mtl; bad bad.obj
: >empty.exr; expect 1 info empty.exr; says '^sheen: empty.exr: '
head -c 4096 /dev/urandom >random.exr; expect 1 info random.exr; says '^sheen: random.exr: '
expect 1 info nosuch.png; says '^sheen: nosuch.png: '

expect 0 info "$SCENE"; silent
for words in '^kind +scene$' '^triangles +[1-9]' '^lights +area 1' '^cameras ' '^materials +diffuse' '^bounds +\('; do
    grep -Eq "$words" out || fail "info of the scene does not tell: $words"
done
expect 0 render "$SCENE" -o a.exr "${SMALL[@]}" --quiet
head -c 600 a.exr >cut.exr; expect 1 info cut.exr; says '^sheen: cut.exr: '
expect 0 info a.exr; silent
for words in '^kind +image$' '^size +24, 16$' '^red +mean 0\.[0-9]+, min ' 'nonfinite 0$'; do
    grep -Eq "$words" out || fail "info of the picture does not tell: $words"
done

# Of several parts all channels are told, and which part's colours the figures are.
expect 0 info "$SOURCE/fuzz/corpus/image/parts_depth_first.exr"; says "of 2 parts, part 'beauty' is taken\$"
grep -Eq '^channels +depth\.Z, beauty\.B, beauty\.G, beauty\.R$' out || fail "info does not tell the parts' channels"

# -D gives a scene's $parameters, and a camera without perspective has a width in place of an angle.
cat >asked.xml <<'END'
<scene version="3.0.0">
    <default name="side" value="8"/>
    <sensor type="orthographic">
        <transform name="to_world"><scale x="3" y="3"/></transform>
        <film type="hdrfilm"><integer name="width" value="$side"/><integer name="height" value="$side"/></film>
    </sensor>
    <emitter type="constant"/>
</scene>
END
expect 0 info asked.xml -D side=16; silent
grep -Eq '^cameras +name camera, size \(16, 16\), width 6, spp 0$' out || fail "info tells of another camera"
expect 0 render asked.xml -Dside=4 -o asked.exr "${SMALL[@]:2}" --quiet; expect 0 info asked.exr
grep -Eq '^size +4, 4$' out || fail "-D did not reach the picture"
expect 0 info asked.xml --define=of=1; says '^sheen: warning: asked.xml: nothing refers to \$of$'
refused --define info asked.xml -D side
refused --define render asked.xml -D =1 -o asked.exr

# A file's own text reaches the terminal neither as a command nor as a second line.
name=$(printf 'e\033[31mvil\n.xml')
cat >"$name" <<'END'
<scene version="3.0.0">
    <nosuch name="warned about"/>
    <shape type="sphere"><emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
</scene>
END
expect 0 info "$name"
cat out err >both
grep -q "$(printf '\033')" both && fail "an escape character was printed"
grep -vq '^sheen: warning: ' err && fail "a message has a second line"
expect 1 info "no$name"; says '^sheen: noe\?\[31mvil\?\.xml: '
passed
