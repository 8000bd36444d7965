#include "capi/bytes.hpp"
#include "capi/barrier.hpp"
#include <algorithm>
#include <cstring>

namespace plm::capi {

plm_status put_bytes(BytesOf kind, const std::function<void(ByteWriter &)> &body, std::int64_t capacity,
                     void *bytes, std::int64_t *needed) {
    require_pointer(needed, "needed");
    require_range(capacity, 0, INT64_MAX, "capacity");
    if (capacity > 0) require_pointer(bytes, "bytes");
    const std::int64_t total = write_framed(kind, body, nullptr);
    if (bytes && capacity < total)
        bad_argument("capacity", -1,
                     format("capacity is %lld where %lld bytes are to be written; ask for the length with "
                            "bytes = NULL first",
                            static_cast<long long>(capacity), static_cast<long long>(total)));
    if (bytes) {
        unsigned char *next = static_cast<unsigned char *>(bytes);
        write_framed(kind, body, [&](const void *from, std::size_t n) {
            std::memcpy(next, from, n);
            next += n;
        });
    }
    *needed = total;
    return PLM_OK;
}

void HostSink::operator()(const void *bytes, std::size_t n) {
    constexpr std::size_t most = 65536;
    const char *next = static_cast<const char *>(bytes);
    while (n > 0) {
        const std::size_t some = std::min(n, most - piece_.size());
        piece_.append(next, some);
        next += some;
        n -= some;
        if (piece_.size() == most) flush();
    }
}

void HostSink::flush() {
    if (piece_.empty()) return;
    std::int32_t status;
    {
        const HostCode host(context_);
        status = fn_(context_.handle, static_cast<std::int64_t>(piece_.size()), piece_.data(), user_);
    }
    piece_.clear();
    if (status != 0)
        throw Error(PLM_ERR_CALLBACK, format("the host's function to write by failed with code %d", status))
            .argument("fn")
            .library_code(status);
}

plm_status hand_bytes(BytesOf kind, const std::function<void(ByteWriter &)> &body, HostSink to) {
    write_framed(kind, body, [&](const void *from, std::size_t n) { to(from, n); });
    to.flush();
    return PLM_OK;
}

ByteReader given_bytes(BytesOf kind, std::int64_t n, const void *bytes) {
    require_range(n, 1, INT64_MAX, "n");
    require_pointer(bytes, "bytes");
    return read_framed(kind, bytes, n);
}

} // namespace plm::capi

using namespace plm::capi;

namespace {

std::function<void(plm::ByteWriter &)> body_of(const BasisHandle &b) {
    return [core = built(b), work = b.work](plm::ByteWriter &to) {
        to(work); // by which the effort of a search is measured
        core->write(to);
    };
}

} // namespace

plm_status plm_basis_write(plm_basis *basis, std::int64_t capacity, void *bytes, std::int64_t *needed) {
    return call<BasisHandle>("plm_basis_write", basis, [&](BasisHandle &b) {
        return put_bytes(plm::BytesOf::basis, body_of(b), capacity, bytes, needed);
    });
}

plm_status plm_basis_write_to(plm_basis *basis, plm_write_fn fn, void *user) {
    return call<BasisHandle>("plm_basis_write_to", basis, [&](BasisHandle &b) {
        return hand_bytes(plm::BytesOf::basis, body_of(b), HostSink(*b.owner, fn, user));
    });
}

plm_status plm_basis_read(plm_context *ctx, std::int64_t n, const void *bytes, plm_basis **basis) {
    return call<Context>("plm_basis_read", ctx, [&](Context &) {
        require_pointer(basis, "basis");
        plm::ByteReader from = given_bytes(plm::BytesOf::basis, n, bytes);
        double work = 0;
        from(work);
        from.require(work >= 0 && work <= plm::largest_scale, "a number of operations that is none");
        const auto core = std::make_shared<const plm::Basis>(from);
        from.finish();
        const auto owner = find<Context>(ctx);
        const auto model = std::make_shared<ModelHandle>(owner, core->model()->n_dof());
        model->core = core->model();
        const auto handle = std::make_shared<BasisHandle>(owner, model);
        handle->core = core;
        handle->basis_options = core->options();
        handle->work = work;
        handle->is_read = true;
        *basis = publish(handle);
        return PLM_OK;
    });
}

plm_status plm_basis_attach(plm_basis *basis, plm_model *model) {
    return call<BasisHandle>("plm_basis_attach", basis, [&](BasisHandle &b) {
        const std::shared_ptr<ModelHandle> m = same_context<ModelHandle>(b, model, "model");
        b.core = std::make_shared<const plm::Basis>(*built(b), built(*m));
        b.model = m;
        b.is_read = false;
        return PLM_OK;
    });
}
