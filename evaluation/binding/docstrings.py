#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes the docstrings of the Python package from the public headers: `///` above a declaration and `///<` behind it.

    docstrings.py OUT.cc HEADER...
"""
import re
import sys
from pathlib import Path

# Terms of C++ and their words in Python.
WORDS = [
    (r"@throws |[Tt]hrows (?=std::)", "Raises "),
    (r"std::invalid_argument", "ValueError"),
    (r"std::runtime_error", "RuntimeError"),
    (r"@param (\w+)", r"`\1`:"),
    (r"@pre ", "Before: "),
    (r"\bnullptr\b|\bnull\b", "None"),
    (r"\bk([A-Z][A-Za-z]+)\b", lambda m: re.sub(r"(?<!^)([A-Z])", r"_\1", m[1]).lower()),
]
SCOPE = re.compile(r"^\s*(?:template <.*> )?(?:class|struct|enum class)\s+(\w+)\b(?!.*;\s*$)")
NAME = re.compile(r"~?(\w+)\s*(?:\(|=|\{|;|,|\[|$)")


def told(text, functions):
    """A comment as Python says it: names of member functions as they are there."""
    for pattern, word in WORDS:
        text = re.sub(pattern, word, text)
    text = re.sub(r"\b[A-Z]\w+\b", lambda m: snake(m[0]) if m[0] in functions else m[0], text)
    return re.sub(r"^[a-z]{2,}\b", lambda m: m[0].capitalize(), text)


def snake(name):
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def declared(code):
    """The name that a line of code declares, or None."""
    code = re.sub(r"\b(operator\S+|noexcept|const|override|virtual|explicit|static|constexpr|inline)\b", "", code)
    code = re.sub(r"<[^<>]*(<[^<>]*>)?[^<>]*>", "", code)
    found = NAME.search(code)
    return found[1] if found else None


def entries(path):
    """(name, comment, whether it is a function) of every commented declaration of a header."""
    found, scopes, depth, comment = {}, [], 0, []
    last = None
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        above = re.match(r"\s*///(?!<) ?(.*)", line)
        if above:
            comment.append(above[1])
            continue
        goes_on = re.match(r"\s*///< ?(.*)", line)
        if goes_on and last:  # of the line before
            found[last][0].append(goes_on[1])
            continue
        if re.match(r"\s*//", line):
            continue
        code, _, behind = line.partition("///<")
        code = code.split(" // ")[0]
        opens = SCOPE.match(code)
        name = opens[1] if opens else declared(code) if code.strip() else None
        if behind:
            comment.append(behind)
        if name:
            last = "::".join([*(scope for scope, _ in scopes), name])
            if comment:
                lines, _ = found.setdefault(last, ([], bool(re.search(rf"\b{name}\(", code))))
                lines += ["\n\n", *comment] if lines else comment
            else:
                last = last if last in found else None
        if code.strip():
            comment = []
        if opens and "{" in code and "}" not in code:
            scopes.append((opens[1], depth))
        depth += code.count("{") - code.count("}")
        while scopes and depth <= scopes[-1][1]:
            scopes.pop()
    for name, (lines, function) in found.items():
        yield name, re.sub(r" *\n\n *", "\n\n", " ".join(line.strip(" ") for line in lines)), function


def main(out, headers):
    found = [entry for header in headers for entry in entries(header)]
    functions = {name.split("::")[-1] for name, _, function in found if function and "::" in name}
    functions -= {name.split("::")[0] for name, _, _ in found}
    texts = {}
    for name, comment, _ in found:
        said = texts.setdefault(name, [])
        text = told(comment, functions)
        if text not in said:
            said.append(text)
    rows = "".join(
        f'    {{"{name}", R"~({(chr(10) * 2).join(said)})~"}},\n' for name, said in sorted(texts.items())
    )
    Path(out).write_text(
        "// Made by docstrings.py.\n"
        '#include "evaluation/binding/docstrings.h"\n\n'
        "namespace touchdown::binding {\n\n"
        "const std::map<std::string_view, const char*>& Docstrings() {\n"
        "  static const std::map<std::string_view, const char*> texts = {\n"
        f"{rows}  }};\n  return texts;\n}}\n\n}}  // namespace touchdown::binding\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
