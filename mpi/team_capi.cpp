// plm_mpi.h: arguments, handles and errors; no numerics, and no exception gets out.
#include "mpi/team_handles.hpp"
#include <cmath>
#include <cstring>

using namespace plm;
using namespace plm::mpi;

namespace {

static_assert(static_cast<std::int32_t>(Operation::end) == PLM_TALL_END);
static_assert(static_cast<std::int32_t>(Operation::factor) == PLM_TALL_FACTOR);
static_assert(static_cast<std::int32_t>(Operation::diagonal) == PLM_TALL_DIAGONAL);
static_assert(status::matrix == PLM_ERR_MATRIX && status::callback == PLM_ERR_CALLBACK);

/// A call in which a rank hands over a part: where it fails, all hear of it when the model is made.
template <class Body> plm_status add(const char *function, plm_team *team, Body body) noexcept {
    return call(function, team, [&](Handle &h) -> plm_status {
        try {
            if (h.service.is_assembled() || h.service.is_dismissed())
                throw Error(status::state,
                            "the model of this team has been made; hand over everything before that");
            body(h.service);
        } catch (...) {
            h.service.remember(Team::describe_failure());
            throw;
        }
        return PLM_OK;
    });
}

[[noreturn]] void bad(const char *argument, std::int64_t index, const std::string &text) {
    throw Error(status::argument, text).argument(argument).index(index);
}

void require(const char *argument, const void *pointer, std::int64_t n) {
    if (n < 0) bad("n", -1, format("n is %lld; it cannot be negative", static_cast<long long>(n)));
    if (n > 0 && !pointer)
        bad(argument, -1,
            format("%s is NULL where %lld values are to be read", argument, static_cast<long long>(n)));
}
void require_base(std::int32_t base) {
    if (base != 0 && base != 1) bad("index_base", -1, format("index_base is %d; it must be 0 or 1", base));
}

/// Base 0, after its bounds have been checked.
std::int64_t dof_at(const Service &s, const char *argument, std::int32_t base, std::int64_t k,
                    const std::int64_t *list) {
    const std::int64_t dof = list[k] - base;
    if (dof < 0 || dof >= s.n_dof())
        bad(argument, k,
            format("%s[%lld] is %lld, outside %d ... %lld", argument, static_cast<long long>(k),
                   static_cast<long long>(list[k]), base, static_cast<long long>(s.n_dof() - 1 + base)));
    return dof;
}
double finite_at(const char *argument, std::int64_t k, const double *list, Status as = status::argument) {
    if (!std::isfinite(list[k]))
        throw Error(as, format("%s[%lld] is not finite", argument, static_cast<long long>(k)))
            .argument(argument)
            .index(k);
    return list[k];
}

/// Appends what `one` makes of 0 ... n - 1; all of it or nothing.
template <class List, class One> void append(List &list, std::int64_t n, One one) {
    const std::size_t before = list.size();
    try {
        for (std::int64_t k = 0; k < n; ++k) list.push_back(one(k));
    } catch (...) {
        list.resize(before);
        throw;
    }
}

Entry entry_at(const Service &s, std::int32_t part, std::int32_t base, std::int64_t k,
               const std::int64_t *row, const std::int64_t *column, const double *value) {
    const std::int64_t i = dof_at(s, "row", base, k, row), j = dof_at(s, "column", base, k, column);
    const double v = finite_at("value", k, value, status::matrix);
    if ((part == PLM_LOWER && i < j) || (part == PLM_UPPER && i > j))
        bad("row", k,
            format("entry %lld stands in the other triangle than `part` says", static_cast<long long>(k)));
    const auto lower = static_cast<std::int32_t>(std::max(i, j)),
               left = static_cast<std::int32_t>(std::min(i, j));
    if (part != PLM_FULL || i == j) return {lower, left, v, 0};
    return {lower, left, v / 2, i > j ? v / 2 : -v / 2};
}

/// The brain's callback of plm_model_set_tall_operations. `user` is a handle: the model may outlive the team.
std::int32_t tall(plm_context *, std::int32_t operation, const std::int64_t *number, const double *factor,
                  const double *in, double *out, void *user) {
    return call("plm_model_set_tall_operations", user, [&](Handle &h) -> plm_status {
        Call c;
        c.operation = static_cast<Operation>(operation);
        c.number = number, c.factor = factor, c.in = in, c.out = out;
        h.service.perform(c);
        return PLM_OK;
    });
}

void require_brain(Handle &h) {
    if (!h.service.team().is_brain())
        throw Error(status::state,
                    format("this is rank %d; rank 0 alone may call it, the others plm_team_serve",
                           h.service.team().rank()));
}

/// Gap rows and loads of all ranks, by the usual calls.
template <class Checked>
void add_to_model(plm_model *model, std::int64_t n_dof, const Parts &all, Checked checked) {
    std::vector<std::int64_t> start{0}, dof;
    std::vector<double> coefficient, stiffness, gap;
    for (const GapRow &r : all.rows)
        start.push_back(start.back() + r.terms), stiffness.push_back(r.stiffness), gap.push_back(r.gap);
    for (const GapTerm &t : all.terms) dof.push_back(t.dof), coefficient.push_back(t.coefficient);
    if (!all.rows.empty())
        checked(plm_model_add_gap_rows_i64(model, 0, static_cast<std::int64_t>(all.rows.size()), start.data(),
                                           dof.data(), coefficient.data(), stiffness.data(), gap.data()));
    std::map<std::int32_t, std::array<std::vector<double>, 2>> loads;
    for (const Load &l : all.loads) {
        auto &[real, imag] = loads[l.harmonic];
        real.resize(static_cast<std::size_t>(n_dof)), imag.resize(static_cast<std::size_t>(n_dof));
        real[static_cast<std::size_t>(l.dof)] += l.real, imag[static_cast<std::size_t>(l.dof)] += l.imag;
    }
    for (const auto &[harmonic, load] : loads)
        checked(harmonic == of_preload ? plm_model_set_preload(model, n_dof, load[0].data())
                                       : plm_model_set_excitation(model, harmonic, n_dof, load[0].data(),
                                                                  harmonic > 0 ? load[1].data() : nullptr));
}

} // namespace

