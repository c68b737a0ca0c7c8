#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""filter.py FILE: what Doxygen reads instead of FILE. Of the header, whose comments are written for readers of text,
comments that Doxygen attributes to what they describe; of a page, links to other pages and to declarations. With
--examples it makes the pages of the examples from the comments that they begin with."""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
INCLUDE = os.path.join(ROOT, "include", "sphgrad")
HEADER = os.path.join(INCLUDE, "sphgrad.h")
HEADERS = [HEADER, os.path.join(INCLUDE, "small_matrices.h")]


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


# What the header leaves to the name, in words.
NAMED = {
    "SPHG_VERSION_MAJOR": "Major version", "SPHG_VERSION_MINOR": "Minor version", "SPHG_VERSION_PATCH": "Patch level",
    "SPHG_VERSION": "The version of this header as one number, for sphg_context_create()",
    "sphg_type": "Types of numbers.", "sphg_isa": "Instruction sets.", "sphg_kernel": "Smoothing functions.",
    "sphg_fault": "What may be wrong with a list.", "sphg_context": "Who works, and with whose memory.",
    "sphg_config": "Threads, instruction set, memory and log of a context.",
    "sphg_context_info": "What a context is.", "sphg_scheme": "Which derivative is computed.",
    "sphg_geometry": "Positions of sources and targets.", "sphg_neighbors_info": "What neighbours hold.",
    "sphg_request": "What sphg_evaluate() computes.",
    "sphg_view_f32": "Floats, `stride` bytes apart.", "sphg_view_f64": "Doubles, `stride` bytes apart.",
    "sphg_view_u8": "Bytes, `stride` bytes apart.",
    "sphg_xyz_f32": "Floats in separate arrays of components.",
    "sphg_xyz_f64": "Doubles in separate arrays of components.",
    "sphg_same_f32": "One item of floats for all.", "sphg_same_f64": "One item of doubles for all.",
    "sphg_absent": "No view.", "sphg_all": "All particles are sources and targets.",
    "sphg_targets_apart": "Targets that are not sources.",
    "sphg_targets_of": "The targets of an object that was searched before.",
    "sphg_own_and_ghosts": "The first `own` particles are targets; sources are these and the ghosts behind them.",
    "sphg_range": "The targets [begin, end).", "sphg_masked": "The targets whose byte is not 0.",
    "sphg_listed": "The listed targets; with count = 0 nobody.",
}
MEMBERS = {
    "target_count": "Number of targets.", "source_count": "Number of sources.", "fields": "`field_count` items.",
    "neighbors": "Who sums over whom.", "release": "Gives back what `allocate` gave.", "stats": "See sphg_stats.",
}


# ---- The header ---------------------------------------------------------------------------------

def escaped(text):
    return re.sub(r"([<>#@%&\\])", r"\\\1", text).replace("Eq. ", "Eq.\\ ")  # no end of a sentence


def text_of(comment):
    """The lines of a comment, without its borders; indented ones keep two spaces for each level."""
    body = comment.strip()[2:-2]
    return [re.sub(r"^\s*\* ?", "", line).rstrip() if number else line.strip()
            for number, line in enumerate(body.split("\n"))]


def linked_errors(sentence):
    return re.sub(r"\b([A-Z_]{4,})\b",
                  lambda found: f'\\ref SPHG_ERROR_{found.group(1)} "{found.group(1)}"'
                  if f"X(ERROR_{found.group(1)}," in read(HEADER) else found.group(1), sentence)


def described(lines):
    """Lines of a comment in Doxygen's words: items, "Errors" and "Cost" as paragraphs of their own."""
    out = []
    for line in lines:
        item = re.match(r"^ {2,}(\S+) {2,}(\S.*)$", line)
        label = re.match(r"^([A-Z]\w+) {2,}(\S.*)$", line)
        if item:
            out.append(f"- **{escaped(item.group(1))}** {escaped(item.group(2))}")
        elif label:
            out += ["", f"\\par {label.group(1)}", escaped(label.group(2))]
        elif line.startswith("  ") and out and out[-1].startswith("- "):
            out[-1] += " " + escaped(line.strip())
        else:
            out.append(escaped(line.strip()))
    text = "\n".join(out)
    text = re.sub(r"\s*\b(Errors(?: \([^)]*\))?|Cost|MPI): ", r"\n\n\\par \1\n", text)
    return re.sub(r"(\\par Errors[^\n]*\n)(.*?)(?=\n\n|\Z)", lambda m: m.group(1) + linked_errors(m.group(2)), text, flags=re.S)


def documented(lines, mark="/**"):
    return f"{mark} {described(lines)} */"


