# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# What FreeCAD says of the STEP files in the environment's PALMAR_STEP_FILES (joined by ':'), and
# whether a designer can go on with their solids: offset, shell, fillet, boolean. A line per check;
# "FAILED" in one that isn't passed. Macros in PALMAR_MACROS are run: they must give a valid solid,
# of the volume of the STEP file beside them (redesign.step or handle.step) within 1 %. Every check
# runs in a process of its own, for at most PALMAR_CHECK_SECONDS (60): the kernel may go on for ever,
# and nothing else ends it.
import os
import signal
import sys
import time

import FreeCAD
import Part

LIMIT = int(os.environ.get("PALMAR_CHECK_SECONDS", "60"))
failed = False


def check(file, what, work):
    """`work` gives whether it passes and what more is to be said."""
    global failed
    begin = time.time()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(LIMIT)
        try:
            passes, more = work()
        except Exception as error:  # the kernel's own exceptions have no common class
            passes, more = False, str(error).strip()
        os.write(writer, (("1" if passes else "0") + more).encode())
        os._exit(0)
    os.close(writer)
    said = b""
    while True:
        piece = os.read(reader, 4096)
        if not piece:
            break
        said += piece
    os.close(reader)
    status = os.waitpid(child, 0)[1]
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGALRM:
        passes, more = False, "not finished after %d s" % LIMIT
    elif os.WIFSIGNALED(status) or not said:
        passes, more = False, "crashed (%d)" % status
    else:
        passes, more = said[:1] == b"1", said[1:].decode()
    failed = failed or not passes
    print("%s: %s %s%s (%.1f s)" % (file, what, "passed" if passes else "FAILED",
                                    ", " + more if more else "", time.time() - begin))
    sys.stdout.flush()


def solid_of(make):
    def work():
        shape = make()
        return shape.isValid() and shape.Volume > 0.0, "%.0f mm3" % shape.Volume
    return work


def box_of(solid, low, high):
    """The solid's box, a millimetre wider, from `low` to `high` of its height."""
    box = solid.BoundBox
    return Part.makeBox(box.XLength + 2, box.YLength + 2, (high - low) * box.ZLength + 1,
                        FreeCAD.Vector(box.XMin - 1, box.YMin - 1,
                                       box.ZMin + low * box.ZLength - (1 if low == 0.0 else 0)))


def rounded_cut(solid):
    half = solid.common(box_of(solid, 0.0, 0.5))
    height = solid.BoundBox.ZMin + 0.5 * solid.BoundBox.ZLength
    cut = [f for f in half.Faces if f.Surface.TypeId == "Part::GeomPlane"
           and abs(f.CenterOfMass.z - height) < 1e-3]
    return half.makeFillet(1.0, cut[0].OuterWire.Edges)


def full_check(shape):
    shape.check(True)
    return True, ""


def check_file(file):
    shape = Part.read(file)
    check(file, "is valid", lambda: (shape.isValid(), "%d solid(s), %d faces"
                                     % (len(shape.Solids), len(shape.Faces))))
    check(file, "full check with booleans", lambda: full_check(shape))
    for solid in shape.Solids:
        box = solid.BoundBox
        check(file, "offset by 1 mm",
              solid_of(lambda: Part.Solid(solid.makeOffsetShape(1.0, 1e-3).Shells[0])))
        flat = [f for f in solid.Faces if f.Surface.TypeId == "Part::GeomPlane"]
        ends = sorted(flat, key=lambda f: -f.Area)[:1]
        if ends:
            check(file, "shell of 2 mm", solid_of(lambda: solid.makeThickness(ends, -2.0, 1e-3)))
        start = box.Center - FreeCAD.Vector(2.0 * box.DiagonalLength, 0, 0)
        hole = Part.makeCylinder(3.0, 4.0 * box.DiagonalLength, start, FreeCAD.Vector(1, 0, 0))
        check(file, "a hole through it", solid_of(lambda: solid.cut(hole)))
        check(file, "its upper half", solid_of(lambda: solid.common(box_of(solid, 0.5, 1.0))))
        check(file, "fillet of 1 mm round a cut", solid_of(lambda: rounded_cut(solid)))


def run_macro(file):
    def work():
        scope = {"__name__": "__main__"}
        with open(file) as text:
            exec(compile(text.read(), file, "exec"), scope)
        solid = scope["solid"]
        folder = os.path.dirname(file)
        step = [os.path.join(folder, name) for name in ("handle.step", "redesign.step")
                if os.path.exists(os.path.join(folder, name))][0]
        volume = Part.read(step).Volume
        return (solid.isValid() and abs(solid.Volume / volume - 1.0) < 0.01,
                "%d faces, %.0f mm3; the STEP file's %.0f mm3"
                % (len(solid.Faces), solid.Volume, volume))
    check(file, "macro builds the same solid", work)


for name in filter(None, os.environ.get("PALMAR_STEP_FILES", "").split(":")):
    check_file(name)
for name in filter(None, os.environ.get("PALMAR_MACROS", "").split(":")):
    run_macro(name)
print("FreeCAD %s: %s" % (".".join(FreeCAD.Version()[:3]), "FAILED" if failed else "all passed"))
sys.stdout.flush()
os._exit(1 if failed else 0)
