# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# What FreeCAD says of the STEP files in the environment's PALMAR_STEP_FILES (joined by ':'), and
# whether a designer can go on with their solids: offset, shell, fillet, boolean. A line per check;
# "FAILED" in one that isn't passed. Macros in PALMAR_MACROS are run: they must give a valid solid,
# of the volume of the STEP file beside them (redesign.step or handle.step) within 1 %.
import os
import sys

import FreeCAD  # noqa: F401
import Part

failed = False


def say(file, what, passes, more=""):
    global failed
    failed = failed or not passes
    print("%s: %s %s%s" % (os.path.basename(file), what, "passed" if passes else "FAILED", more))


def attempt(file, what, make):
    try:
        shape = make()
        good = shape.isValid() and shape.Volume > 0.0
        say(file, what, good, ", %.0f mm3" % shape.Volume)
    except Exception as error:  # the kernel's own exceptions have no common class
        say(file, what, False, ": %s" % error)


def check(file):
    shape = Part.read(file)
    say(file, "is valid", shape.isValid(), ", %d solid(s), %d faces" % (len(shape.Solids), len(shape.Faces)))
    try:
        shape.check(True)
        say(file, "full check with booleans", True)
    except Exception as error:
        say(file, "full check with booleans", False, ": %s" % error)
    for solid in shape.Solids:
        box = solid.BoundBox
        attempt(file, "offset by 1 mm", lambda: Part.Solid(solid.makeOffsetShape(1.0, 1e-3)))
        flat = [f for f in solid.Faces if f.Surface.TypeId == "Part::GeomPlane"]
        ends = sorted(flat, key=lambda f: -f.Area)[:1]
        if ends:
            attempt(file, "shell of 1.5 mm", lambda: solid.makeThickness(ends, -1.5, 1e-3))
        attempt(file, "a hole through it",
                lambda: solid.cut(Part.makeCylinder(3.0, 4.0 * box.DiagonalLength,
                                                    box.Center - FreeCAD.Vector(2.0 * box.DiagonalLength, 0, 0),
                                                    FreeCAD.Vector(1, 0, 0))))
        attempt(file, "half of it", lambda: solid.common(
            Part.makeBox(box.XLength + 2, box.YLength + 2, box.ZLength + 2,
                         FreeCAD.Vector(box.XMin - 1, box.Center.y, box.ZMin - 1))))

        def rounded():
            half = solid.common(Part.makeBox(box.XLength + 2, box.YLength + 2, box.ZLength + 2,
                                             FreeCAD.Vector(box.XMin - 1, box.YMin - 1, box.Center.z)))
            cut = [f for f in half.Faces if f.Surface.TypeId == "Part::GeomPlane"
                   and abs(f.CenterOfMass.z - box.Center.z) < 1e-3]
            return half.makeFillet(1.0, cut[0].OuterWire.Edges)

        attempt(file, "fillet of 1 mm round a cut", rounded)


def run_macro(file):
    scope = {"__name__": "__main__"}
    with open(file) as text:
        exec(compile(text.read(), file, "exec"), scope)
    solid = scope["solid"]
    folder = os.path.dirname(file)
    step = [os.path.join(folder, name) for name in ("handle.step", "redesign.step")
            if os.path.exists(os.path.join(folder, name))][0]
    volume = Part.read(step).Volume
    say(file, "macro gives a valid solid", solid.isValid(), ", %d faces" % len(solid.Faces))
    say(file, "macro's volume is the STEP file's", abs(solid.Volume / volume - 1.0) < 0.01,
        ": %.0f and %.0f mm3" % (solid.Volume, volume))


for name in filter(None, os.environ.get("PALMAR_STEP_FILES", "").split(":")):
    check(name)
for name in filter(None, os.environ.get("PALMAR_MACROS", "").split(":")):
    run_macro(name)
print("FreeCAD %s: %s" % (".".join(FreeCAD.Version()[:3]), "FAILED" if failed else "all passed"))
sys.stdout.flush()
os._exit(1 if failed else 0)