def results(text):
    """The list of results, a macro for the library's own use, as the enumeration that it becomes."""
    rows = re.findall(r'X\((\w+), (-?\d+), "([^"]*)"\)', text)
    members = "\n".join(f"    SPHG_{name} = {value}, /**< {escaped(words)} */" for name, value, words in rows)
    start, end = text.index("#define SPHG_RESULT_LIST"), text.index("#undef SPHG_X\n") + len("#undef SPHG_X\n")
    return text[:start] + f"typedef enum sphg_result {{\n{members}\n}} sphg_result;\n" + text[end:]


def split_declarators(text):
    """`int a, b; /* ... */` as two declarations with the same comment."""
    def split(found):
        indent, kind, names, comment = found.groups()
        comment = comment or ""
        return "\n".join(f"{indent}{kind} {name.strip()};{comment}" for name in names.split(","))
    return re.sub(r"^( {4})((?:const )?\w+) ((?:\*?\w+, )+\*?\w+);( +/\*(?:[^*]|\*(?!/))*\*/)?$", split, text, flags=re.M)


def header(text):
    text = split_declarators(results(text) if "#define SPHG_RESULT_LIST" in text else text)
    pieces = re.split(r"(/\*(?:[^*]|\*(?!/))*\*/)", text)
    out, depth, group, section = [], -1, False, None  # in extern "C" {
    for number, piece in enumerate(pieces):
        if number % 2 == 0:
            if group and ("\n\n" in piece or "}" in piece):  # members under one heading end here
                at = min(k for k in (piece.find("\n\n"), piece.find("\n}")) if k >= 0)
                piece = piece[:at] + "\n    /** @} */" + piece[at:]
                group = False
            depth += piece.count("{") - piece.count("}")
            out.append(piece)
            continue
        before = "".join(out)
        line = before[before.rfind("\n") + 1:]
        title = re.match(r"/\* ---- (.+?) -{3,}", piece)
        if number == 1:
            lines = text_of(piece)
            out.append("/** \\file\n\\brief " + described(lines) + " */")
        elif title:
            name = re.sub(r"\W+", "_", title.group(1).split(",")[0].split(":")[0].strip().lower())
            rest = [part for part in text_of(piece)[1:] if part]
            out.append(("/** @} */\n" if section else "") + f"/** \\defgroup {name} {title.group(1)}\n" +
                       described(rest) + "\n@{ */")
            section = name
        elif depth <= 1 and not line.strip():  # on a line of its own
            if before.endswith("\n\n    ") and "struct" in before[before.rfind("\n\n", 0, -6):]:
                words = " ".join(text_of(piece))
                out.append(f"/** @name {escaped(words)}\n@{{ */")
                group = True
            else:
                out.append(documented(text_of(piece)))
        elif line.startswith("#"):
            out.append(piece)
        elif line.strip().endswith(("{", ")")):
            out.append(piece)
        else:
            out.append(documented(text_of(piece), "/**<"))
    text = "".join(out) + ("\n/** @} */\n" if section else "")
    for name, words in NAMED.items():
        for found in re.finditer(rf"^(typedef (struct|enum) {name} |static inline \w+ {name}\(|#define {name} )", text, re.M):
            before = text[:found.start()].rstrip()
            last = before[before.rfind("/*"):]
            if not (before.endswith("*/") and last.startswith("/** ") and "@{" not in last):
                text = text[:found.start()] + f"/** {words} */\n" + text[found.start():]
            break
    text = re.sub(r"^( {4}void \(\*release\)\([^;]*;)$", rf"\1 /**< {MEMBERS['release']} */", text, flags=re.M)
    return follow(re.sub(r"^    ((?:const )?\w+) (\*?)(\w+);$", member, text, flags=re.M))


def member(found):
    """A member that has no comment: what its type says, or its name."""
    kind, name = found.group(1), found.group(3)
    words = MEMBERS.get(name, f"See {kind}." if kind.startswith("sphg_") else "")
    return found.group(0) + (f" /**< {words} */" if words else "")


def follow(text):
    """Declarations that stand directly behind a documented one share its comment."""
    pattern = re.compile(r"(SPHG_API [^;]*;(?:[ ]*/\*\*<[^/]*\*/)?\n)(?=SPHG_API [^;]*;\n)")
    while True:
        for found in pattern.finditer(text):
            first = re.search(r"(\w+)\(", found.group(1)).group(1)
            if "/**<" not in found.group(1):
                text = text[:found.end()] + f"/** \\copydoc {first} */\n" + text[found.end():]
                break
        else:
            return text


# ---- Pages --------------------------------------------------------------------------------------

