#!/bin/bash
# Help and man pages say what the parser takes: both come from its table, and the stored pages are current.
. "$(dirname "$0")/check.sh"

expect 0 --version; silent
grep -Eq '^sheen [0-9]+\.[0-9]+\.[0-9]+$' out || fail "the version is not 'sheen X.Y.Z'"
expect 0 --help; silent; mv out overview
expect 0 help; cmp -s out overview || fail "'sheen help' and 'sheen --help' differ"
expect 0 help --man; silent
cmp out "$SOURCE/docs/man/sheen.1" || fail "docs/man/sheen.1 is not current; see CONTRIBUTING.md"

commands=$(sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' overview)
[ -n "$commands" ] || fail "the overview names no commands"
for command in $commands; do
    expect 0 "$command" --help; silent; mv out long
    expect 0 help "$command"; cmp -s out long || fail "'sheen help $command' and 'sheen $command --help' differ"
    awk 'length > 80 { exit 1 }' long || fail "the help of $command has a line over 80 characters"
    grep -q '^Example:' long || fail "the help of $command has no example"
    grep -q 'not in this version' long && fail "the help of $command names what does not exist"

    # Every option that help names is taken, and has an example; those with an argument have a default too.
    while read -r option argument; do
        block=$(awk -v o="$option" '/^  [^ ]/ { on = index(" " $0 " ", " " o " ") } on' long)
        grep -q 'Example: ' <<<"$block" || fail "$command $option has no example"
        [ -n "$argument" ] || continue
        grep -q 'Default: ' <<<"$block" || fail "$command $option has no default"
        [ "${argument#[}" = "$argument" ] || continue # it may be left out
        expect 2 "$command" "$option"
        says "^sheen: $option: its argument .* is missing"
    done < <(grep -Eo '^  (-[a-z], )?--[a-z-]+( .*)?$' long | sed -E 's/^  (-[a-z], )?//')

    expect 0 help --man "$command"; silent
    cmp out "$SOURCE/docs/man/sheen-$command.1" || fail "docs/man/sheen-$command.1 is not current; see CONTRIBUTING.md"
    if command -v groff >/dev/null; then
        groff -man -ww -z out 2>err || fail "groff does not take the man page of $command"
        silent
    fi
done

# The defaults that help tells are those with which a render without options runs, where they are one word.
expect 0 render "$SCENE" -o a.png --size 8x8 --spp 1 --quiet --stats stats.json
expect 0 render --help; mv out long
n_defaults=0
while read -r option value; do
    told=$(awk -v o="--$option" '/^  [^ ]/ { on = index(" " $0 " ", " " o " ") } on && /^ *Default: [^ ]*$/ { print $2 }' long)
    if [ -z "$told" ] || [ "$told" = none ]; then continue; fi
    [ "$told" = "$value" ] || fail "help tells that the default of --$option is $told, but it is $value"
    n_defaults=$((n_defaults + 1))
done < <(sed -n '/"options": {/,/^  }/s/^ *"\([a-z-]*\)": "\{0,1\}\([^",[]*\)"\{0,1\},\{0,1\}$/\1 \2/p' stats.json)
[ $n_defaults -ge 9 ] || fail "only $n_defaults defaults were compared"

# What cannot be printed is an error.
if [ -w /dev/full ]; then
    "$SHEEN" help >/dev/full 2>err
    [ $? -eq 1 ] || fail "a full device is not noticed"
    says '^sheen: standard output: '
fi
passed
