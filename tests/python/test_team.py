#!/usr/bin/env python3
"""plm.mpi on the ranks of mpi4py: a chain of masses dealt out over them, against the same chain as a model of one process; a field;
what is refused, and what raises on one rank alone."""
import sys

import numpy
import scipy.sparse

try:
    from mpi4py import MPI
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
import plm
import plm.mpi

N = 12
comm = MPI.COMM_WORLD
rank, size = comm.rank, comm.size
whole = scipy.sparse.identity(N).tocsr()
rows = scipy.sparse.csr_matrix(([1.0], ([0], [N - 1])), shape=(1, N))
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)
        print(f"rank {rank} of {size}: {what}", flush=True)


def spring(i):
    entry = scipy.sparse.lil_matrix((N, N))
    k = 1 + 0.1 * (i + 1)
    entry[i, i] = k
    if i > 0:
        entry[i - 1, i - 1], entry[i, i - 1], entry[i - 1, i] = k, -k, -k
    return entry


def masses(which):
    return scipy.sparse.diags([(1 + 0.01 * (i + 1)) if i in which else 0.0 for i in range(N)])


def hand_over(team):
    mine = range(rank, N, size)
    team.own_dofs(mine)
    team.add_mass(masses(mine))
    for i in mine:
        team.add_stiffness(spring(i))
    if rank == size - 1:
        team.add_gap_rows(rows, 5.0)
        team.add_preload(N - 1, 0.3)
        team.add_excitation([N - 1, 0], [0.5, 0.0])


def one_process():
    model = plm.Model(masses(range(N)), sum(spring(i) for i in range(N)).tocsc())
    model.add_gap_rows(rows, 5.0, 0.0)
    force = numpy.zeros(N)
    force[-1] = 0.3
    model.set_preload(force)
    force[-1] = 0.5
    model.set_excitation(force)
    return model


def look(model):
    model.set_rayleigh_damping(0, 0.1)
    model.build()
    response = model.compute_response(dof=N - 1)
    return numpy.array([*model.modes(5, system="sliding"), response.frequency_hz, response.amplitude])


def raised_by(call):
    try:
        call()
    except Exception as error:  # pylint: disable=broad-except
        return error
    return None


received = []
with plm.mpi.Team(comm, N) as team:
    team.set_field(lambda dof, value: received.extend(zip(dof.tolist(), value.tolist())))
    hand_over(team)

    def program(model):
        numbers = look(model)
        team.deliver(numpy.arange(N) ** 2.0)
        return numbers
    result = team.run(program)
    expect(repr(team) == f"<plm.mpi.Team: rank {rank} of {size}, {N} DOFs>", repr(team))
if rank == 0:
    wanted = look(one_process())
    expect(numpy.all(numpy.abs(result - wanted) <= 1e-8 * wanted), f"{result} instead of {wanted}")
else:
    expect(result is None, "ranks that serve have no result")
expect(received == [(i, i ** 2.0) for i in range(rank, N, size)], f"received {received}")

with plm.mpi.Team(comm, N) as team:
    hand_over(team)
    if rank == size - 1:
        expect("dof[0] is 12" in str(raised_by(lambda: team.fix_dofs(N))), "a DOF outside")
    expect("10 x 10" in str(raised_by(lambda: team.add_mass(scipy.sparse.identity(10)))), "a matrix of another size")
    error = raised_by(lambda: team.run(look))
    expect(isinstance(error, plm.PlmError) and error.status == plm.ERR_ARGUMENT and "dof[0] is 12" in str(error), repr(error))

with plm.mpi.Team(comm, N) as team:
    hand_over(team)
    error = raised_by(lambda: team.run(lambda model: 1 // 0))
    expect(isinstance(error, ZeroDivisionError) if rank == 0 else getattr(error, "status", 0) == plm.ERR_CALLBACK, repr(error))

with plm.mpi.Team(comm, N) as team:
    hand_over(team)
    team.set_field((lambda dof, value: {}[0]) if rank == size - 1 else None)
    error = raised_by(lambda: team.run(lambda model: team.deliver(numpy.ones(N))))
    expect(isinstance(error, KeyError) if rank == size - 1 else getattr(error, "status", 0) == plm.ERR_CALLBACK, repr(error))
error = raised_by(lambda: plm.mpi.Team(comm, 0))
expect(isinstance(error, plm.PlmError) and "n_dof is 0" in str(error), repr(error))
expect("plm_team" in str(raised_by(lambda: team.own_dofs(0))), "a team that is destroyed")
sys.exit(comm.allreduce(len(failures)) > 0)
