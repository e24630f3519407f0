#!/usr/bin/env python3
"""Checks the rules of the source tree that a compiler does not.

- Folders of src/ stand in the order of the flow; a file includes from its own folder and from folders above it only.
- File names are unique within src/ (a header and its source share theirs).
- Only src/ray names Embree.
- Nothing in src/ prints to stdout or stderr, ends the process, or holds a writable global.

Usage: tools/check_layers.py [ROOT]. Prints one line for each finding and exits with 1 when there is any.
"""

import pathlib
import re
import sys

# From the bottom up. film stands before integrator because integrators write into it, render after both.
ORDER = ["base", "math", "basis", "image", "scene", "io", "ray", "material", "light", "gather", "cache", "film",
         "integrator", "render", "splat", "dist", "preview", "api"]

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
PRINTS = re.compile(r"(?<!format\()\b(?:printf|vprintf|puts|putchar|perror|(?:f|vf)printf\s*\(\s*std(?:out|err)|"
                    r"f(?:puts|putc|write|flush)\s*\([^;]*\bstd(?:out|err))\b\s*\(?")
EXITS = re.compile(r"\b(?:exit|_exit|_Exit|quick_exit|abort)\s*\(")
# A definition outside functions starts in column 0. These are not variables.
NOT_A_VARIABLE = re.compile(r"^(?:typedef|extern|enum|struct \w+;|union|_Static_assert|#|\}|//|/\*| )")
STATIC_LOCAL = re.compile(r"^\s+static\b(?!\s+inline)(?P<rest>[^;({]*)(?:[;=]|\{)")


def without_comments_and_strings(text):
    """Blanks comments and string literals; line numbers stay."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', blank, text, flags=re.S)


def is_writable_global(line):
    """True for a line in column 0 that defines a variable which is not const."""
    if not line or line[0].isspace() or NOT_A_VARIABLE.match(line):
        return False
    head = re.split(r"[=;{]", line, maxsplit=1)[0]
    if not re.match(r"^[\w\s*\[\],()+\-]+$", head) or "(" in re.sub(r"\(\*[^)]*\)", "", head):
        return False  # a function, or a macro call
    if not re.search(r"[=;]", line) or not re.match(r"^(?:\w+[\s*]+)+\w+", head):
        return False
    if re.match(r"^(?:struct|union|enum)\s+\w*\s*$", head):
        return False  # a type
    # const must bind to the variable itself: after the last star of a pointer.
    after_star = head.rsplit("*", 1)[1] if "*" in head else head
    return not re.search(r"\bconst\b", after_star)


def check_file(path, name, folder, findings):
    raw = path.read_text(encoding="utf-8")
    code = without_comments_and_strings(raw)
    for number, (line, bare) in enumerate(zip(raw.splitlines(), code.splitlines()), 1):
        where = f"{name}:{number}"
        include = INCLUDE.match(line)
        if include:
            target = include.group(1).split("/")
            if len(target) != 2 or target[0] not in ORDER:
                findings.append(f"{where}: include \"folder/file.h\" of a known folder, not \"{include.group(1)}\"")
            elif ORDER.index(target[0]) > ORDER.index(folder):
                findings.append(f"{where}: {folder} includes from {target[0]}, which is below it")
        if folder != "ray" and re.search(r"embree|\brtc[A-Z]|\bRTC[A-Z_]", line if include or "<" in line else bare):
            findings.append(f"{where}: only src/ray names Embree")
        if PRINTS.search(bare):
            findings.append(f"{where}: the library does not print; use the log")
        if EXITS.search(bare):
            findings.append(f"{where}: the library does not end the process")
        local = STATIC_LOCAL.match(bare)
        if is_writable_global(bare) or (local and not re.search(r"\bconst\b", local.group("rest"))):
            findings.append(f"{where}: a writable global or static variable")


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    findings, seen, count = [], {}, 0
    for path in sorted((root / "src").rglob("*.[ch]")):
        name, folder = str(path.relative_to(root)), path.parent.name
        count += 1
        if folder not in ORDER or path.parent.parent != root / "src":
            findings.append(f"{name}: the folder is not in the order of {pathlib.Path(__file__).name}")
            continue
        if path.name in seen:
            findings.append(f"{name}: {seen[path.name]} has the same file name")
        seen[path.name] = name
        check_file(path, name, folder, findings)
    print("\n".join(findings) if findings else f"{count} files keep the layers and the rules of the library.")
    return 1 if findings or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
