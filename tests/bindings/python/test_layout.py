# SPDX-License-Identifier: MIT
"""test_layout.py LAYOUT HEADER: structs, enumerations and functions of the package are those that a C
compiler saw (LAYOUT) and that the header declares; whatever Python leaves out has its reason."""
import ctypes as c
import os
import re
import sys
from support import Case, main
from sphgrad import _c

layout_file, header_file = sys.argv[1:3]
del sys.argv[1:3]
with open(layout_file) as lines:
    LAYOUT = [line.split() for line in lines]
with open(header_file) as header:
    HEADER = re.sub(r"/\*.*?\*/", " ", header.read(), flags=re.S)


def rows(kind):
    return [row[1:] for row in LAYOUT if row[0] == kind]


def declarations():
    """name: (type of the result, types of the parameters), as the header spells them."""
    found = {}
    for result, name, parameters in re.findall(r"^SPHG_API ([^;(]*?)(sphg_\w+)\(([^;]*)\);", HEADER,
                                               re.M):
        types = [] if parameters.strip() == "void" else [
            re.sub(r"(\*|\s)\s*\w+$", r"\1", p.strip()).strip() for p in parameters.split(",")]
        found[name] = (result.strip(), [" ".join(t.split()) for t in types])
    return found


def in_ctypes(spelled):
    """What ctypes calls a type of the header."""
    spelled = spelled.replace("const ", "").strip()
    plain = {"void": None, "int32_t": c.c_int32, "double": c.c_double, "sphg_view": _c.View,
             "char *": c.c_char_p, "double *": c.POINTER(c.c_double), "int32_t *": c.c_void_p,
             "sphg_context *": c.c_void_p, "sphg_neighbors *": c.c_void_p,
             "sphg_context **": c.POINTER(c.c_void_p), "sphg_neighbors **": c.POINTER(c.c_void_p)}
    if spelled in plain:
        return plain[spelled]
    if spelled in _c.ENUMS:
        return c.c_int
    return c.POINTER(_c.STRUCTS[spelled.rstrip("* ")])


class Layout(Case):
    def test_structs_have_the_sizes_of_c(self):
        self.assertEqual({name: int(size) for name, size in rows("struct")},
                         {name: c.sizeof(s) for name, s in _c.STRUCTS.items()})

    def test_members_have_the_places_of_c(self):
        expected = {(s, m): (int(o), int(z)) for s, m, o, z in rows("member")}
        found = {}
        for name, structure in _c.STRUCTS.items():
            for member in structure._fields_:
                field = getattr(structure, member[0])
                found[name, member[0]] = (field.offset, field.size)
        self.assertGreater(len(found), 80)
        self.assertEqual(expected, found)

    def test_enumerators_have_the_values_of_c(self):
        expected = {(kind, name[5:]): int(value) for kind, name, value in rows("enum")}
        found = {(name, key): int(value) for name, enumeration in _c.ENUMS.items()
                 for key, value in enumeration.__members__.items()}
        self.assertGreater(len(found), 40)
        self.assertEqual(expected, found)

    def test_functions_have_the_parameters_of_c(self):
        declared = declarations()
        self.assertEqual(set(declared), {row[0] for row in rows("function")})
        self.assertEqual(set(declared), set(_c.FUNCTIONS))
        for name, (result, parameters) in declared.items():
            with self.subTest(name):
                self.assertEqual(_c.FUNCTIONS[name][0], in_ctypes(result))
                self.assertEqual(_c.FUNCTIONS[name][1], [in_ctypes(p) for p in parameters])

    def test_version_is_that_of_c(self):
        self.assertEqual(int(rows("version")[0][0]),
                         _c.VERSION[0] * 10000 + _c.VERSION[1] * 100 + _c.VERSION[2])

    def test_what_is_left_out_has_a_reason_and_no_more_is(self):
        folder, text = os.path.dirname(_c.__file__), ""
        for name in sorted(os.listdir(folder)):
            if name.endswith(".py") and name != "_c.py":
                with open(os.path.join(folder, name)) as source:
                    text += source.read()
        called = {name for name in _c.FUNCTIONS
                  if re.search(rf"functions\.{name}\b", text) or name == "sphg_version"}
        self.assertEqual(called | set(_c.NOT_CALLED), set(_c.FUNCTIONS))
        self.assertEqual(called & set(_c.NOT_CALLED), set())
        members = {f"{s}.{m}" for s, m, _, _ in rows("member")}
        self.assertLessEqual(set(_c.NOT_SET), members)
        in_order = {"sphg_view", "sphg_subset", "sphg_scheme", "sphg_sources", "sphg_inversion"}
        for name in sorted(members - set(_c.NOT_SET)):
            structure, member = name.split(".")
            word = _c.STRUCTS[structure].__name__ + r"\(" if structure in in_order else member + r"\b"
            self.assertTrue(re.search(r"\b" + word, text), name)
        for reason in list(_c.NOT_CALLED.values()) + list(_c.NOT_SET.values()):
            self.assertGreater(len(reason), 5)


main()
