#!/usr/bin/env python3
"""Checks that every source that a comment in the code cites is in docs/refs.bib.

A comment cites by key, `Source: ward1988 eq. (4); krivanek2005-radiance-caching sec. 4.4`. Whatever looks like a key
(an author's name with a year) in a comment counts; a source without one, such as a standard, is left alone.

Usage: tools/check_refs.py [ROOT]. Prints one line for each unknown key and exits with 1 when there is any.
"""

import pathlib
import re
import sys

KEY = re.compile(r"(?<![\w-])[a-z]+(?:-[a-z]+)*(?:19|20)\d\d[a-z]?(?:-[a-z0-9]+)*")


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    known = set(re.findall(r"^@\w+\{([^,\s]+),", (root / "docs/refs.bib").read_text(encoding="utf-8"), re.M))
    unknown, cited = [], set()
    for folder in ("src", "apps", "tests", "bench", "fuzz", "include"):
        for path in sorted((root / folder).rglob("*.[ch]")):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                comment = re.search(r"(?://|^\s*/?\*+|/\*).*", line)
                if not comment:
                    continue
                for key in KEY.findall(comment.group(0)):
                    cited.add(key)
                    if key not in known:
                        unknown.append(f"{path.relative_to(root)}:{number}: {key} is not in docs/refs.bib")
    print("\n".join(unknown) if unknown else f"{len(cited)} keys cited, all in docs/refs.bib ({len(known)} entries).")
    return 1 if unknown or not known else 0


if __name__ == "__main__":
    sys.exit(main())
