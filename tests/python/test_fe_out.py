"""What is written for viewers and read back by VTK's and HDF5's own readers are the numbers of the API."""
import os
import pathlib
import shutil
import stat
import subprocess
import tempfile
import unittest

import numpy
import plm
import plm.fe
from plm.fe.replacing import replacing

import cracked_bar

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None
try:
    import h5py
except ImportError:
    h5py = None

N_TIMES = 6
EXACT = 1e-12  # of the largest number: the same sums of doubles, once in another order


class Response(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = cracked_bar.Mesh()
        cls.model = cracked_bar.make_model(cls.mesh)
        basis = plm.Basis(cls.model, plm.Sampler(cls.model).run()).build()
        cls.hbm = plm.Hbm(basis, n_harmonics=5)
        cls.curve = cls.hbm.sweep()
        cls.point = int(numpy.argmax(cls.curve.amplitude(29)))
        if not 0 < cls.curve.contact(cls.point).closed.mean() < 1:
            raise AssertionError("no pair opens and closes: the test looks at nothing")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def same(self, found, wanted, what=""):
        scale = max(numpy.nanmax(numpy.abs(wanted), initial=0.0), 1e-300)
        self.assertEqual(numpy.shape(found), numpy.shape(wanted), what)
        numpy.testing.assert_allclose(found, wanted, rtol=0, atol=EXACT * scale, err_msg=what)

    def node_values(self, k, curve=None, point=None):
        """Displacement and velocity of all nodes at time k, by other functions of the API: node by node, DOF by DOF."""
        curve, point = curve or self.curve, self.point if point is None else point
        omega, n = 2 * numpy.pi * curve.frequency_hz[point], len(self.mesh.node_labels)
        q, v = numpy.zeros((n, 6)), numpy.zeros((n, 6))
        for i, label in enumerate(self.mesh.node_labels):
            for d in range(6):
                dof = self.mesh.dof(int(label), d + 1)
                if dof is None:
                    continue
                q[i, d] = curve.history(point, dof, N_TIMES)[k]
                c = curve.coefficients(point, dof)
                h = numpy.arange(1, len(c) // 2 + 1)
                phase = 2 * numpy.pi * k / N_TIMES * h
                v[i, d] = omega * (h * (c[2::2] * numpy.cos(phase) - c[1::2] * numpy.sin(phase))).sum()
        return q, v

    def contact_values(self, k):
        """By node: penetration, force, status, from the pairs one after the other."""
        contact, n = self.curve.contact(self.point, N_TIMES), len(self.mesh.node_labels)
        penetration, force, status = numpy.full(n, numpy.nan), numpy.zeros(n), numpy.full(n, -1)
        place = {int(label): i for i, label in enumerate(self.mesh.node_labels)}
        for pair, labels in enumerate(self.mesh.pair_nodes):
            for label in labels:
                i = place[int(label)]
                penetration[i] = contact.penetration[pair, k]  # one pair a node here
                force[i], status[i] = contact.force[pair, k], contact.closed[pair, k]
        return penetration, force, status


def vtk_grid(reader, path):
    reader.SetFileName(str(path))
    failures = []
    reader.AddObserver("ErrorEvent", lambda *arguments: failures.append(arguments[1]))
    reader.Update()
    if failures:
        raise AssertionError(f"VTK does not read {path}")
    return reader.GetOutput()


def arrays_of(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


@unittest.skipUnless(vtk, "no VTK (python3-vtk9) to read the files with")
class Vtu(Response):
    def test_series_has_the_numbers_of_the_api(self):
        series = plm.fe.write_vtu_series(self.folder, self.curve, self.point, self.mesh, N_TIMES)
        self.assertEqual(sorted(os.listdir(self.folder)), ["cycle.pvd", *(f"cycle_{k:03d}.vtu" for k in range(N_TIMES))])
        contact = self.curve.contact(self.point, N_TIMES)
        for k in range(N_TIMES):
            grid = vtk_grid(vtk.vtkXMLUnstructuredGridReader(), self.folder / f"cycle_{k:03d}.vtu")
            self.same(vtk_to_numpy(grid.GetPoints().GetData()), self.mesh.coordinates)
            data, field = arrays_of(grid.GetPointData()), arrays_of(grid.GetFieldData())
            q, v = self.node_values(k)
            self.same(data["displacement"], q[:, :3], "displacement")
            self.same(data["rotation"], q[:, 3:], "rotation")
            self.same(data["velocity"], v[:, :3], "velocity")
            for name, wanted in zip(("penetration", "contact_force", "contact_status"), self.contact_values(k)):
                self.same(data[name], wanted, name)
            numpy.testing.assert_array_equal(data["node"], self.mesh.node_labels)
            numpy.testing.assert_array_equal(arrays_of(grid.GetCellData())["element"], [11, 12, 40, 50, 60])
            self.same(field["pair_penetration"], contact.penetration[:, k])
            self.same(field["TimeValue"], [k / N_TIMES / self.curve.frequency_hz[self.point]])
        lines = series.read_text().splitlines()
        self.assertEqual(sum("cycle_" in line for line in lines), N_TIMES)
        self.assertIn(f'timestep="{1 / N_TIMES / self.curve.frequency_hz[self.point]!r}" part="0" file="cycle_001.vtu"',
                      series.read_text())

    def test_velocity_is_that_of_the_displacement(self):
        """Against differences in time of the displacement in the files: harmonics up to 5 and h^4 of the step."""
        n = 256
        plm.fe.write_vtu_series(self.folder, self.curve, self.point, self.mesh, n)
        q, v = [], []
        for k in range(n):
            data = arrays_of(vtk_grid(vtk.vtkXMLUnstructuredGridReader(), self.folder / f"cycle_{k:03d}.vtu").GetPointData())
            q.append(data["displacement"].copy())
            v.append(data["velocity"].copy())
        q, dt = numpy.array(q), 1 / n / self.curve.frequency_hz[self.point]
        slope = (8 * (numpy.roll(q, -1, 0) - numpy.roll(q, 1, 0)) - numpy.roll(q, -2, 0) + numpy.roll(q, 2, 0)) / (12 * dt)
        # (2 pi 5 / 256)^4 / 30 = 8e-6 of the fifth harmonic
        numpy.testing.assert_allclose(v, slope, rtol=0, atol=1e-5 * numpy.abs(slope).max())

    def test_sub_harmonic_motions_last_their_own_period(self):
        curve = self.curve

        class Doubled:
            """The same motion as if it took two periods of the excitation."""
            period_multiple = 2

            def __getattr__(self, name):
                return getattr(curve, name)

            def __len__(self):
                return len(curve)
        motion = plm.fe.node_motion.NodeMotion(Doubled(), self.point, self.mesh, N_TIMES)
        single = plm.fe.node_motion.NodeMotion(self.curve, self.point, self.mesh, N_TIMES)
        self.same(motion.time, 2 * single.time)
        self.same(motion.frame(2)["velocity"], single.frame(2)["velocity"] / 2)

    def test_superelement(self):
        """The files of a reduced structure are those of the whole one: q = T eta, with what the reduction leaves of it."""
        whole = self.model
        frequency, shape = whole.modes(6, shapes=True)
        t = shape + 0.0  # n_full x 6
        small = plm.Model(numpy.eye(6), numpy.diag((2 * numpy.pi * frequency)**2), context=whole.context)
        small.set_modal_damping(0.01)
        row = numpy.zeros((1, whole.n_dof))
        row[0, [14, 26]] = 1, -1  # z of two nodes that face each other
        small.add_gap_rows(row @ t, 1e4)
        small.set_excitation(5 * t[29])
        small.set_recovery(lambda q: t @ q, whole.n_dof)
        small.build()
        hbm = plm.Hbm(plm.Basis(small, plm.Sampler(small).run()).build(), n_harmonics=3)
        curve = hbm.sweep()
        mesh = cracked_bar.Mesh()
        mesh.pair_nodes = [(mesh.node_labels[4],)]
        plm.fe.write_vtu_series(self.folder, curve, 2, mesh, 4, recover=small.recover)
        c = numpy.stack([curve.coefficients(2, dof) for dof in range(6)], axis=1)
        h, omega = numpy.arange(1, 4), 2 * numpy.pi * curve.frequency_hz[2]
        for k in range(4):
            data = arrays_of(vtk_grid(vtk.vtkXMLUnstructuredGridReader(), self.folder / f"cycle_{k:03d}.vtu").GetPointData())
            phase = numpy.pi / 2 * k * h
            q = t @ (c[0] + numpy.cos(phase) @ c[1::2] + numpy.sin(phase) @ c[2::2])
            v = t @ (omega * (h * numpy.cos(phase)) @ c[2::2] - omega * (h * numpy.sin(phase)) @ c[1::2])
            self.same(data["displacement"][4:8], q[12:24].reshape(4, 3))
            self.same(data["velocity"][4:8], v[12:24].reshape(4, 3))
            self.same(data["penetration"][4], q[14] - q[26])

    def test_nodes_alone(self):
        """A model without elements is shown by its nodes, one vertex each."""
        self.mesh.elements, elements = [], self.mesh.elements
        try:
            plm.fe.write_vtu(self.folder / "cloud.vtu", self.mesh, {})
        finally:
            self.mesh.elements = elements
        grid = vtk_grid(vtk.vtkXMLUnstructuredGridReader(), self.folder / "cloud.vtu")
        self.assertEqual(grid.GetNumberOfCells(), len(self.mesh.node_labels))
        self.assertEqual({grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}, {vtk.VTK_VERTEX})


class Refusals(Response):
    def test_meshes_of_another_model(self):
        mesh = cracked_bar.Mesh()
        of_mesh, n_dof = mesh.dof, self.model.n_dof
        mesh.dof = lambda node, direction: n_dof if (node, direction) == (mesh.node_labels[5], 3) else of_mesh(node, direction)
        with self.assertRaisesRegex(ValueError, f"direction 3 of node {mesh.node_labels[5]} is DOF {n_dof} by the mesh"):
            plm.fe.write_vtu_series(self.folder, self.curve, self.point, mesh, N_TIMES)
        mesh = cracked_bar.Mesh()
        mesh.pair_nodes = mesh.pair_nodes[1:]
        with self.assertRaisesRegex(ValueError, "4 rows for 5 contact pairs"):
            plm.fe.write_vtu_series(self.folder, self.curve, self.point, mesh, N_TIMES)
        mesh.pair_nodes = [*mesh.pair_nodes, (1,)]
        with self.assertRaisesRegex(ValueError, "node 1 of pair_nodes is not in the mesh"):
            plm.fe.write_vtu_series(self.folder, self.curve, self.point, mesh, N_TIMES)
        with self.assertRaisesRegex(ValueError, "n_times is 0"):
            plm.fe.write_vtu_series(self.folder, self.curve, self.point, self.mesh, 0)
        self.assertEqual(os.listdir(self.folder), [])

    def test_arrays_of_another_size(self):
        with self.assertRaisesRegex(ValueError, "heat has 3 rows for 29 nodes"):
            plm.fe.write_vtu(self.folder / "x.vtu", self.mesh, {"heat": numpy.zeros(3)})
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_file_is_whole_or_not_there(self):
        path = self.folder / "file"
        path.write_text("before")
        with self.assertRaises(KeyboardInterrupt):
            with replacing(path) as beside:
                beside.write_text("half of wh")
                raise KeyboardInterrupt
        self.assertEqual((os.listdir(self.folder), path.read_text()), (["file"], "before"))
        with open(path, encoding="utf-8") as in_use:
            with replacing(path) as beside:
                beside.write_text("after")
            self.assertEqual(in_use.read(), "before")  # who reads the old one keeps it
        self.assertEqual(path.read_text(), "after")
        mask = os.umask(0)
        os.umask(mask)
        self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o666 & ~mask)
        with self.assertRaises(FileNotFoundError):
            with replacing(self.folder / "nowhere" / "file"):
                pass


@unittest.skipUnless(h5py, "no h5py (python3-h5py)")
class Hdf5(Response):
    def test_curve_harmonics_contact(self):
        path = self.folder / "curve.h5"
        plm.fe.write_hdf5(path, self.curve, n_times=32)
        with h5py.File(path) as file:
            numpy.testing.assert_array_equal(file["frequency_hz"], self.curve.frequency_hz)
            numpy.testing.assert_array_equal(file["stable"], self.curve.stable)
            self.assertEqual(file.attrs["n_harmonics"], 5)
            self.assertEqual(file.attrs["end_text"], self.curve.end_text)
            for dof in (0, 29, 95):
                self.same(file["harmonics/amplitude"][:, dof], self.curve.amplitude(dof))
                self.same(file["harmonics/coefficients"][self.point, :, dof], self.curve.coefficients(self.point, dof))
            contact = self.curve.contact(self.point, 32)
            self.same(file["contact/penetration"][self.point], contact.penetration)
            self.same(file["contact/force"][self.point], contact.force)
            numpy.testing.assert_array_equal(file["contact/closed"][self.point], contact.closed)
            self.same(file["contact/closed_share"][self.point], self.curve.closed_share(self.point))

    @unittest.skipUnless(shutil.which("octave"), "no octave to read the file with")
    def test_octave_reads_it(self):
        """Every number and every index as MATLAB counts them: from 1, dimensions in the opposite order."""
        plm.fe.write_hdf5(self.folder / "curve.h5", self.curve, n_times=32)
        script = self.folder / "read.m"
        script.write_text("s = load('-hdf5', 'curve.h5');\n"
                          "x = {s.frequency_hz, double(s.stable), s.harmonics.amplitude(30, :), "
                          f"s.harmonics.coefficients(30, :, {self.point + 1}), s.contact.force(:, :, {self.point + 1})', "
                          f"double(s.contact.closed(:, :, {self.point + 1})'), s.contact.penetration, s.contact.closed_share}};\n"
                          "for k = 1:numel(x), printf('%.17g ', x{k}); printf('\\n'); end\n")
        done = subprocess.run(["octave", "--no-gui", "--no-window-system", "--no-init-file", "--quiet", script], cwd=self.folder, check=True,
                              capture_output=True, text=True, timeout=100, env={**os.environ, "HOME": str(self.folder)})
        read = [numpy.array(line.split(), dtype=float) for line in done.stdout.splitlines()]
        contact = self.curve.contact(self.point, 32)
        points = range(len(self.curve))
        wanted = [self.curve.frequency_hz, self.curve.stable, self.curve.amplitude(29), self.curve.coefficients(self.point, 29),
                  contact.force.T, contact.closed.T, [self.curve.contact(point, 32).penetration for point in points],
                  [self.curve.closed_share(point) for point in points]]
        self.assertEqual(len(read), len(wanted))
        for found, of_the_api in zip(read, wanted):
            self.same(found, numpy.ravel(of_the_api))

    def test_some_dofs(self):
        path = self.folder / "curve.h5"
        plm.fe.write_hdf5(path, self.curve, dofs=[29, 3], n_times=4)
        with h5py.File(path) as file:
            numpy.testing.assert_array_equal(file["harmonics/dof"], [29, 3])
            for j, dof in enumerate((29, 3)):
                self.same(file["harmonics/coefficients"][2, :, j], self.curve.coefficients(2, dof))

    def test_large_files_are_asked_for(self):
        with self.assertRaisesRegex(ValueError, "would take .* MB .*name fewer DOFs"):
            plm.fe.write_hdf5(self.folder / "curve.h5", self.curve, largest=1000)
        self.assertEqual(os.listdir(self.folder), [])

    def test_vtkhdf_steps_by_the_specification(self):
        """Read as the format says steps are to be read: parts, points and cells from their offsets on, arrays from theirs."""
        path = self.folder / "cycle.vtkhdf"
        plm.fe.write_vtkhdf(path, self.curve, self.point, self.mesh, N_TIMES)
        with h5py.File(path) as file:
            root = file["VTKHDF"]
            self.assertEqual(root.attrs["Type"], b"UnstructuredGrid")
            self.assertEqual(root.attrs["Version"].tolist(), [2, 0])
            self.assertEqual(root.attrs.get_id("Type").get_type().get_class(), h5py.h5t.STRING)
            self.assertFalse(root.attrs.get_id("Type").get_type().is_variable_str())
            steps = root["Steps"]
            self.assertEqual(int(steps.attrs["NSteps"]), N_TIMES)
            self.same(steps["Values"], numpy.arange(N_TIMES) / N_TIMES / self.curve.frequency_hz[self.point])
            for k in range(N_TIMES):
                part, parts = steps["PartOffsets"][k], steps["NumberOfParts"][k]
                self.assertEqual(parts, 1)
                n_points, n_cells, n_ids = (int(root[name][part]) for name in ("NumberOfPoints", "NumberOfCells",
                                                                               "NumberOfConnectivityIds"))
                first = int(steps["PointOffsets"][k])
                self.same(root["Points"][first:first + n_points], self.mesh.coordinates)
                cell, ids = int(steps["CellOffsets"][k, 0]), int(steps["ConnectivityIdOffsets"][k, 0])
                offsets = root["Offsets"][cell + part:cell + part + n_cells + 1]  # one more a part than cells
                connectivity = root["Connectivity"][ids:ids + n_ids]
                self.assertEqual((offsets[0], offsets[-1], len(root["Types"][cell:cell + n_cells])), (0, n_ids, n_cells))
                numpy.testing.assert_array_equal(self.mesh.node_labels[connectivity[offsets[1]:offsets[2]]],
                                                 self.mesh.elements[0][2][1])
                q, v = self.node_values(k)
                for name, wanted in (("displacement", q[:, :3]), ("velocity", v[:, :3]), ("rotation", q[:, 3:]),
                                     ("contact_force", self.contact_values(k)[1])):
                    begin = int(steps["PointDataOffsets"][name][k])
                    self.same(root["PointData"][name][begin:begin + n_points], wanted, name)

    @unittest.skipUnless(vtk and hasattr(vtk, "vtkHDFReader"), "no vtkHDFReader (python3-vtk9)")
    def test_vtk_reads_the_vtkhdf_file(self):
        """All steps where VTK is young enough (9.3), else the first."""
        path = self.folder / "cycle.vtkhdf"
        plm.fe.write_vtkhdf(path, self.curve, self.point, self.mesh, N_TIMES)
        vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_ERROR)  # older ones warn of a version above 1.0
        reader = vtk.vtkHDFReader()
        self.assertTrue(reader.CanReadFile(str(path)))
        temporal = hasattr(reader, "SetStep")
        for k in range(N_TIMES if temporal else 1):
            if temporal:
                reader.SetStep(k)
            grid = vtk_grid(reader, path)
            data = arrays_of(grid.GetPointData())
            q, v = self.node_values(k)
            self.assertEqual([grid.GetCellType(i) for i in range(5)], [12, 12, 24, 9, 21])
            self.same(vtk_to_numpy(grid.GetPoints().GetData()), self.mesh.coordinates)
            self.same(data["displacement"], q[:, :3])
            self.same(data["velocity"], v[:, :3])
            for name, wanted in zip(("penetration", "contact_force", "contact_status"), self.contact_values(k)):
                self.same(data[name], wanted, name)


if __name__ == "__main__":
    unittest.main()