plm_status plm_team_create(std::int32_t fortran_communicator, std::int64_t n_dof, plm_team **team) {
    capi::HeldThread held;
    try {
        Service::require_mpi_running();
        const MPI_Comm comm = MPI_Comm_f2c(fortran_communicator);
        if (comm == MPI_COMM_NULL)
            bad("fortran_communicator", -1, "it is no communicator; pass MPI_Comm_c2f(comm)");
        Verdict mine;
        std::uintptr_t number = 0;
        std::shared_ptr<Handle> made;
        try {
            if (!team) bad("team", -1, "team is NULL; it receives the handle");
            *team = nullptr;
            if (n_dof < 1)
                bad("n_dof", -1,
                    format("n_dof is %lld; it must be at least 1", static_cast<long long>(n_dof)));
            if (n_dof >= INT32_MAX)
                bad("n_dof", -1,
                    format("n_dof is %lld; MUMPS has 32-bit integers: it must be less than 2147483647",
                           static_cast<long long>(n_dof)));
            made = std::make_shared<Handle>();
            number = enter(made);
        } catch (...) {
            mine = Team::describe_failure();
        }
        try {
            Service none;
            (made ? made->service : none).start(comm, n_dof, mine);
        } catch (...) {
            leave(number);
            throw;
        }
        *team = reinterpret_cast<plm_team *>(number);
        return PLM_OK;
    } catch (...) {
        return told(creation_error, "plm_team_create", Team::describe_failure());
    }
}

plm_status plm_team_destroy(plm_team **team) {
    if (!team || !*team) return PLM_OK;
    const plm_status status = call("plm_team_destroy", *team, [&](Handle &h) -> plm_status {
        Verdict unsaid;
        unsaid.status = status::state;
        std::strcpy(unsaid.text, "rank 0 destroyed the team without dismissing the others");
        if (h.service.team().is_brain())
            h.service.dismiss(unsaid);
        else
            h.service.serve();
        h.service.close();
        return PLM_OK;
    });
    if (status == PLM_ERR_HANDLE) return status;
    leave(reinterpret_cast<std::uintptr_t>(*team));
    *team = nullptr;
    return status;
}

plm_status plm_team_own_dofs_i64(plm_team *team, std::int32_t index_base, std::int64_t n,
                                 const std::int64_t *dof) {
    return add("plm_team_own_dofs_i64", team, [&](Service &s) {
        require("dof", dof, n), require_base(index_base);
        append(s.parts.owned, n, [&](std::int64_t k) { return dof_at(s, "dof", index_base, k, dof); });
    });
}

