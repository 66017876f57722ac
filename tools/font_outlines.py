#!/usr/bin/env python3
"""Write the outlines of the letters that a film needs, out of the font Inter.

    npm pack inter-ui && tar xzf inter-ui-*.tgz
    pip install fonttools brotli
    tools/font_outlines.py package/web assets/fonts

Reads Inter-Regular.woff2 and Inter-SemiBold.woff2 of the first folder, writes Inter-Regular.txt and Inter-SemiBold.txt
into the second: a line for each character. src/film/raster/outline.rs reads them and says what a line holds.
"""

import sys
from pathlib import Path

from fontTools.ttLib import TTFont

LATIN = [*range(0x20, 0x7F), *range(0xA0, 0x180)]
GREEK = [*range(0x391, 0x3AA), *range(0x3B1, 0x3CA)]
SCRIPTS = [0x2070, 0x2071, *range(0x2074, 0x2080), *range(0x2080, 0x208F)]
PUNCTUATION = [0x2009, 0x200A, 0x2010, 0x2011, 0x2013, 0x2014, 0x2018, 0x2019, 0x201C, 0x201D, 0x201E, 0x2022, 0x2026, 0x202F, 0x2032, 0x2033]
SIGNS = [0x20AC, 0x2190, 0x2191, 0x2192, 0x2193, 0x2194, 0x2202, 0x2206, 0x2211, 0x2212, 0x2215, 0x221A, 0x221E, 0x2248, 0x2260, 0x2264, 0x2265]


def contours(glyph) -> str:
    """Its contours, each from a point on the curve."""
    words, start = [], 0
    for end in glyph.endPtsOfContours:
        for place in range(start, end + 1):
            on_curve = glyph.flags[place] & 1
            if place == start and not on_curve:
                raise SystemExit("a contour begins beside its curve: the reader does not know this")
            sign = "/" if place == start else "" if on_curve else "~"
            x, y = glyph.coordinates[place]
            words.append(f"{sign}{x},{y}")
        start = end + 1
    return " ".join(words)


def outline(font: TTFont, name: str) -> str:
    """The parts of a letter: itself, or those that it is put together from."""
    glyphs = font["glyf"]
    glyph = glyphs[name]
    if glyph.numberOfContours and font["hmtx"][name][1] != glyph.xMin:
        raise SystemExit(f"{name} does not begin at its bearing: the reader does not know this")
    if not glyph.isComposite():
        return f"@0,0 {contours(glyph)}" if glyph.numberOfContours else ""
    parts = []
    for part in glyph.components:
        letter = glyphs[part.glyphName]
        if hasattr(part, "transform") or hasattr(part, "firstPt") or letter.isComposite():
            raise SystemExit(f"{name} is put together from more than shifted letters: the reader does not know this")
        parts.append(f"@{part.x},{part.y} {contours(letter)}")
    return " ".join(parts)


def write(source: Path, target: Path) -> None:
    font = TTFont(source)
    names = font.getBestCmap()
    wanted = [code for code in [*LATIN, *GREEK, *SCRIPTS, *PUNCTUATION, *SIGNS] if code in names]
    letters = [(0, ".notdef"), *((code, names[code]) for code in wanted)]
    lines = [f"{code:x} {font['hmtx'][name][0]} {outline(font, name)}".rstrip() for code, name in letters]
    target.write_text(f"{font['head'].unitsPerEm}\n" + "\n".join(lines) + "\n")
    print(f"{target.name}: {len(lines)} letters, {target.stat().st_size} bytes")


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    for name in ("Inter-Regular", "Inter-SemiBold"):
        write(Path(sys.argv[1]) / f"{name}.woff2", Path(sys.argv[2]) / f"{name}.txt")


if __name__ == "__main__":
    main()
