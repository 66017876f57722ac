#!/usr/bin/env python3
"""Cut Inter down to the letters a film needs.

    npm pack inter-ui && tar xzf inter-ui-*.tgz
    pip install fonttools brotli
    tools/subset_fonts.py package/web assets/fonts

Reads Inter-Regular.woff2 and Inter-SemiBold.woff2 of the first folder, writes plain TrueType files of the same
names into the second. Layout tables go too: labels are set glyph by glyph, without shaping.
"""

import sys
from pathlib import Path

from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTFont

LATIN = [*range(0x20, 0x7F), *range(0xA0, 0x180)]
GREEK = [*range(0x391, 0x3AA), *range(0x3B1, 0x3CA)]
SCRIPTS = [0x2070, 0x2071, *range(0x2074, 0x2080), *range(0x2080, 0x208F)]
PUNCTUATION = [0x2009, 0x200A, 0x2010, 0x2011, 0x2013, 0x2014, 0x2018, 0x2019, 0x201C, 0x201D, 0x201E, 0x2022, 0x2026, 0x202F, 0x2032, 0x2033]
SIGNS = [0x20AC, 0x2190, 0x2191, 0x2192, 0x2193, 0x2194, 0x2202, 0x2206, 0x2211, 0x2212, 0x2215, 0x221A, 0x221E, 0x2248, 0x2260, 0x2264, 0x2265]


def subset(source: Path, target: Path) -> None:
    font = TTFont(source)
    options = Options()
    options.layout_features = []
    options.hinting = False
    options.notdef_outline = True
    options.name_IDs = [0, 1, 2, 4, 6, 13, 14]
    options.drop_tables += ["GSUB", "GPOS", "GDEF", "STAT", "DSIG", "meta"]
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=[*LATIN, *GREEK, *SCRIPTS, *PUNCTUATION, *SIGNS])
    subsetter.subset(font)
    font.flavor = None
    # Without this the file would carry the time of the run and never be the same twice.
    font.recalcTimestamp = False
    font.save(target)
    print(f"{target.name}: {len(font.getBestCmap())} characters, {target.stat().st_size} bytes")


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    for name in ("Inter-Regular", "Inter-SemiBold"):
        subset(Path(sys.argv[1]) / f"{name}.woff2", Path(sys.argv[2]) / f"{name}.ttf")


if __name__ == "__main__":
    main()
