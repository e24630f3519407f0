#!/bin/bash
# The same scene, options and seed give the same file at every number of threads; another seed gives another.
. "$(dirname "$0")/check.sh"

# The radiance integrator needs glossy surfaces to have something to cache.
for integrator in irradiance path radiance; do
    [ $integrator = radiance ] && SCENE="$(dirname "$SCENE")/glossy-box.xml"
    SAME=("${SMALL[@]}" --size 32x24 --bounces 3 --integrator "$integrator" --spp 2 --aov "depth,indirect,records,coverage,transport" --quiet)
    for threads in 1 2 7; do
        expect 0 render "$SCENE" -o "$integrator-$threads.exr" -o "$integrator-$threads.png" "${SAME[@]}" \
            --threads $threads --stats stats.json
        # Counters do not depend on threads either; only times, memory and the number of threads itself may.
        sed '/"time": {/,/}/d; /"threads"/d; /"peak_rss_bytes"/d; /"time":/d' stats.json >counters-$threads
    done
    for threads in 2 7; do
        for ending in exr png; do
            cmp "$integrator-1.$ending" "$integrator-$threads.$ending" || fail "$integrator: 1 and $threads threads differ"
        done
        cmp counters-1 counters-$threads || fail "$integrator: the counters of 1 and $threads threads differ"
    done
    # From another folder, under another name: nothing of it is in the file.
    mkdir -p sub
    (cd sub && "$SHEEN" render "$SCENE" -o other.exr "${SAME[@]}") 2>err || fail "rendering from another folder"
    cmp "$integrator-1.exr" sub/other.exr || fail "$integrator: the file depends on where it is made"
    expect 0 render "$SCENE" -o seed.png "${SAME[@]}" --seed 1
    cmp -s "$integrator-1.png" seed.png && fail "$integrator: another seed gives the same picture"
done
passed