def slug(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def label(path, anchor=""):
    name = os.path.relpath(path, ROOT)
    page = "page_" + re.sub(r"\W", "_", name[:-3].lower())
    return page + ("-" + anchor if anchor else "")


def example_page(name):
    return name.replace("/", "_2").replace(".", "_8") + "-example.html"


def link(page, words, target):
    path, _, anchor = target.partition("#")
    file = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
    inside = os.path.relpath(file, ROOT)
    if inside == "docs/README.md":
        return f"[{words}](pages.html)"
    if inside.endswith(".md") and not inside.startswith("tests"):
        return f"[{words}](@ref {label(file, anchor)})"
    if file in HEADERS:
        return f'[{words}](@ref {os.path.basename(file)})'
    if inside.startswith("examples/") and inside.count("/") <= 2 and not inside.startswith("examples/scenes"):
        return f"[{words}]({example_page(inside[len('examples/'):])})"
    return words  # not in the manual


def names():
    whole = "".join(read(path) for path in HEADERS)
    described = set(re.findall(r"\b(SPHG_[A-Z0-9_]+) = \d+,? +/\*", whole))
    text = re.sub(r"/\*.*?\*/", "", whole, flags=re.S)
    structs = dict(re.findall(r"typedef struct (\w+) \{(.*?)\n\} \1;", text, re.S))
    functions = set(re.findall(r"\b(sphg_\w+)\(", text))
    enumerators = described | {"SPHG_" + name for name in re.findall(r"X\((\w+), -?\d", text)}
    enums = set(re.findall(r"typedef enum (\w+) ", text))
    return structs, functions | enumerators | enums | set(structs)


def page(path, text):
    structs, known = names()

    def code(found):
        word = found.group(1)
        plain = word.rstrip("()")
        struct, _, member = plain.partition(".")
        if plain in known:
            return f'[{word}](@ref {plain})'
        if struct in structs and member and re.search(rf"\b{member}\b", structs[struct]):
            return f'[{word}](@ref {struct}::{member})'
        return f"<tt>{word.replace('&', '&amp;').replace('<', '&lt;').replace('>', '&gt;')}</tt>" \
            if re.search(r"[@\\#%]|::", word) and not re.search(r"\\", word) else found.group(0)

    out, fenced, seen = [], False, set()
    for number, line in enumerate(text.split("\n")):
        if line.startswith("```"):
            fenced = not fenced
            out.append("```" if not fenced else {"```c": "```{.c}", "```cpp": "```{.cpp}", "```python": "```{.py}",
                                                 "```fortran": "```{.f90}"}.get(line.strip(), "```{.unparsed}"))
            continue
        if fenced or line.startswith("    "):
            out.append(line)
            continue
        heading = re.match(r"^(#+) (.*)$", line)
        line = re.sub(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)",
                      lambda m: m.group(0) if re.match("https?:", m.group(2)) else link(path, m.group(1), m.group(2)), line)
        line = re.sub(r"!\[([^\]]*)\]\(([^)]*/)?([\w.]+)\)", r"![\1](\3)", line)
        line = re.sub(r"(?<!\[)`([^`]+)`", code, line)
        if heading:
            anchor = slug(heading.group(2))
            if heading.group(1) == "#":
                line += f" {{#{label(path)}}}"
            elif anchor not in seen:
                seen.add(anchor)
                line += f" {{#{label(path, anchor)}}}"
        out.append(line)
    return "\n".join(out)


def examples():
    """A page for each example, found by Doxygen's search, with links from the functions that it calls."""
    folder = os.path.join(ROOT, "examples")
    for below in ("", "cpp", "fortran", "python", "distributed"):
        for name in sorted(os.listdir(os.path.join(folder, below))):
            inside = os.path.join(below, name) if below else name
            if not name.endswith((".c", ".cpp", ".f90", ".py", ".h")):
                continue
            text = read(os.path.join(folder, inside))
            text = re.sub(r"^.*SPDX-License-Identifier: .*\n", "", text, count=1, flags=re.M)
            comment = re.match(r"/\*(.*?)\*/", text, re.S)
            if not comment and below == "distributed":
                continue  # its header has the words
            first = " ".join(text_of(comment.group(0))) if comment else re.match(r'(?:#!.*\n)?(?:! |""")(.*)', text).group(1)
            print(f"/** \\example {inside}\n{escaped(first.rstrip(chr(34)))} */")


if sys.argv[1] == "--examples":
    examples()
else:
    given = os.path.abspath(sys.argv[1])
    contents = read(given)
    print(header(contents) if given in HEADERS else page(given, contents) if given.endswith(".md") else contents, end="")
