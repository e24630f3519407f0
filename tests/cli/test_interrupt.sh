#!/bin/bash
# A run that is stopped leaves no half of a file: Ctrl-C once and twice, and a kill at any moment.
. "$(dirname "$0")/check.sh"

# start WORD...: a render that would take hours, in the background; returns when the scene is loaded, which it says.
start() {
    "$SHEEN" render "$SCENE" --size 256x256 --spp 1000000 --progress none --verbose "$@" 2>err &
    pid=$!
    for _ in $(seq 300); do
        [ -s err ] && break
        sleep 0.1
    done
    sleep 0.3
}
for signal in INT TERM; do
    for integrator in path irradiance; do
        echo old >a.exr
        start -o a.exr -o b.png --integrator $integrator
        end_by $signal
        [ "$(tail -n 1 err)" = "sheen: interrupted; nothing was written" ] || fail "$integrator: SIG$signal is not told"
        n_checks=$((n_checks + 1))
        [ "$(cat a.exr)" = old ] || fail "SIG$signal changed the existing picture"
        [ "$(echo *)" = "a.exr err" ] || fail "SIG$signal left something: $(echo *)"
    done
done

# So it does while the scene is loaded, here from a pipe into which nobody writes.
mkfifo scene.xml
# ThreadSanitizer holds signals back while the program waits for the pipe.
grep -q __tsan_init "$SHEEN" && signals= || signals="INT TERM"
for signal in $signals; do
    echo old >a.exr
    "$SHEEN" render scene.xml -o a.exr 2>err &
    pid=$!
    sleep 0.3
    kill -$signal $pid
    for _ in $(seq 50); do
        kill -0 $pid 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL $pid 2>/dev/null && fail "SIG$signal does not end the loading of a scene"
    wait $pid; code=$?
    [ $code -eq 130 ] || fail "exit code $code instead of 130 after SIG$signal while loading"
    [ "$(cat err)" = "sheen: interrupted; nothing was written" ] || fail "SIG$signal is not told while loading"
    [ "$(cat a.exr)" = old ] || fail "SIG$signal while loading changed the existing picture"
    n_checks=$((n_checks + 4))
done
rm scene.xml

# Twice ends at once, even where the work would not look for long.
start -o a.exr --integrator path
kill -INT $pid; kill -INT $pid 2>/dev/null
wait $pid; code=$?
[ $code -eq 130 ] || fail "exit code $code instead of 130 after two SIGINT"
[ "$(cat a.exr)" = old ] || fail "two SIGINT changed the existing picture"

# Whenever it is killed, what stands under the name is the old file or a whole picture.
for delay in 0.02 0.05 0.08 0.1 0.12 0.14 0.16 0.2 0.25 0.3; do
    rm -f ./*
    echo old >a.exr
    "$SHEEN" render "$SCENE" -o a.exr --size 300x300 --integrator path --spp 1 --bounces 0 --progress none &
    pid=$!
    sleep $delay
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    if [ "$(head -c 3 a.exr)" != old ]; then expect 0 info a.exr; fi
done
n_checks=$((n_checks + 10))
passed
