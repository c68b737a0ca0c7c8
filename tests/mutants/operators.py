# SPDX-License-Identifier: MIT
"""Ways to break a line of C: each gives places in a source file and what to put there instead."""
import collections
import re

Mutant = collections.namedtuple("Mutant", "path line kind before after")

SWAPPED_TOKENS = {
    "relation": {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="},
    "opposite": {"<": ">=", ">=": "<", ">": "<=", "<=": ">"},
    "arithmetic": {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ",
                   "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="},
    "logic": {"&&": "||", "||": "&&", " & ": " | ", " | ": " & ", "<<": ">>", ">>": "<<", "~": ""},
    "step": {"++": "--", "--": "++"},
    "fused": {"plus": "minus", "minus": "plus", "dplus": "dminus", "dminus": "dplus"},
    "extreme": {"vmin": "vmax", "vmax": "vmin", "min32": "max32", "max32": "min32"},
}
TOKEN = re.compile(r"->|<<=|>>=|<<|>>|<=|>=|==|!=|&&|\|\||\+=|-=|\*=|/=|\+\+|--| [-+*/&|] |[<>~]|"
                   r"\bd?(?:plus|minus)\b|\bvmin\b|\bvmax\b|(?<=sphgi_)m(?:in|ax)32\b")
NUMBER = re.compile(r"(?<![\w.])(?:0x[\da-fA-F.]+p[-+]?\d+|\d+\.\d*(?:e[-+]?\d+)?|\d+)(?![\w.])")
CONDITION = re.compile(r"^(\s*(?:\} else )?(?:if|while) \()(.+)(\)(?: \{)?)$")
SELECTION = re.compile(r"( = |return )([^=?;{}]+?)( \? )")
STATEMENT = re.compile(r"^(\s*)((?:[\w\[\]().*>-]|->)+(?: [-+*/&|]?= .+|\(.*\)|(?:\+\+|--));)$")
RETURN = re.compile(r"^(\s*return )(.+)(;)$")


def blanked(text):
    """The text without comments, strings and preprocessor lines, each character at its place."""
    pattern = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^[ \t]*#(?:\\\n|[^\n])*',
                         re.S | re.M)
    return pattern.sub(lambda found: re.sub(r"[^\n]", "\0", found.group()), text)


def changed_number(text, step):
    if re.fullmatch(r"\d+", text):
        value = int(text) + step
        return str(value) if value >= 0 else "(%d)" % value
    return "(%s%+d)" % (text, step)


def mutants_of_line(line, code):
    """(kind, mutated line) for each way; code: the line as blanked."""
    for found in TOKEN.finditer(code):
        for kind, swaps in SWAPPED_TOKENS.items():
            if found.group() in swaps:
                yield kind, line[:found.start()] + swaps[found.group()] + line[found.end():]
    for found in NUMBER.finditer(code):
        for step in (1, -1):
            yield "constant", (line[:found.start()] + changed_number(found.group(), step) +
                               line[found.end():])
    if "\0" in code:
        return
    found = CONDITION.match(code)
    if found:
        yield "negation", "%s!(%s)%s" % found.groups()
    found = SELECTION.search(code)
    if found:
        yield "negation", "%s!(%s)%s" % (code[:found.end(1)], found.group(2), code[found.start(3):])
    found = RETURN.match(code)
    if found:
        yield "result", "%s!(%s)%s" % found.groups()
    found = STATEMENT.match(code)
    if found and not found.group(2).startswith("return"):
        yield "deletion", found.group(1) + ";"


def mutants_of(path, text):
    lines, codes = text.split("\n"), blanked(text).split("\n")
    for number, (line, code) in enumerate(zip(lines, codes), 1):
        for kind, after in mutants_of_line(line, code):
            yield Mutant(path, number, kind, line, after)
