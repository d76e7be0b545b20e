#!/usr/bin/env python3
"""Writes a STEP file of boxes: a plate with two blocks on it, in mm."""
import sys

BOXES = [((0, 0, 0), (60, 30, 5)), ((5, 5, 5), (25, 25, 20)), ((35, 5, 5), (55, 25, 20))]
FACES = [((0, 2, 3, 1), (0, 0, -1)), ((4, 5, 7, 6), (0, 0, 1)), ((0, 1, 5, 4), (0, -1, 0)),
         ((2, 6, 7, 3), (0, 1, 0)), ((0, 4, 6, 2), (-1, 0, 0)), ((1, 3, 7, 5), (1, 0, 0))]


class Step:
    def __init__(self):
        self.lines = []

    def add(self, entity):
        self.lines.append(entity)
        return f"#{len(self.lines)}"

    def point(self, p):
        return self.add("CARTESIAN_POINT('',({},{},{}))".format(*(f"{float(x)}" for x in p)))

    def direction(self, d):
        return self.add("DIRECTION('',({},{},{}))".format(*(f"{float(x)}" for x in d)))

    def frame(self, origin, z):
        x = (1, 0, 0) if z[0] == 0 else (0, 1, 0)
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.point(origin)},{self.direction(z)},{self.direction(x)})")

    def box(self, lo, hi):
        corners = [[hi[k] if i >> k & 1 else lo[k] for k in range(3)] for i in range(8)]
        points = [self.point(c) for c in corners]
        faces = []
        for corner, normal in FACES:
            loop = self.add("POLY_LOOP('',({}))".format(",".join(points[i] for i in corner)))
            bound = self.add(f"FACE_OUTER_BOUND('',{loop},.T.)")
            plane = self.add(f"PLANE('',{self.frame(corners[corner[0]], normal)})")
            faces.append(self.add(f"FACE_SURFACE('',({bound}),{plane},.T.)"))
        shell = self.add("CLOSED_SHELL('',({}))".format(",".join(faces)))
        return self.add(f"FACETED_BREP('',{shell})")


def text():
    s = Step()
    application = s.add("APPLICATION_CONTEXT('automotive design')")
    s.add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{application})")
    context = s.add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
    product = s.add(f"PRODUCT('blocks','blocks','',({context}))")
    formation = s.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    design = s.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
    definition = s.add(f"PRODUCT_DEFINITION('design','',{formation},{design})")
    shape = s.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    length = s.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    angle = s.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid = s.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    accuracy = s.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.0E-6),{length},'distance_accuracy_value','')")
    units = s.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({}))"
                  "GLOBAL_UNIT_ASSIGNED_CONTEXT(({},{},{}))REPRESENTATION_CONTEXT('',''))".format(accuracy, length, angle, solid))
    breps = [s.box(*b) for b in BOXES]
    origin = s.frame((0, 0, 0), (0, 0, 1))
    representation = s.add("FACETED_BREP_SHAPE_REPRESENTATION('',({}),{})".format(",".join([origin, *breps]), units))
    s.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{representation})")
    data = "".join(f"#{i}={entity};\n" for i, entity in enumerate(s.lines, 1))
    return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n" + data +
            "ENDSEC;\nEND-ISO-10303-21;\n")


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="ascii") as file:
        file.write(text())
