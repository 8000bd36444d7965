#include "orbits/branch_bytes.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/branch_input.hpp"
#include "capi/bytes.hpp"
#include "linalg/whole_file.hpp"
#include "motions/branch_csv.hpp"

namespace plm::capi {

std::string branch_bytes(const Branch &branch) {
    std::string all;
    write_framed(
        BytesOf::branch, [&](ByteWriter &to) { write_branch(to, branch); },
        [&](const void *from, std::size_t n) { all.append(static_cast<const char *>(from), n); });
    return all;
}

} // namespace plm::capi

using namespace plm::capi;

plm_status plm_branch_write(plm_branch *branch, std::int64_t capacity, void *bytes, std::int64_t *needed) {
    return call<BranchHandle>("plm_branch_write", branch, [&](BranchHandle &b) {
        const auto body = [&](plm::ByteWriter &to) { plm::write_branch(to, *b.core); };
        return put_bytes(plm::BytesOf::branch, body, capacity, bytes, needed);
    });
}

plm_status plm_branch_write_to(plm_branch *branch, plm_write_fn fn, void *user) {
    return call<BranchHandle>("plm_branch_write_to", branch, [&](BranchHandle &b) {
        const auto body = [&](plm::ByteWriter &to) { plm::write_branch(to, *b.core); };
        return hand_bytes(plm::BytesOf::branch, body, HostSink(*b.owner, fn, user));
    });
}

plm_status plm_branch_read(plm_basis *basis, std::int64_t n, const void *bytes, plm_branch **branch) {
    return call<BasisHandle>("plm_branch_read", basis, [&](BasisHandle &b) {
        require_pointer(branch, "branch");
        plm::ByteReader from = given_bytes(plm::BytesOf::branch, n, bytes);
        const std::shared_ptr<const plm::Branch> core = plm::read_branch(from, built(b)->reduced());
        from.finish();
        *branch = publish(std::make_shared<BranchHandle>(b.owner, core));
        return PLM_OK;
    });
}

plm_status plm_branch_write_csv(plm_branch *branch, std::int64_t dof, std::int32_t measure,
                                std::int32_t harmonic, const char *path) {
    return call<BranchHandle>("plm_branch_write_csv", branch, [&](BranchHandle &b) {
        require_measure(*b.core, dof, measure, harmonic);
        require_pointer(path, "path");
        plm::write_whole_file(path,
                              plm::csv_of(*b.core, {dof, static_cast<plm::Measure>(measure), harmonic}));
        return PLM_OK;
    });
}

plm_status plm_branch_write_csv_to(plm_branch *branch, std::int64_t dof, std::int32_t measure,
                                   std::int32_t harmonic, plm_write_fn fn, void *user) {
    return call<BranchHandle>("plm_branch_write_csv_to", branch, [&](BranchHandle &b) {
        require_measure(*b.core, dof, measure, harmonic);
        HostSink to(*b.owner, fn, user);
        const std::string text = plm::csv_of(*b.core, {dof, static_cast<plm::Measure>(measure), harmonic});
        to(text.data(), text.size());
        to.flush();
        return PLM_OK;
    });
}
