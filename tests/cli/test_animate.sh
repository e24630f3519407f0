#!/bin/bash
# sheen animate: its command line, its files, a camera that moves, runs that are stopped and gone on with.
. "$(dirname "$0")/check.sh"

cat >walk.json <<'END'
{"keys": [{"frame": 0, "origin": [0.278, 0.273, -0.8], "target": [0.278, 0.273, 0]},
          {"frame": 2, "origin": [0.4, 0.3, -0.6], "target": [0.278, 0.2, 0.2]},
          {"frame": 5.5, "origin": [0.4, 0.3, -0.4], "target": [0.278, 0.2, 0.2], "fov": 60}]}
END
A=(animate "$SCENE" -o a.##.exr "${SMALL[@]}")

# The command line.
refused SCENE animate -o a.##.exr
refused SCENE "${A[@]}" other.xml
refused --output animate "$SCENE"
refused --output animate "$SCENE" -o a.exr
refused --output animate "$SCENE" -o '#/a.exr'
refused --output animate "$SCENE" -o a.#.#.exr
refused --output animate "$SCENE" -o a.##.jpg
refused --output "${A[@]}" -o a.##.exr
refused --output "${A[@]}" -o a.#.exr # a.100.exr would be both
for frames in '' - 1- -1 2-1 a 1-b 1-2-3 1.5 +1 ' 1' 1000000000 99999999999999999999; do
    refused --frames "${A[@]}" "--frames=$frames"
done
for option in temporal-accuracy max-lifespan time-limit; do
    expect 2 "${A[@]}" "--$option" 1
    says "^sheen: --$option: "
done
for fps in 0 nan 1001 x; do refused --fps "${A[@]}" --fps $fps; done
refused --resume "${A[@]}" -o a.mp4 --resume
for option in static-records prefill; do
    refused "--$option" "${A[@]}" "--$option=maybe"
    refused "--$option" "${A[@]}" "--$option" --integrator path
done
refused --prefill "${A[@]}" --prefill on --static-records off
refused --prefill-frames "${A[@]}" --prefill-frames 0-3 --prefill off
refused --prefill-frames "${A[@]}" --prefill-frames 0-3 --static-records off
refused --prefill-frames "${A[@]}" --prefill-frames 3-0
refused --cache-in "${A[@]}" --cache-in a.shc --static-records off
refused --cache-out "${A[@]}" --cache-out a.shc --integrator path
refused --cache-out "${A[@]}" --cache-out a.exr
for value in extrapolated interpolated nosuch; do refused --temporal "${A[@]}" --temporal $value; done
expect 1 "${A[@]}" --camera-path nosuch.json; says '^sheen: nosuch\.json: '
echo '{"keys": [{"frame": 1}]}' >bad.json
expect 1 "${A[@]}" --camera-path bad.json; says "^sheen: bad\.json:1:11: key 0: 'origin' is missing"
echo '{"keys": [{"frame": 0.2, "origin": [0, 0, 0], "target": [0, 0, 1]},
              {"frame": 0.8, "origin": [0, 0, 0], "target": [0, 0, 1]}]}' >bad.json
refused --frames "${A[@]}" --camera-path bad.json
echo '{"keys": [{"frame": 0, "origin": [0, 0, 0], "target": [0, 0, 1]},
              {"frame": 2, "origin": [0, 0, 2], "target": [0, 0, 1]}]}' >bad.json
expect 1 "${A[@]}" --camera-path bad.json; says '^sheen: bad\.json: at frame 1 the camera stands where it looks'
mkdir -p there/a.03.exr
expect 1 animate "$SCENE" -o nosuch/a.##.exr "${SMALL[@]}"; says '^sheen: nosuch/a\.00\.exr: the folder'
expect 1 animate "$SCENE" -o there/a.##.exr --frames 0-3 "${SMALL[@]}"; says '^sheen: there/a\.03\.exr: is a folder'
[ "$(echo a.*)" = 'a.*' ] || fail "a wrong command line left something: $(echo a.*)"

