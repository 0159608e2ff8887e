"""Writes lens files of ours in the forms of other programs: Zemax, pbrt."""

import math
import pathlib

import lens as reader

HERE = pathlib.Path(__file__).resolve().parent


def zemax(lens, unit="MM", extra=()):
    """The text of a sequential .zmx file: model glasses by index and Abbe number."""
    data = lens.data["surface"]
    out = [
        "VERS 140124 258 36214", "MODE SEQ", f"NAME {lens.data['name']}",
        f"NOTE 0 Written by vglare's tests from {lens.path.name}",
        f"NOTE 0 {lens.data['patent']}",
        f"UNIT {unit} X W X CM MR CPMM",
        f"ENPD {lens.pupil()[1]:.10g}", "ENVD 2.0E+1 1 0", "GFAC 0 0", "GCAT SCHOTT",
        "RAIM 0 0 1 1 0 0 0 0 0", "FTYP 0 0 3 3 0 0 0",
        "XFLN 0 0 0", f"YFLN 0 {lens.data['field'] * 0.7:.10g} {lens.data['field']:.10g}",
        "FWGN 1 1 1",
        "WAVM 1 0.4861327 1", "WAVM 2 0.5875618 1", "WAVM 3 0.6562725 1", "PWAV 2",
        "SURF 0", "  TYPE STANDARD", "  CURV 0.0 0 0 0 0 \"\"", "  DISZ INFINITY",
        "  DIAM 0 0 0 0 1 \"\"",
    ]
    for k in range(lens.count):
        r = lens.radius[k]
        out.append(f"SURF {k + 1}")
        if k == lens.stop:
            out.append("  STOP")
        out.append("  TYPE STANDARD")
        out.append(f"  CURV {0.0 if math.isinf(r) else 1 / r:.15E} 0 0 0 0 \"\"")
        if lens.conic[k]:
            out.append(f"  CONI {lens.conic[k]:.10g}")
        out.append(f"  DISZ {lens.thickness[k]:.10g}")
        s = data[k]
        if "glass" in s:
            out.append(f"  GLAS {s['glass']} 0 0 1.5 40 0 0 0 0 0 0")
        elif "index" in s:
            out.append(f"  GLAS ___BLANK 1 0 {s['index']:.10g} {s['abbe']:.10g} 0 0 0 0 0 0")
        out.append(f"  DIAM {lens.semi[k]:.10g} 1 0 0 1 \"\"")
        out += [line for number, line in extra if number == k + 1]
    out += [f"SURF {lens.count + 1}", "  TYPE STANDARD", "  CURV 0.0 0 0 0 0 \"\"",
            "  DISZ 0", "  DIAM 21.6 0 0 0 1 \"\"", "TOL TOFF 0 0 0 0 0 0 0 0 0"]
    return "\r\n".join(out) + "\r\n"


def pbrt(lens):
    """pbrt's columns: radius, gap to the next, index, aperture's diameter; the stop
    has radius and index 0, and the last gap is the program's to find."""
    out = [f"# {lens.data['name']}", f"# {lens.data['patent']}",
           "# radius\tgap\tindex\taperture diameter"]
    for k in range(lens.count):
        stop = k == lens.stop
        r = 0.0 if math.isinf(lens.radius[k]) else lens.radius[k]
        gap = 0.0 if k == lens.count - 1 else lens.thickness[k]
        n = 0.0 if stop else lens.after[k]
        out.append("\t".join(f"{v:.10g}" for v in (r, gap, n, 2 * lens.semi[k])))
    return "\n".join(out) + "\n"


def write():
    lens = reader.Lens(reader.LENSES / "double-gauss.toml")
    text = zemax(lens)
    (HERE / "double-gauss.zmx").write_bytes(b"\xff\xfe" + text.encode("utf-16-le"))
    (HERE / "double-gauss-utf8.zmx").write_bytes(text.encode("utf-8"))
    (HERE / "double-gauss.dat").write_text(pbrt(lens))
    # Glasses by name.
    lens = reader.Lens(reader.LENSES / "singlet.toml")
    (HERE / "singlet.zmx").write_bytes(zemax(lens).encode("utf-8"))
    # To be refused by name: an aspheric term, and a surface that is no sphere.
    bent = zemax(lens, extra=[(2, "  PARM 2 1.5E-6")])
    bent = bent.replace("SURF 2\r\n  TYPE STANDARD", "SURF 2\r\n  TYPE EVENASPH")
    (HERE / "aspheric.zmx").write_bytes(bent.encode("utf-8"))
    tilted = zemax(lens).replace("SURF 2\r\n  TYPE STANDARD", "SURF 2\r\n  TYPE COORDBRK")
    (HERE / "tilted.zmx").write_bytes(tilted.encode("utf-8"))


if __name__ == "__main__":
    write()
