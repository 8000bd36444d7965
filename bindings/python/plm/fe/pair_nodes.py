"""At which nodes the contact pairs of a deck's model stand."""
import numpy


def pair_nodes_of(deck, model, symmetric=False):
    """(list of n_pairs tuples of node labels, notes): the slave's node of every pair that stands at one. Pairs at points of
    faces, between nodes, have an empty tuple; the notes say how many."""
    nodes = [()] * model.n_pairs
    point, pair = model.surface_point, model.surface_pair
    begin, between = 0, 0
    for labels, n_points in _contacts(deck, symmetric, len(pair)):
        here = pair[begin:begin + n_points]
        closed = numpy.flatnonzero(here >= 0)
        if labels is None:
            between += closed.size
        else:
            for i in closed.tolist():  # with `symmetric`, nodes that face each other share a pair
                nodes[here[i]] += (int(labels[i][point[begin + i]]),)
        begin += n_points
    notes = [f"{between} contact pairs stand between nodes, at points of faces: the files for viewers have them as arrays of pairs "
             "(pair_force, ...), not at nodes"] if between else []
    return nodes, notes


def _contacts(deck, symmetric, n_points):
    """Of every contact: (for each of its points the labels that "surface_point" counts among, None where points are no nodes; how
    many points)."""
    found = []
    for contact in deck.contact_pairs:
        slave, master = deck.surfaces[contact.slave], deck.surfaces[contact.master]
        if contact.points or any(len(face) > 4 for face in slave.faces) and slave.areas is None:
            found.append((None, None))
            continue
        labels = [slave.nodes] * len(slave.nodes) + ([master.nodes] * len(master.nodes) if symmetric else [])
        found.append((labels, len(labels)))
    unknown = [i for i, (labels, _) in enumerate(found) if labels is None]
    rest = n_points - sum(n or 0 for _, n in found)
    if len(unknown) > 1 or rest < 0 or not unknown and rest:  # where one begins cannot be told
        return [(None, n_points)]
    return [(labels, rest if labels is None else n) for labels, n in found]
