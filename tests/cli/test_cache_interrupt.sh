#!/bin/bash
# Records of a run that is stopped: Ctrl-C writes what is there, a kill at any moment leaves the old file or a whole one.
. "$(dirname "$0")/check.sh"

VIEW=("$SCENE" --size 256x256 --progress none --verbose)
expect 0 render "${VIEW[@]}" --size 32x24 --gather-rays 64 --bounces 1 --records-only --cache-out old.shc
# start WORD...: a render that would take minutes, in the background.
start() { "$SHEEN" render "${VIEW[@]}" "$@" 2>err & pid=$!; }
# stop LINE: Ctrl-C, and the last line on stderr.
stop() {
    end_by INT
    tail -n 1 err | grep -Eq "^sheen: interrupted; $1\$" || fail "the last line is not: interrupted; $1"
    [ ! -e a.exr ] || fail "there is a picture"
    n_checks=$((n_checks + 2))
}
records() {
    expect 0 info --json "$1"
    sed -n 's/^ *"records": \([0-9]*\),*$/\1/p' out | awk '{ n += $1 } END { print n }'
}

# While records are made: those of the file that was read are there in any case.
start -o a.exr --cache-in old.shc --cache-out a.shc --gather-rays 100000 --bounces 1
wait_for 'grep -q "old.shc: [0-9]* records" err'
sleep 0.5
stop 'a.shc has the [0-9]+ records made so far'
told=$(sed -n 's/.* has the \([0-9]*\) records.*/\1/p' err)
[ "$(records a.shc)" -ge "$(records old.shc)" ] || fail "records are lost"
expect 0 render "$SCENE" -o b.exr --size 32x24 --spp 1 --gather-rays 64 --bounces 1 --cache-in a.shc --quiet \
    --stats stats.json
grep -q "\"reused\": $told," stats.json || fail "a later run does not find the $told records"

# While the picture is shaded: its records are written already.
rm -f a.shc
start -o a.exr --cache-out a.shc --gather-rays 64 --bounces 1 --spp 500
wait_for '[ -e a.shc ]'
cp a.shc before.shc
stop 'a.shc has the [0-9]+ records made so far'
cmp a.shc before.shc || fail "the records changed after they were written"

# Without --cache-out, and with it where there is no record yet, as before.
echo old >a.shc
start -o a.exr --cache-out a.shc --gather-rays 100000 --bounces 1
wait_for 'grep -q shapes err'
stop '(nothing was written|a.shc has the [0-9]+ records made so far)'
if grep -q 'nothing was written' err; then [ "$(cat a.shc)" = old ] || fail "the old file is gone"; fi

# Whenever it is killed, the old file is there or a whole one.
for delay in 0.02 0.05 0.08 0.1 0.12 0.15 0.2 0.25 0.3 0.4; do
    cp old.shc a.shc
    "$SHEEN" render "$SCENE" --records-only --cache-out a.shc --size 64x48 --gather-rays 64 --bounces 1 --quiet &
    pid=$!
    sleep $delay
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    expect 0 info a.shc; silent
done
passed
