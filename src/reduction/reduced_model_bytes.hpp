// The reduced equations as bytes: all their small matrices, and P where it is not another's.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

class ByteReader;
class ByteWriter;

/// With P and P_0, formed.
void write_whole(ByteWriter &bytes, const ReducedModel &reduced);
std::shared_ptr<const ReducedModel> read_whole(ByteReader &bytes, std::shared_ptr<const Model> model);

/// Of a model that serves one curve of another (`from`), which is there when it is read: without P.
void write_compressed(ByteWriter &bytes, const ReducedModel &reduced);
std::shared_ptr<const ReducedModel> read_compressed(ByteReader &bytes,
                                                    std::shared_ptr<const ReducedModel> from);

/// Of its equations: bytes of a curve on other ones are refused by it.
std::uint64_t fingerprint(const ReducedModel &reduced);

} // namespace plm