# The path tells which frames there are; the digits suffice. Records are made once and read by all frames.
expect 0 "${A[@]}" --camera-path walk.json -o b.#.png --quiet --stats s.json; silent
[ "$(echo a.*)" = 'a.##.exr.json a.00.exr a.01.exr a.02.exr a.03.exr a.04.exr a.05.exr' ] || fail "files: $(echo a.*)"
[ "$(echo b.?.png)" = 'b.0.png b.1.png b.2.png b.3.png b.4.png b.5.png' ] || fail "files: $(echo b.*)"
expect 0 info a.04.exr
grep -q 'sheen\.frame 4' out || fail "the EXR file does not tell its frame"
python3 - 2>err <<'END' || fail "the statistics"
import json
s = json.load(open("s.json"))
assert [f["frame"] for f in s["frames"]] == [0, 1, 2, 3, 4, 5]
made, deep = s["records"]["new"], s["records"]["deep"]
kept = s["frames"][0]["records"] - s["frames"][0]["new"]
assert all(f["records"] - f["new"] == kept > 0 for f in s["frames"])
assert made == kept + sum(f["new"] for f in s["frames"]) + deep == s["records"]["irradiance"] + deep
assert s["records"]["reused"] == 6 * kept
assert s["options"]["prefill"] == s["options"]["static-records"] == "on"
assert s["options"]["prefill-frames"] == "0-5"
assert s["rays"]["camera"] >= 6 * 24 * 16 and s["spp_done"] == 1
assert all(0 < f["time"] < s["time"]["total"] for f in s["frames"])
END
# One frame alone, from the same records and at any number of threads, is the same file.
mkdir alone each
expect 0 animate "$SCENE" -o alone/a.##.exr "${SMALL[@]}" --camera-path walk.json --frames 3 --prefill-frames 0-5 --threads 3
cmp a.03.exr alone/a.03.exr || fail "frame 3 alone is another"
expect 0 animate "$SCENE" -o alone/a.##.exr "${SMALL[@]}" --camera-path walk.json --frames 3
cmp -s a.03.exr alone/a.03.exr && fail "frame 3 is the same from records of other frames"