plm_status plm_team_add_entries_i64(plm_team *team, std::int32_t which, std::int32_t part,
                                    std::int32_t index_base, std::int64_t n, const std::int64_t *row,
                                    const std::int64_t *column, const double *value) {
    return add("plm_team_add_entries_i64", team, [&](Service &s) {
        if (which != PLM_MASS && which != PLM_STIFFNESS && which != PLM_DAMPING)
            bad("which", -1, format("which is %d; it must be PLM_MASS, PLM_STIFFNESS or PLM_DAMPING", which));
        if (part != PLM_FULL && part != PLM_LOWER && part != PLM_UPPER)
            bad("part", -1, format("part is %d; it must be PLM_FULL, PLM_LOWER or PLM_UPPER", part));
        require("row", row, n), require("column", column, n), require("value", value, n),
            require_base(index_base);
        EntryList &entries = s.parts.matrices.entries[static_cast<std::size_t>(which - PLM_MASS)];
        for (std::int64_t k = 0; k < n; ++k) {
            const Entry e = entry_at(s, part, index_base, k, row, column, value);
            if (e.value != 0 || e.skew != 0) entries.add(e);
        }
        s.parts.matrices.has_damping |= which == PLM_DAMPING;
    });
}

plm_status plm_team_fix_dofs_i64(plm_team *team, std::int32_t index_base, std::int64_t n,
                                 const std::int64_t *dof) {
    return add("plm_team_fix_dofs_i64", team, [&](Service &s) {
        require("dof", dof, n), require_base(index_base);
        append(s.parts.matrices.fixed, n,
               [&](std::int64_t k) { return dof_at(s, "dof", index_base, k, dof); });
    });
}

plm_status plm_team_add_gap_rows_i64(plm_team *team, std::int32_t index_base, std::int64_t n,
                                     const std::int64_t *row_ptr, const std::int64_t *dof,
                                     const double *coefficient, const double *stiffness, const double *gap) {
    return add("plm_team_add_gap_rows_i64", team, [&](Service &s) {
        require("row_ptr", row_ptr, n), require("stiffness", stiffness, n), require("gap", gap, n),
            require_base(index_base);
        if (n == 0) return;
        for (std::int64_t k = 0; k < n; ++k)
            if (row_ptr[0] != 0 || row_ptr[k + 1] < row_ptr[k])
                bad("row_ptr", k, "row_ptr must begin with 0 and never fall");
        const std::int64_t terms = row_ptr[n];
        require("dof", dof, terms), require("coefficient", coefficient, terms);
        const std::size_t rows_before = s.parts.rows.size();
        append(s.parts.rows, n, [&](std::int64_t k) {
            return GapRow{finite_at("stiffness", k, stiffness), finite_at("gap", k, gap),
                          row_ptr[k + 1] - row_ptr[k]};
        });
        try {
            append(s.parts.terms, terms, [&](std::int64_t k) {
                return GapTerm{dof_at(s, "dof", index_base, k, dof),
                               finite_at("coefficient", k, coefficient)};
            });
        } catch (...) {
            s.parts.rows.resize(rows_before);
            throw;
        }
    });
}

plm_status plm_team_add_preload_i64(plm_team *team, std::int32_t index_base, std::int64_t n,
                                    const std::int64_t *dof, const double *force) {
    return add("plm_team_add_preload_i64", team, [&](Service &s) {
        require("dof", dof, n), require("force", force, n), require_base(index_base);
        append(s.parts.loads, n, [&](std::int64_t k) {
            return Load{dof_at(s, "dof", index_base, k, dof), of_preload, finite_at("force", k, force), 0};
        });
    });
}

plm_status plm_team_add_excitation_i64(plm_team *team, std::int32_t harmonic, std::int32_t index_base,
                                       std::int64_t n, const std::int64_t *dof, const double *real,
                                       const double *imag) {
    return add("plm_team_add_excitation_i64", team, [&](Service &s) {
        if (harmonic < 0) bad("harmonic", -1, format("harmonic is %d; it cannot be negative", harmonic));
        if (harmonic == 0 && imag)
            bad("imag", -1, "the static part (harmonic 0) has no imaginary part; pass NULL");
        require("dof", dof, n), require("real", real, n), require_base(index_base);
        append(s.parts.loads, n, [&](std::int64_t k) {
            return Load{dof_at(s, "dof", index_base, k, dof), harmonic, finite_at("real", k, real),
                        imag ? finite_at("imag", k, imag) : 0};
        });
    });
}

