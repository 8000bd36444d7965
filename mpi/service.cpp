#include "mpi/service.hpp"
#include "linalg/blas_host.hpp"
#include <algorithm>

namespace plm::mpi {

void Service::require_mpi_running() {
    int started = 0, ended = 0;
    MPI_Initialized(&started);
    MPI_Finalized(&ended);
    if (!started || ended)
        throw Error(status::state,
                    "MPI is not running; call MPI_Init before and MPI_Finalize after the team's life");
}

void Service::start(MPI_Comm host, std::int64_t n_dof, const Verdict &mine) {
    team_.start(host, mine);
    n_dof_ = n_dof;
    try {
        // OpenBLAS takes its buffer now, while there is memory, and keeps it: later it would try for ever
        team_.together([] { const BlasBuffer buffer; });
        const auto n = static_cast<double>(n_dof);
        const double most = team_.largest(n), least = -team_.largest(-n);
        team_.together([&] {
            if (most != least)
                throw Error(status::argument,
                            "n_dof is not the same on all ranks; it counts the DOFs of the whole structure")
                    .argument("n_dof");
        });
    } catch (...) {
        team_.close();
        throw;
    }
}

void Service::close() {
    if (executor_) executor_->end();
    team_.close();
}

void Service::remember(const Verdict &failure) {
    if (failed_.status >= 0) failed_ = failure;
}

void Service::make_room(const CallSizes &s) {
    if (s.number <= room_.number && s.factor <= room_.factor && s.in <= room_.in && s.out <= room_.out)
        return;
    CallSizes next;
    next.number = std::max(s.number, room_.number), next.factor = std::max(s.factor, room_.factor);
    next.in = std::max(s.in, room_.in), next.out = std::max(s.out, room_.out);
    team_.together([&] {
        if (team_.is_brain()) return;
        number_.resize(static_cast<std::size_t>(next.number)),
            factor_.resize(static_cast<std::size_t>(next.factor));
        in_.resize(static_cast<std::size_t>(next.in)), out_.resize(static_cast<std::size_t>(next.out));
    });
    room_ = next;
}

/// One tall operation, as the brain tells it.
void Service::step(const Order &order, Call call) {
    const CallSizes &s = order.sizes;
    make_room(s);
    if (!team_.is_brain())
        call.number = number_.data(), call.factor = factor_.data(), call.in = in_.data(),
        call.out = out_.data();
    const auto bytes = [](std::int64_t n) { return static_cast<std::size_t>(n) * 8; };
    team_.hear(const_cast<std::int64_t *>(call.number), bytes(s.number));
    team_.hear(const_cast<double *>(call.factor), bytes(s.factor));
    team_.hear(const_cast<double *>(call.in), bytes(s.in));
    executor_->run(call);
}

void Service::perform(Call call) {
    if (!assembled_ || dismissed_)
        throw Error(
            status::state,
            "the other ranks have been dismissed (plm_team_dismiss): the model can compute no longer");
    Order order;
    order.what = static_cast<std::int64_t>(call.operation);
    order.sizes = sizes_of(call.operation, call.number);
    team_.hear(&order, sizeof order);
    step(order, call);
}

void Service::assemble(Parts &all) {
    Order order;
    order.what = to_assemble;
    team_.hear(&order, sizeof order);
    assemble_here(all);
}

void Service::assemble_here(Parts &all) {
    team_.agree(failed_);
    Rows rows(team_, n_dof_, parts.owned);
    team_.together([&] { executor_ = std::make_unique<Executor>(team_); });
    executor_->begin(std::move(rows), parts.matrices);
    const auto gather = [&](auto &mine) {
        std::vector<int> to;
        team_.together([&] { to.assign(mine.size(), 0); });
        return deliver(team_, mine, to);
    };
    all.rows = gather(parts.rows), all.terms = gather(parts.terms), all.loads = gather(parts.loads);
    parts = Parts(); // the executor has them
    assembled_ = true;
}

void Service::deliver_field(const double *values) {
    Order order;
    order.what = to_deliver;
    team_.hear(&order, sizeof order);
    receive_field(values);
}

void Service::receive_field(const double *values) {
    const auto &owned = executor_->rows().owned();
    struct Value {
        std::int64_t dof;
        double value;
    };
    std::vector<std::int64_t> dofs;
    std::vector<Value> items;
    team_.together([&] {
        for (std::int64_t dof = 0; team_.is_brain() && dof < n_dof_; ++dof)
            dofs.push_back(dof), items.push_back({dof, values[dof]});
    });
    const std::vector<int> owner = executor_->rows().owners_of(team_, dofs);
    const std::vector<Value> mine = deliver(team_, items, owner);
    team_.together([&] {
        std::vector<double> sorted(owned.size());
        for (const Value &v : mine)
            sorted[static_cast<std::size_t>(executor_->rows().local(v.dof))] = v.value;
        if (!receiver) return;
        if (const std::int32_t code = receiver(owned, sorted.data()))
            throw Error(status::callback, format("the host's function for fields failed with %d", code))
                .library_code(code);
    });
}

void Service::dismiss(const Verdict &outcome) {
    if (dismissed_) return;
    Order order;
    order.what = to_dismiss, order.outcome = outcome;
    team_.hear(&order, sizeof order);
    dismissed_ = true;
}

Verdict Service::serve() {
    while (!dismissed_) {
        Order order;
        team_.hear(&order, sizeof order);
        if (order.what == to_dismiss) {
            dismissed_ = true;
            return order.outcome;
        }
        try {
            Parts none;
            if (order.what == to_assemble)
                assemble_here(none);
            else if (order.what == to_deliver)
                receive_field(nullptr);
            else {
                Call call;
                call.operation = static_cast<Operation>(order.what);
                step(order, call);
            }
        } catch (...) { // it failed on all ranks alike, and the brain decides what follows
        }
    }
    return {};
}

} // namespace plm::mpi
