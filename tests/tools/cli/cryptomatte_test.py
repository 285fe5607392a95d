#!/usr/bin/env python3
"""Reads the Cryptomattes of an EXR by the published specification alone: Cryptomatte 1.2 (Psyop, "Cryptomatte
Specification", https://github.com/Psyop/Cryptomatte), MurmurHash3_x86_32 (A. Appleby) and the OpenEXR file layout.

    cryptomatte_test.py FILE.exr

FILE is not compressed. Prints as JSON what it found, by typename:
{"CryptoObject": {"manifest": {name: hex}, "pixels": [[[name, coverage], ...] of each pixel, row by row]}, ...}
Exit status 1 and a line on standard error where the file breaks a rule.
"""
import json
import struct
import sys


def murmur3_32(data, seed=0):
    def rotated(x, by):
        return (x << by | x >> (32 - by)) & 0xFFFFFFFF

    def scrambled(k):
        return rotated(k * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF

    value = seed
    whole = len(data) // 4 * 4
    for (k,) in struct.iter_unpack("<I", data[:whole]):
        value = (rotated(value ^ scrambled(k), 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    value ^= scrambled(int.from_bytes(data[whole:], "little"))
    value ^= len(data)
    value = (value ^ value >> 16) * 0x85EBCA6B & 0xFFFFFFFF
    value = (value ^ value >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    return value ^ value >> 16


def float_bits(name):
    """uint32_to_float32: an exponent of all zeros or all ones loses its lowest bit's sense, so that bit is flipped."""
    value = murmur3_32(name.encode("utf-8"))
    exponent = value >> 23 & 255
    return value ^ 1 << 23 if exponent in (0, 255) else value


def float_of(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def check(is_right, what):
    if not is_right:
        sys.exit(what)


def check_known_values():
    # Hashes that MurmurHash3's own verification and the tests of Cryptomatte's plug-in for Nuke have.
    for text, value in (("", 0), ("hello", 0x248BFA47), ("hello, world", 0x149BBB7F), ("The quick brown fox jumps over the lazy dog", 0x2E4FF723)):
        check(murmur3_32(text.encode()) == value, f"murmur3_32 of {text!r}")
    for text, value in (("hello", 6.0705627102400005616e-17), ("cube", -4.08461912519e15), ("sphere", 2.79018604383e15), ("plane", 3.66557617593e-11)):
        check(abs(float_of(float_bits(text)) / value - 1) < 1e-11, f"float of {text!r}")


def read_text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8"), end + 1


def read_exr(path):
    """Texts of the header, size, and {channel: values row by row} of the float channels."""
    data = open(path, "rb").read()
    check(data[:4] == b"\x76\x2f\x31\x01", "not an EXR")
    at, texts, raw = 8, {}, {}
    while data[at]:
        name, at = read_text(data, at)
        kind, at = read_text(data, at)
        (length,) = struct.unpack_from("<I", data, at)
        raw[name] = data[at + 4 : at + 4 + length]
        if kind == "string":
            texts[name] = raw[name].decode("utf-8")
        at += 4 + length
    check(raw["compression"] == b"\0", "compressed")
    x0, y0, x1, y1 = struct.unpack("<4i", raw["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels, within = [], 0
    while raw["channels"][within]:
        name, within = read_text(raw["channels"], within)
        (kind,) = struct.unpack_from("<i", raw["channels"], within)
        check(kind == 2 or kind == 1 and not name.startswith("Crypto"), f"{name}: not 32-bit float")
        channels.append((name, "f" if kind == 2 else "e"))
        within += 16
    planes = {name: [] for name, _ in channels}
    for offset in struct.unpack_from(f"<{height}Q", data, at + 1):
        offset += 8
        for name, kind in channels:
            planes[name] += struct.unpack_from(f"<{width}{kind}", data, offset)
            offset += width * struct.calcsize(kind)
    return texts, width * height, planes


def read_matte(texts, prefix, pixels, planes):
    typename = texts[prefix + "name"]
    check(prefix == f"cryptomatte/{murmur3_32(typename.encode()):08x}"[:19] + "/", f"{prefix}: not the first 7 digits of {typename}'s hash")
    check(texts[prefix + "hash"] == "MurmurHash3_32", "hash")
    check(texts[prefix + "conversion"] == "uint32_to_float32", "conversion")
    manifest = json.loads(texts[prefix + "manifest"])
    names = {}
    for name, digits in manifest.items():
        check(digits == f"{float_bits(name):08x}", f"{name}: {digits} in the manifest")
        names[float_bits(name)] = name
    levels = 0
    while f"{typename}{levels:02}.R" in planes:
        levels += 1
    check(levels >= 3, f"{typename}: {levels} levels, of 2 ranks each")
    found = []
    for i in range(pixels):
        ranks = []
        for level in range(levels):
            for of_id, of_coverage in ("RG", "BA"):
                value = planes[f"{typename}{level:02}.{of_id}"][i]
                coverage = planes[f"{typename}{level:02}.{of_coverage}"][i]
                check((coverage == 0) == (value == 0), f"pixel {i}: id {value} covers {coverage}")
                if coverage == 0:
                    continue
                bits = struct.unpack("<I", struct.pack("<f", value))[0]
                check(bits in names, f"pixel {i}: {bits:08x} isn't in the manifest")
                ranks.append([names[bits], coverage])
        check(all(a[1] >= b[1] for a, b in zip(ranks, ranks[1:])), f"pixel {i}: not sorted by coverage: {ranks}")
        check(sum(rank[1] for rank in ranks) <= 1 + 1e-6, f"pixel {i}: covered more than once: {ranks}")
        check(len({rank[0] for rank in ranks}) == len(ranks), f"pixel {i}: one name in two ranks: {ranks}")
        found.append(ranks)
    return {"manifest": manifest, "pixels": found}


def main():
    check_known_values()
    texts, pixels, planes = read_exr(sys.argv[1])
    prefixes = {key[: key.rindex("/") + 1] for key in texts if key.startswith("cryptomatte/")}
    mattes = [read_matte(texts, prefix, pixels, planes) for prefix in sorted(prefixes)]
    print(json.dumps({texts[prefix + "name"]: matte for prefix, matte in zip(sorted(prefixes), mattes)}))


main()