plm_status plm_team_set_field(plm_team *team, plm_team_field_fn fn, void *user) {
    return call("plm_team_set_field", team, [&](Handle &h) -> plm_status {
        if (fn)
            h.service.receiver = [=](const std::vector<std::int64_t> &dof, const double *value) {
                return fn(team, static_cast<std::int64_t>(dof.size()), dof.data(), value, user);
            };
        else
            h.service.receiver = nullptr;
        return PLM_OK;
    });
}

plm_status plm_team_create_model(plm_team *team, plm_context *ctx, plm_model **model) {
    return call("plm_team_create_model", team, [&](Handle &h) -> plm_status {
        require_brain(h);
        if (!model) bad("model", -1, "model is NULL; it receives the handle");
        if (h.service.is_assembled() || h.service.is_dismissed())
            throw Error(status::state, "a team makes one model; create another team for another one");
        plm_model *made = nullptr;
        const auto checked = [&](plm_status s) {
            if (s >= 0) return;
            char text[400] = "";
            plm_context_get_error_text(ctx, sizeof text, text, nullptr);
            throw Error(s, *text ? text : "ctx is no live context");
        };
        checked(plm_model_create(ctx, h.service.n_dof(), &made));
        try {
            Parts all;
            h.service.assemble(all);
            checked(plm_model_set_tall_operations(made, tall, team));
            add_to_model(made, h.service.n_dof(), all, checked);
        } catch (...) {
            plm_model_destroy(&made);
            throw;
        }
        h.context = ctx;
        *model = made;
        return PLM_OK;
    });
}

plm_status plm_team_deliver(plm_team *team, std::int64_t n_dof, const double *value) {
    return call("plm_team_deliver", team, [&](Handle &h) -> plm_status {
        require_brain(h);
        if (n_dof != h.service.n_dof() || !value)
            bad("value", -1,
                format("%lld values of a field are needed", static_cast<long long>(h.service.n_dof())));
        if (!h.service.is_assembled() || h.service.is_dismissed())
            throw Error(status::state,
                        "fields are delivered between plm_team_create_model and plm_team_dismiss");
        h.service.deliver_field(value);
        return PLM_OK;
    });
}

plm_status plm_team_dismiss(plm_team *team, plm_status outcome) {
    return call("plm_team_dismiss", team, [&](Handle &h) -> plm_status {
        require_brain(h);
        Verdict v;
        v.status = outcome;
        if (outcome != PLM_OK && h.context)
            plm_context_get_error_text(h.context, sizeof v.text, v.text, nullptr);
        if (outcome != PLM_OK && !*v.text) std::snprintf(v.text, sizeof v.text, "%s", h.error.c_str());
        h.service.dismiss(v);
        return PLM_OK;
    });
}

plm_status plm_team_serve(plm_team *team) {
    return call("plm_team_serve", team, [&](Handle &h) -> plm_status {
        if (h.service.team().is_brain())
            throw Error(
                status::state,
                "rank 0 does not serve: it makes the model (plm_team_create_model) and dismisses the others");
        const Verdict v = h.service.serve();
        if (v.status != PLM_OK) h.error = v.text;
        return v.status;
    });
}

plm_status plm_team_get_error_text(plm_team *team, std::int64_t capacity, char *buffer,
                                   std::int64_t *needed) {
    capi::HeldThread held;
    try {
        const std::shared_ptr<Handle> handle = team ? find(team) : nullptr;
        if (team && !handle) return PLM_ERR_HANDLE;
        const std::string &text = handle ? handle->error : creation_error;
        if (capacity < 0 || (capacity > 0 && !buffer)) return PLM_ERR_ARGUMENT;
        if (capacity > 0) std::snprintf(buffer, static_cast<std::size_t>(capacity), "%s", text.c_str());
        if (needed) *needed = static_cast<std::int64_t>(text.size()) + 1;
        return PLM_OK;
    } catch (...) {
        return PLM_ERR_MEMORY;
    }
}