# With a cache for each frame, a frame is the picture that a camera in that place takes. The scene's is at the first key.
E=(animate "$SCENE" -o each/a.##.exr "${SMALL[@]}" --camera-path walk.json --static-records off)
expect 0 "${E[@]}" --frames 0-2 --stats s.json
grep -q '"prefill": "off"' s.json || fail "it says that it fills before"
grep -q '"reused": 0,' s.json || fail "records are kept without --static-records"
expect 0 render "$SCENE" -o one.exr "${SMALL[@]}"
expect 0 compare one.exr each/a.00.exr
grep -q '"mse": 0\.0,' out || fail "the first frame is not what sheen render makes"
expect 0 compare one.exr each/a.02.exr
grep -q '"mse": 0\.0,' out && fail "the camera does not move"
# So it is with paths, which keep nothing.
expect 0 animate "$SCENE" -o each/p.##.exr "${SMALL[@]}" --camera-path walk.json --integrator path --frames 0-1
expect 0 render "$SCENE" -o one.exr "${SMALL[@]}" --integrator path
expect 0 compare one.exr each/p.00.exr
grep -q '"mse": 0\.0,' out || fail "the first frame of paths is not what sheen render makes"

# Without --prefill a frame makes its records and later ones keep them, so that frames depend on those before; a
# resumed run makes them again.
mkdir late
L=(animate "$SCENE" -o late/a.##.exr "${SMALL[@]}" --camera-path walk.json --frames 0-3 --prefill off)
expect 0 "${L[@]}" --stats s.json
python3 - 2>err <<'END' || fail "the statistics without --prefill"
import json
s = json.load(open("s.json"))
records, new = [f["records"] for f in s["frames"]], [f["new"] for f in s["frames"]]
assert records[0] == new[0] > new[1] > 0
assert s["records"]["new"] == sum(new) + s["records"]["deep"]
assert s["records"]["reused"] == sum(records) - sum(new) > 0
END
cp late/a.03.exr want.exr; rm late/a.02.exr late/a.03.exr
expect 0 "${L[@]}" --resume --threads 3 --stats s.json
[ "$(grep -c '"frame":' s.json)" -eq 2 ] || fail "the resumed run did not make two frames"
cmp late/a.03.exr want.exr || fail "frames of a resumed run without --prefill are others"

# Records outlive a run: from their file nothing is made again, and the frames are the same.
mkdir w
W=(animate "$SCENE" -o w/a.##.exr "${SMALL[@]}" --camera-path walk.json)
expect 0 "${W[@]}" --cache-out w/walk.shc --quiet; silent
cmp w/a.03.exr a.03.exr || fail "frame 3 is another with --cache-out"
rm w/a.*
expect 0 "${W[@]}" --cache-in w/walk.shc --quiet --stats s.json; silent
cmp w/a.03.exr a.03.exr || fail "frame 3 is another from a file of records"
python3 - 2>err <<'END' || fail "the statistics with --cache-in"
import json
s = json.load(open("s.json"))
assert s["records"]["new"] == sum(f["new"] for f in s["frames"]) + s["records"]["deep"]
END
refused '--resume: --cache-in was \["' "${W[@]}" --resume

# Videos, where there is a writer of them: the same bits at any number of threads.
if "$SHEEN" animate "$SCENE" -o v.mp4 "${SMALL[@]}" --quiet 2>err; then
    for ending in mp4 mkv webm; do
        for threads in 1 3; do
            expect 0 animate "$SCENE" -o v$threads.$ending --camera-path walk.json "${SMALL[@]}" --quiet --threads $threads
            silent
        done
        cmp v1.$ending v3.$ending || fail "v.$ending differs by threads"
    done
    refused --output animate "$SCENE" -o v.mp4 -o v.mp4
    echo old >v.mp4
    (ulimit -f 1; expect 1 animate "$SCENE" -o v.mp4 "${SMALL[@]}" --size 200x200; says '^sheen: v\.mp4: ') || exit 1
    [ "$(cat v.mp4)" = old ] || fail "v.mp4 was changed by a write that failed"
    [ "$(echo v.*)" = v.mp4 ] || fail "a failed write left something: $(echo v.*)"
else
    says "^sheen: --output: 'v.mp4': this program was built without a writer of videos"
    echo "skipped: videos"
fi

# Ctrl-C keeps what is whole, and nothing else.
mkdir c d
C=(animate "$SCENE" -o c/a.###.exr -o c/b.###.png "${SMALL[@]}" --camera-path walk.json --prefill-frames 0-3)
"$SHEEN" "${C[@]}" --frames 0-199 2>err >out &
pid=$!
wait_for "grep -q '\"next\": [1-9]' c/b.*.json 2>/dev/null"
end_by INT
says '^sheen: interrupted; [1-9][0-9]* frames of 200 are whole$'
n=$(sed 's/^sheen: interrupted; \([0-9]*\).*/\1/' err)
[ "$(ls c | wc -l)" -eq $((2 * n + 2)) ] || fail "$n frames are whole, but there is: $(echo c/*)"

# A later run goes on there, and gives what one run gives.
touch -d '2001-01-01' c/*.exr
expect 0 "${C[@]}" --frames "0-$((n + 1))" --resume --quiet --stats s.json; silent
[ "$(grep -c '"frame":' s.json)" -eq 2 ] || fail "the resumed run did not make two frames"
[ "$(find c -name '*.exr' ! -newermt '2002-01-01' | wc -l)" -eq "$n" ] || fail "a whole frame was made again"
D=(animate "$SCENE" -o d/a.###.exr -o d/b.###.png "${C[@]:6}")
expect 0 "${D[@]}" --frames "0-$((n + 1))" --quiet --threads 1
for file in c/a.*.exr c/b.*.png; do cmp "$file" "d/${file#c/}" || fail "a resumed run gave another $file"; done
expect 0 "${C[@]}" --frames "0-$((n + 1))" --resume --quiet --stats s.json; silent
grep -q '"frame":' s.json && fail "all was there, and a frame was made"
rm d/a.000.exr
expect 0 "${D[@]}" --frames 0-1 --resume --quiet
cmp c/a.000.exr d/a.000.exr || fail "a frame that was lost is not made again"

# It refuses where something differs, and touches nothing.
before=$(ls -l --time-style=full-iso c)
refused '--resume: --accuracy was 0\.5 in the run that .* tells of, and is 0\.25 now' "${C[@]}" --resume --accuracy 0.25
refused '--resume: --exposure was 0\.0 ' "${C[@]}" --resume --exposure 1
refused '--resume: --aov was \[\] ' "${C[@]}" --resume --aov depth
refused '--resume: --size was ' "${C[@]}" --resume --size 12x8
refused '--resume: --prefill-frames was "0-3" ' "${C[@]}" --resume --prefill-frames 0-4
sed 's/0.278/0.279/' walk.json >other.json
expect 1 "${C[@]}" --resume --camera-path other.json
says '^sheen: c/a\.###\.exr\.json: --resume: the camera path is not that of the earlier run$'
sed 's/value="0.7386/value="0.6386/' "$SCENE" >"$FOLDER/cornell-box.xml"
cmp -s "$SCENE" cornell-box.xml && fail "the test did not change the scene"
cp -r "$SOURCE/scenes/cornell-box" .
expect 1 animate cornell-box.xml "${C[@]:2}" --resume
says '^sheen: c/a\.###\.exr\.json: --resume: the scene is not that of the earlier run$'
[ "$(ls -l --time-style=full-iso c)" = "$before" ] || fail "a run that was refused changed something"
for text in '' '{}' '[]' '{"whole frames": {"first": 3, "next": 1}, "made with": {}}'; do
    echo "$text" >c/a.###.exr.json
    expect 1 "${C[@]}" --resume; says '^sheen: c/a\.###\.exr\.json:'
done

# A run from the start does not believe what lies there from before.
expect 0 "${C[@]}" --frames 0 --seed 2 --quiet
expect 0 "${C[@]}" --frames 0-1 --seed 2 --resume --quiet
cmp -s c/a.001.exr d/a.001.exr && fail "a frame of an older run was taken for one of this"

# One that ended before its first frame was there can be gone on with, whatever stood there before.
"$SHEEN" "${C[@]}" --frames 0-199 --prefill-frames 0-199 --seed 3 2>err >out &
pid=$!
wait_for "grep -q '\"seed\": 3' c/b.*.json 2>/dev/null"
end_by INT
says '^sheen: interrupted; [0-9]* frames of 200 are whole$'
expect 0 "${C[@]}" --frames 0 --prefill-frames 0-199 --seed 3 --resume --quiet; silent
passed
