// States as bytes at the border: the host's arrays and functions that take or give them.
#pragma once
#include "capi/arguments.hpp"
#include "capi/handles.hpp"
#include "linalg/bytes.hpp"

namespace plm::capi {

/// A whole state, counted or written, by the rules of plm.h: bytes NULL with capacity 0 asks for the length.
plm_status put_bytes(BytesOf kind, const std::function<void(ByteWriter &)> &body, std::int64_t capacity,
                     void *bytes, std::int64_t *needed);
/// The host's function, as a sink that hands it pieces of 64 KiB; flush() hands over what is left.
class HostSink {
  public:
    HostSink(Context &context, plm_write_fn fn, void *user) : context_(context), fn_(fn), user_(user) {
        require_pointer(reinterpret_cast<const void *>(fn), "fn");
    }
    void operator()(const void *bytes, std::size_t n);
    void flush();

  private:
    Context &context_;
    plm_write_fn fn_;
    void *user_;
    std::string piece_;
};
/// A whole state to it.
plm_status hand_bytes(BytesOf kind, const std::function<void(ByteWriter &)> &body, HostSink to);
/// The bytes of plm_branch_write.
std::string branch_bytes(const Branch &branch);
/// The body of one that the host hands over.
ByteReader given_bytes(BytesOf kind, std::int64_t n, const void *bytes);

} // namespace plm::capi
