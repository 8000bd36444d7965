"""Contact at rest of the decks of examples/decks by deck.model() and by CalculiX's static contact step."""
import os
import re

import numpy
import scipy.sparse.linalg

import calculix_runs
from plm.fe import read_deck


def down(xyz):
    return numpy.array([0.0, 0.0, -1.0])


def outward(xyz):
    """From the machine's axis; the oval turns it by less than 0.1 degree."""
    radial = (xyz - [0, 0, -140]) * [1, 0, 1]
    return radial / numpy.linalg.norm(radial, axis=1)[:, None]


class Rest(calculix_runs.Case):
    def step_of(self, name, step):
        """(contact, loads) of a deck as lines."""
        with open(os.path.join(calculix_runs.DECKS, name + ".inp"), encoding="ascii") as file:
            text = file.read()
        contact = text[text.index("*SURFACE INTERACTION"):text.index(f"*STEP, NAME={step}")].strip().split("\n")
        return contact, text[text.index("*CLOAD"):text.index("*END STEP")].strip().split("\n")

    def contact_forces(self, deck, u, nodes, loads):
        """n x 3, what presses on nodes: the elements' forces there, with their inner nodes condensed, less the loads."""
        K, dofs = deck.matrices.stiffness.tocsc(), deck.matrices.dofs
        known = numpy.isin(dofs[:, 0], deck.node_labels)
        q = numpy.zeros(len(dofs))
        q[known] = [u[n][d - 1] for n, d in dofs[known]]
        inner = numpy.flatnonzero(~known)
        q[inner] = scipy.sparse.linalg.spsolve(K[inner][:, inner], -(K @ q)[inner])
        force = K @ q
        for line in loads[1:]:
            node, direction, value = (field.strip() for field in line.split(","))
            for label in deck.node_sets[node] if node in deck.node_sets else [int(node)]:
                force[deck.dof(label, int(direction))] -= float(value)
        return numpy.array([[force[deck.dof(n, d)] for d in (1, 2, 3)] for n in nodes])

    def deck(self, name, change=lambda text: text):
        """Of a deck whose text is changed, on the mesh in the folder."""
        with open(os.path.join(calculix_runs.DECKS, name + ".inp"), encoding="ascii") as file:
            text = change(file.read())
        path = os.path.join(self.folder, "deck.inp")
        with open(path, "w", encoding="ascii") as file:
            file.write(text.replace(f"{name}_mesh.inp", "mesh.inp"))
        return read_deck(path)

    def compare(self, name, step, slave, normal, *held, closed, moved=lambda text: text):
        """normal: out of the slave into the master, of places xyz; moved: the mesh for both."""
        mesh_line, = self.on_mesh(name)  # copies the mesh
        with open(os.path.join(self.folder, "mesh.inp"), encoding="ascii") as file:
            mesh = moved(file.read())
        with open(os.path.join(self.folder, "mesh.inp"), "w", encoding="ascii") as file:
            file.write(mesh)
        deck = self.deck(name)
        model = deck.model().solve_rest()
        nodes = deck.surfaces[slave].nodes[model.surface_point[model.surface_pair >= 0]]
        contact, loads = self.step_of(name, step)
        u = self.displacements([mesh_line, *contact, *held], ["*STEP, INC=100", "*STATIC", "1., 1.", *loads],
                               deck.node_labels)
        forces = self.contact_forces(deck, u, nodes, loads)
        got, want = model.rest_force, -numpy.sum(forces * normal(deck.coordinates[deck.node_rows(nodes)]), axis=1)
        self.assertEqual(numpy.count_nonzero(got > 0), closed)
        # displacements are printed with seven digits, which leaves forces of about 1e-3 of the largest at open nodes
        numpy.testing.assert_array_equal(got > 0, want > 3e-3 * want.max())
        self.assertLess(abs(got.sum() - want.sum()), 1e-3 * want.sum())
        numpy.testing.assert_allclose(got, want, rtol=0.01, atol=3e-3 * want.max())

    # the joints are held at three corners for CalculiX, so that they can only strain; the library leaves them free
    def test_joint(self):
        self.compare("lap_joint", "TIGHTEN", "UPPERFACE", down, "*BOUNDARY", "1, 1, 3", "13, 1", "13, 3", "151, 3", closed=33)

    def test_joint_that_does_not_match(self):
        self.compare("lap_joint_nonmatching", "TIGHTEN", "UPPERFACE", down, "*BOUNDARY", "1, 1, 3", "13, 1", "13, 3", "151, 3",
                     closed=43)

    def test_surface_to_surface(self):
        """Integration points of the two differ, so forces are compared at the slave's nodes, which both make of them."""
        name = "lap_joint_nonmatching"
        lines = self.on_mesh(name)  # copies the mesh
        deck = self.deck(name, lambda text: text.replace("NODE TO SURFACE", "SURFACE TO SURFACE"))
        model = deck.model().solve_rest()
        contact, loads = self.step_of(name, "TIGHTEN")
        contact = [line.replace("NODE TO SURFACE", "SURFACE TO SURFACE") for line in contact]
        u = self.displacements([*lines, *contact, "*BOUNDARY", "1, 1, 3", "13, 1", "13, 3", "151, 3"],
                               ["*STEP, INC=100", "*STATIC", "1., 1.", *loads], deck.node_labels)
        nodes = deck.surfaces["UPPERFACE"].nodes
        want = self.contact_forces(deck, u, nodes, loads)[:, 2]
        K = deck.matrices.stiffness
        got = (K @ model.rest_displacement[:K.shape[0]])[[deck.dof(n, 3) for n in nodes]]
        self.assertLess(abs(got.sum() - want.sum()), 1e-3 * want.sum())
        numpy.testing.assert_allclose(got, want, rtol=0, atol=0.02 * want.max())  # measured: 0.014

    def test_plate(self):
        """The crack ends where the plate does. Of nodes at the very edge of the master CalculiX loses some (of these three at the mouth
        the outer ones, so that its forces are not alike on both sides of the plate): here they stand 1 micrometre inside."""
        def inside(text):
            def node(found):
                x, y, z = map(float, found[2].split(","))
                return f"{found[1]}, {x:.10g}, {y - (1e-3 if y == 60 else 0):.10g}, {2.5 + (z - 2.5) * (1 - 4e-4):.10g}\n"
            head, elements, rest = text.partition("*ELEMENT")
            return re.sub(r"^(41[2-9]|42[0-9]), (.*)\n", node, head, flags=re.M) + elements + rest
        self.compare("cracked_plate", "PINCH", "NEARLIP", lambda xyz: numpy.array([1.0, 0.0, 0.0]), closed=3, moved=inside)

    def test_blade(self):
        self.compare("blade_casing", "SPIN", "TIPFACE", outward, closed=8)


if __name__ == "__main__":
    calculix_runs.main()
