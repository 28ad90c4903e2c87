# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are nearly right, made of right ones by chance."""

WORDS = [b"nan", b"1e300", b"-1", b"0", b"99999999999", b"1e-300", b"{}", b"[]", b"~", b"&a", b"*a", b"? ", b"\n- ", b": ", b"'", b'"',
         b"#", b"|", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"%", b"<<: ", b"!!int ", b"---\n", b"true", b".", "²".encode()]


def place(draw, data):
    return draw.randrange(len(data) + 1)


def span(draw, data, most=40):
    """Bounds of a piece of the data; whole lines and words more often than not."""
    a = place(draw, data)
    b = min(len(data), a + draw.randrange(1, most))
    if draw.random() < 0.4:
        return data.rfind(b"\n", 0, a) + 1, (data.find(b"\n", a) + 1) or len(data)
    return a, b


def mutant(draw, data, others):
    """`data` with one to six changes; pieces come from `others` too."""
    for _ in range(draw.randint(1, 6)):
        a, b = span(draw, data)
        kind = draw.randrange(7)
        if kind == 0:
            data = data[:a] + data[b:]
        elif kind == 1:
            data = data[:a] + draw.choice(WORDS) + data[a:]
        elif kind == 2:
            data = data[:a] + draw.choice(WORDS) + data[b:]
        elif kind == 3 and data:
            at = draw.randrange(len(data))
            data = data[:at] + bytes([data[at] ^ 1 << draw.randrange(8)]) + data[at + 1:]
        elif kind == 4:
            data = data[:a] + data[a:b] * draw.randint(2, 4) + data[b:]
        elif kind == 5:
            other = draw.choice(others)
            c, d = span(draw, other, 200)
            data = data[:a] + other[c:d] + data[b if draw.random() < 0.5 else a:]
        else:
            data = data[:a] if draw.random() < 0.2 else data[:a] + data[a:b].swapcase() + data[b:]
    return data
