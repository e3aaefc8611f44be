# SPDX-License-Identifier: Apache-2.0
"""decode_png.py PICTURE.png RAW: checks an 8-bit RGB PNG by the specification alone, writes its pixels, prints its size.

Of one that moves (APNG) the pixels of all pictures, and behind the size how long each is seen, in ms.
"""

import struct
import sys
import zlib


def chunks(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at = 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        (checksum,) = struct.unpack(">I", data[at + 8 + size : at + 12 + size])
        assert checksum == zlib.crc32(kind + body)
        yield kind, body
        at += 12 + size


def paeth(a, b, c):
    return min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]


def unfilter(data, width, height):
    stride = 3 * width
    above, pixels = bytearray(stride), bytearray()
    for y in range(height):
        kind, row = data[y * (stride + 1)], bytearray(data[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            a, b, c = (row[x - 3] if x > 2 else 0), above[x], (above[x - 3] if x > 2 else 0)
            row[x] = (row[x] + (0, a, b, (a + b) // 2, paeth(a, b, c))[kind]) & 255
        pixels += row
        above = row
    return pixels


parts = list(chunks(open(sys.argv[1], "rb").read()))
assert parts[0][0] == b"IHDR" and parts[-1] == (b"IEND", b"")
width, height, depth, colour, *methods = struct.unpack(">IIBBBBB", parts[0][1])
assert (depth, colour, methods) == (8, 2, [0, 0, 0])


def pictures(parts):
    """(size and place, ms, compressed pixels) of each picture of an animation; the first is that which others show."""
    found, number = [], 0
    for kind, body in parts:
        if kind in (b"fcTL", b"fdAT"):
            assert int.from_bytes(body[:4], "big") == number
            number += 1
        if kind == b"fcTL":
            *place, ms, unit, dispose, blend = struct.unpack(">IIIIHHBB", body[4:])
            assert (unit, dispose, blend) == (1000, 0, 0)
            found.append([place, ms, b""])
        if kind == b"IDAT" or kind == b"fdAT":
            found[-1][2] += body if kind == b"IDAT" else body[4:]
    assert [body for kind, body in parts if kind == b"acTL"] == [struct.pack(">II", len(found), 0)]
    assert found[0][0] == [width, height, 0, 0]
    return found


def decoded(data, width, height):
    data = zlib.decompress(data)
    assert len(data) == height * (3 * width + 1)
    return unfilter(data, width, height)


output = open(sys.argv[2], "wb")
if b"acTL" not in dict(parts):
    output.write(decoded(b"".join(body for kind, body in parts if kind == b"IDAT"), width, height))
    print(width, height)
else:
    shown, times = bytearray(3 * width * height), []
    for (w, h, left, top), ms, data in pictures(parts):
        region = decoded(data, w, h)
        for y in range(h):
            at = 3 * ((top + y) * width + left)
            shown[at : at + 3 * w] = region[3 * w * y : 3 * w * (y + 1)]
        output.write(shown)
        times.append(ms)
    print(width, height, *times)
