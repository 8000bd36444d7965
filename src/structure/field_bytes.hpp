// Tall vectors as bytes (linalg/bytes.hpp).
#pragma once
#include "structure/field.hpp"

namespace plm {

class ByteReader;
class ByteWriter;

void write_field(ByteWriter &bytes, const Field &field);
/// Of this shape, or PLM_ERR_ARGUMENT.
Field read_field(ByteReader &bytes, std::int64_t rows, std::int64_t cols);

} // namespace plm
