#!/usr/bin/env python3
"""Writes the reference part of FORMATS.md, the tables of keys, from scene.schema.json.

    make_formats.py           writes it
    make_formats.py --check   writes nothing; exit status 1 where it would differ
"""
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SCHEMA = json.load(open(os.path.join(HERE, "scene.schema.json"), encoding="utf-8"))
PAGE = os.path.join(HERE, "FORMATS.md")
BEGIN, END = "<!-- made by make_formats.py from scene.schema.json: begin -->\n", "<!-- end -->\n"


def number(value):
    """As people write it: 1e-18 and 1e18 are the ends of every number, which the page tells once."""
    return f"{value:,}" if isinstance(value, int) and value < 10**12 else f"{value}"


def link(schema):
    """A link to the table of an object's keys; None for what has no table."""
    name = schema.get("$ref", "").rpartition("/")[2]
    if "properties" not in SCHEMA["definitions"].get(name, {}):
        return None
    title = SCHEMA["definitions"][name]["title"]
    return f"[{title.lower()}](#{title.lower().replace(' ', '-')})"


def followed(schema):
    """A schema with what it refers to; its own words count."""
    name = schema.get("$ref", "").rpartition("/")[2]
    return {**SCHEMA["definitions"][name], **schema} if name else schema


def chosen(choice):
    """One of the values that a key may have: a word, or text that ends in something."""
    return f"`{choice['const']}`" if "const" in choice else f"name of a file `*{choice['pattern'].strip('$').replace(chr(92), '')}`"


def values(schema):
    """What a key may hold, in few words."""
    if link(schema):
        return link(schema)
    schema = followed(schema)
    if "title" in schema:
        return schema["title"]
    if "oneOf" in schema:
        return ", ".join(chosen(choice) for choice in schema["oneOf"])
    kind = schema["type"]
    if kind == "boolean":
        return "true, false"
    if kind == "string":
        return "text"
    if kind == "array":
        return f"list of {link(schema['items'])}"
    if kind == "object":
        return f"{link(schema['additionalProperties'])} by name"
    span = f"{number(schema['minimum'])} to {number(schema['maximum'])}"
    return f"whole number, {span}" if kind == "integer" else f"number, {span}"


def default(name, schema, required):
    if name in required:
        return "needed"
    return f"`{json.dumps(schema['default'])}`" if "default" in schema else ""


def meaning(schema):
    lines = [schema["description"]]
    lines += [f"{chosen(choice)}: {choice['description']}" for choice in followed(schema).get("oneOf", [])]
    return "<br>".join(lines)


def table(schema):
    lines = [f"### {schema['title']}", "", schema["description"], "", "| key | value | default | |", "|---|---|---|---|"]
    for name, key in schema["properties"].items():
        required = schema.get("required", [])
        cells = [f"`{name}`", values(key), default(name, key, required), meaning(key)]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    objects = [SCHEMA] + [each for each in SCHEMA["definitions"].values() if "properties" in each]
    reference = "\n".join(table(each) for each in objects)
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    made = before + BEGIN + reference + END + after
    if sys.argv[1:] == ["--check"]:
        if made != page:
            sys.exit("scenes/FORMATS.md isn't what scenes/scene.schema.json says: run scenes/make_formats.py")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(made)


main()
