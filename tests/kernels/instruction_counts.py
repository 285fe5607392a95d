#!/usr/bin/env python3
"""Counts the x86 instructions that PoCL makes of shade.cl or, without shadows, shade_tiles.cl, for six sets of features.

    instruction_counts.py PROGRAM [BEFORE]     PROGRAM, BEFORE: builds of luciole

For each set a line: instructions of the loop over pairs of a row of pixels and a light, all that is inside it included, and of
the whole kernel. With BEFORE each count has the change from that program's beside it. Needs objdump (binutils).
"""
import os
import re
import subprocess
import sys
import tempfile

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scenes")
FEATURE_SETS = [  # name, scene, options
    ("points", "fireflies.json", ["--shadows", "off"]),
    ("points, pcf", "fireflies.json", ["--shadows", "pcf"]),
    ("spots, hard", "spheres.json", ["--shadows", "hard"]),
    ("cook-torrance", "spheres.json", ["--shadows", "off", "--model", "cook-torrance"]),
    ("ward", "spheres.json", ["--shadows", "off", "--model", "ward"]),
    ("blinn, soft", "city.json", ["--shadows", "soft", "--model", "blinn-phong"]),
    ("no lists", "cornell.json", ["--shadows", "off", "--culling", "none"]),
]
LANES = 16
KERNELS = ("shade.so", "shade_tiles.so")  # a set of features takes one of them


def compile_shade(program, scene, options):
    """The path of the kernel's machine code, and the folder that holds it."""
    folder = tempfile.TemporaryDirectory()
    environment = dict(os.environ, POCL_CACHE_DIR=folder.name)
    picture = os.path.join(folder.name, "a.png")
    subprocess.run([program, "render", os.path.join(SCENES, scene), "-o", picture, "--size", "64x36", "--quiet",
                    "--device", f",lanes={LANES}", *options], env=environment, check=True)
    for place, _, files in os.walk(folder.name):
        for kernel in KERNELS:
            if kernel in files:
                return os.path.join(place, kernel), folder
    raise SystemExit(f"neither of {', '.join(KERNELS)} in PoCL's cache: is the device PoCL's?")


def disassemble(path):
    """The work-group function as a list of (address, mnemonic, jump target or None)."""
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", path], check=True, capture_output=True, text=True).stdout
    functions, current = {}, None
    for line in text.splitlines():
        if start := re.match(r"[0-9a-f]+ <(.+)>:", line):
            current = functions.setdefault(start[1], [])
        elif current is not None and (code := re.match(r"\s+([0-9a-f]+):\s+(\S+)\s*(.*)", line)):
            target = re.match(r"([0-9a-f]+) <", code[3]) if code[2].startswith("j") else None
            current.append((int(code[1], 16), code[2], int(target[1], 16) if target else None))
    return max(functions.values(), key=len)


def blocks_of(code):
    """Basic blocks as {start: (instructions, successors)}."""
    starts = {code[0][0]}
    for i, (_, name, target) in enumerate(code):
        if name.startswith(("j", "ret")):
            if target:
                starts.add(target)
            if i + 1 < len(code):
                starts.add(code[i + 1][0])
    blocks, start, count = {}, code[0][0], 0
    for i, (address, name, target) in enumerate(code):
        count += 0 if name.startswith("nop") else 1
        following = code[i + 1][0] if i + 1 < len(code) else None
        if following is None or following in starts:
            successors = [target] if target else []
            if following and not name.startswith(("jmp", "ret")):
                successors.append(following)
            blocks[start] = (count, successors)
            start, count = following, 0
    return {start: (count, [s for s in successors if s in blocks]) for start, (count, successors) in blocks.items()}


def dominators(blocks, entry):
    order, seen, stack = [], {entry}, [(entry, iter(blocks[entry][1]))]
    while stack:  # post order
        block, successors = stack[-1]
        for s in successors:
            if s not in seen:
                seen.add(s)
                stack.append((s, iter(blocks[s][1])))
                break
        else:
            order.append(block)
            stack.pop()
    order.reverse()
    predecessors = {b: [p for p in order if b in blocks[p][1]] for b in order}
    dominated_by = {b: set(order) for b in order}
    dominated_by[entry] = {entry}
    changed = True
    while changed:
        changed = False
        for b in order[1:]:
            new = set.intersection(*(dominated_by[p] for p in predecessors[b])) | {b}
            changed |= new != dominated_by[b]
            dominated_by[b] = new
    return dominated_by, predecessors


def loops_of(blocks, entry):
    """Natural loops as {header: set of blocks}."""
    dominated_by, predecessors = dominators(blocks, entry)
    loops = {}
    for block in dominated_by:
        for header in blocks[block][1]:
            if header in dominated_by[block]:
                body = loops.setdefault(header, {header})
                todo = [block]
                while todo:
                    b = todo.pop()
                    if b not in body:
                        body.add(b)
                        todo += predecessors[b]
    return loops


def count(path):
    """Instructions of the loop over pairs, and of the kernel."""
    blocks = blocks_of(disassemble(path))
    size = {b: n for b, (n, _) in blocks.items()}
    loops = sorted(loops_of(blocks, min(blocks)).values(), key=lambda body: -sum(size[b] for b in body))
    # Around it are the loops over work-items and over fillings of the queue: of the nested chain of the largest loops the last
    # that still has nearly all of the kernel's arithmetic.
    hot = loops[0]
    for body in loops[1:]:
        if body < hot and sum(size[b] for b in body) > 0.5 * sum(size[b] for b in hot):
            hot = body
    return sum(size[b] for b in hot), sum(size.values())


def main():
    if len(sys.argv) not in (2, 3):
        raise SystemExit(__doc__)
    print(f"{'features':16}{'pair loop':>20}{'kernel':>20}")
    for name, scene, options in FEATURE_SETS:
        counts = []
        for program in sys.argv[1:]:
            path, folder = compile_shade(program, scene, options)
            counts.append(count(path))
            folder.cleanup()
        columns = [str(n) for n in counts[0]]
        if len(counts) == 2:
            columns = [f"{n} ({100 * (n / old - 1):+.1f} %)" for n, old in zip(*counts)]
        print(f"{name:16}" + "".join(f"{column:>20}" for column in columns))


main()
