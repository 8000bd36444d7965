// Rest and modes by factorizations of the whole structure against those of the contact space.
#include "space/spaceless.hpp"
#include "structure/matrix_input.hpp"
#include "support/test.hpp"
#include <cmath>
#include <limits>

namespace {

constexpr int across = 12, along = 36, n_pairs = across * across, n_dof = 2 * along * n_pairs;
constexpr std::int64_t n_modes = 10;

// Two blocks of a cubic grid of masses 1 and springs 1, one DOF a node, each held at its far end; their near
// ends face each other. Node k of a layer, layers from the far end of the one block to that of the other.
struct Blocks {
    std::vector<std::int32_t> i, j;
    std::vector<double> v;

    void put(int a, int b, double value) { i.push_back(a), j.push_back(b), v.push_back(value); }
    void spring(int a, int b) { put(a, a, 1), put(b, b, 1), put(std::max(a, b), std::min(a, b), -1); }
    Blocks() {
        for (int layer = 0; layer < 2 * along; ++layer)
            for (int k = 0; k < n_pairs; ++k) {
                const int at = layer * n_pairs + k;
                if (k % across + 1 < across) spring(at, at + 1);
                if (k + across < n_pairs) spring(at, at + across);
                if (layer != along - 1 && layer != 2 * along - 1) spring(at, at + n_pairs);
                if (layer == 0 || layer == 2 * along - 1) put(at, at, 1);
            }
    }
    std::shared_ptr<const plm::MatrixInput> matrix() const {
        plm::MatrixFormat f;
        f.n = n_dof, f.nnz = static_cast<std::int64_t>(v.size());
        f.storage = plm::storage::triplets, f.part = plm::part::lower;
        return std::make_shared<const plm::MatrixInput>(f, i.data(), j.data(), v.data());
    }
};

plm::ModelInput blocks(double contact_stiffness) {
    plm::ModelInput in;
    in.n_dof = n_dof;
    Blocks masses = Blocks(), stiffness = Blocks();
    masses.i.clear(), masses.j.clear(), masses.v.clear();
    for (int at = 0; at < n_dof; ++at) masses.put(at, at, 1);
    in.mass = masses.matrix(), in.stiffness = stiffness.matrix();
    for (int k = 0; k < n_pairs; ++k) {
        for (int side : {0, 1}) {
            in.gap_row.push_back(k);
            in.gap_dof.push_back((along - 1 + side) * n_pairs + k);
            in.gap_coefficient.push_back(side ? -1 : 1);
        }
        in.contact.stiffness.push_back(contact_stiffness);
        in.contact.initial_gap.push_back(0);
    }
    return in;
}

// Pressed together all over and more at four bolts, and pried open along two sides: `pried` of a bolt's
// force a node.
plm::ModelInput joint(double pried) {
    plm::ModelInput in = blocks(2);
    in.preload.assign(n_dof, 0.0);
    const auto pull = [&](int k, double force) {
        in.preload[(along - 1) * n_pairs + k] += force;
        in.preload[along * n_pairs + k] -= force;
    };
    for (int k = 0; k < n_pairs; ++k) pull(k, pried > 0 ? 1e-3 : 1e-2);
    for (int x : {3, 8})
        for (int y : {3, 8}) pull(y * across + x, 1);
    for (int x = 0; x < across; ++x)
        for (int y : {0, across - 1}) pull(y * across + x, -pried);
    return in;
}

std::shared_ptr<const plm::Model> model(const plm::ModelInput &in, plm::SpaceOptions options = {}) {
    return std::make_shared<const plm::Model>(in, options, nullptr, plm::Watch());
}

// The space is exact in statics; the springs of contact lose three or four digits of sixteen.
void rest_is_that_of_the_space(void **) {
    for (double pried : {0.0, 0.05}) {
        const auto m = model(joint(pried));
        const auto own = plm::Spaceless::if_worth(m, n_modes, plm::Watch())->rest();
        const auto space = plm::make_contact_space(m, 0, n_modes, plm::Watch());
        const auto want = plm::rest_of(*space);
        const std::int64_t closed = want->states.n_closed();
        // pairs change by more than a factorization takes over from the one before
        assert_true(pried == 0 ? closed == n_pairs : closed < n_pairs - 64 && closed > 8);
        assert_true(own->states == want->states);
        assert_true(own->iterations <= 10);
        double largest = 0, differ = 0;
        for (int k = 0; k < n_pairs; ++k) {
            largest = std::max(largest, want->force[k]);
            differ = std::max(differ, std::abs(own->force[k] - want->force[k]));
        }
        assert_true(below(differ, 1e-8 * largest));
        const plm::LargestEntry at = plm::largest_entry(want->displacement);
        assert_true(close_to(own->displacement.at(at.row), want->displacement.at(at.row), 1e-8));
    }
}

// The space's modes are right to 1e-7 of its receptances at the highest.
void modes_are_those_of_the_space(void **) {
    const auto m = model(joint(0.02));
    const auto without = plm::Spaceless::if_worth(m, n_modes, plm::Watch());
    const plm::PairStates closed = plm::PairStates::all_closed(n_pairs);
    const double highest = std::sqrt(without->modes(closed, n_modes).values.back());
    const auto space = plm::make_contact_space(m, highest, n_modes, plm::Watch());
    for (const plm::PairStates &states :
         {without->rest()->states, closed, plm::PairStates::all_open(n_pairs)}) {
        const plm::StructureModes own = without->modes(states, n_modes);
        const plm::SpaceModes want =
            plm::modes_of_contact_set(*space, states, std::numeric_limits<double>::infinity());
        assert_int_equal(own.values.size(), n_modes);
        for (std::size_t j = 0; j < own.values.size(); ++j)
            assert_true(close_to(own.values[j], want.values[j], 1e-6));
        const plm::Field momenta = m->mass_times(own.vectors);
        for (double mass : plm::column_products(own.vectors, momenta)) assert_true(close_to(mass, 1, 1e-10));
    }
}

void others_take_the_space(void **) {
    const auto worth = [](const plm::ModelInput &in, std::int64_t n, plm::SpaceOptions options) {
        return plm::Spaceless::if_worth(model(in, options), n, plm::Watch()) != nullptr;
    };
    assert_true(worth(blocks(2), n_modes, {}));
    assert_false(worth(blocks(2), n_pairs, {})); // a space has hardly more vectors
    assert_false(worth(blocks(1e8), n_modes, {}));
    plm::SpaceOptions limited; // by what a space takes
    limited.memory_limit = 1000;
    assert_false(worth(blocks(2), n_modes, limited));
}

// Without auto stiffness the build solves for some pairs; with it, for all.
void some_pairs_tell_the_local_stiffness(void **) {
    const double some = model(blocks(2))->local_stiffness(),
                 all = model(blocks(plm::auto_stiffness))->local_stiffness();
    assert_true(close_to(some, all, 0.05)); // pairs at edges are a little softer
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_is_that_of_the_space),
        cmocka_unit_test(modes_are_those_of_the_space),
        cmocka_unit_test(others_take_the_space),
        cmocka_unit_test(some_pairs_tell_the_local_stiffness),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
