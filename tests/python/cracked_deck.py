"""A deck: a cantilever of bricks (mm, t, s) with an edge crack whose faces touch, shaken at its tip."""

NX, NY, NZ, CRACK = 10, 1, 4, 4  # elements; the crack stands behind the fourth, in the upper half
LENGTH, WIDTH, HEIGHT = 100.0, 8.0, 8.0
TIP = 1 + NX * (NY + 1) * (NZ + 1) + (NY + 1) * NZ  # label of a node at the free end, on top


def label(i, j, k):
    return 1 + (i * (NY + 1) + j) + k * (NX + 1) * (NY + 1)


def text(force=20.0, damping=True):
    nodes, twins = [], {}
    for k in range(NZ + 1):
        for i in range(NX + 1):
            for j in range(NY + 1):
                nodes.append((label(i, j, k), LENGTH * i / NX, WIDTH * j / NY, HEIGHT * k / NZ))
    for k in range(NZ // 2 + 1, NZ + 1):
        for j in range(NY + 1):
            twins[label(CRACK, j, k)] = 1000 + label(CRACK, j, k)
            nodes.append((twins[label(CRACK, j, k)], LENGTH * CRACK / NX, WIDTH * j / NY, HEIGHT * k / NZ))
    elements, left, right = [], [], []
    for k in range(NZ):
        for i in range(NX):
            for j in range(NY):
                number = len(elements) + 1
                corners = [label(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                if i == CRACK:
                    corners = [twins.get(node, node) for node in corners]
                elements.append((number, *corners))
                if k >= NZ // 2 and i in (CRACK - 1, CRACK):
                    (left if i == CRACK - 1 else right).append(number)
    lines = ["*HEADING", "cracked cantilever", "*NODE, NSET=NALL", *(f"{n}, {x:.6f}, {y:.6f}, {z:.6f}" for n, x, y, z in nodes),
             "*ELEMENT, TYPE=C3D8, ELSET=BEAM", *(", ".join(map(str, element)) for element in elements),
             "*NSET, NSET=CLAMP", ", ".join(str(label(0, j, k)) for k in range(NZ + 1) for j in range(NY + 1)),
             "*NSET, NSET=TIP", str(label(NX, 0, NZ)),
             "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3", "*DENSITY", "7.85e-9",
             *(["*DAMPING, ALPHA=0., BETA=2.e-6"] if damping else []),
             "*SOLID SECTION, ELSET=BEAM, MATERIAL=STEEL", "*BOUNDARY", "CLAMP, 1, 3",
             "*SURFACE, NAME=LEFT, TYPE=ELEMENT", *(f"{number}, S4" for number in left),
             "*SURFACE, NAME=RIGHT, TYPE=ELEMENT", *(f"{number}, S6" for number in right),
             "*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "2.e6",
             "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE", "LEFT, RIGHT",
             "*STEP", "*STEADY STATE DYNAMICS", "100., 2000.", "*CLOAD", f"TIP, 3, {force}", "*END STEP"]
    return "\n".join(lines) + "\n"
