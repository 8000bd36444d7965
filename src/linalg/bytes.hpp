// States as bytes: numbers in a fixed order of bytes (little-endian, doubles as IEEE 754), sizes before
// arrays, in a frame with a mark, a kind, a version and a checksum (docs/format.md). Both directions pass the
// same fields by one function of the class: bytes(x) writes x or reads it. What is read is not believed: no
// size that the bytes left cannot hold, no array with a number that is not finite.
#pragma once
#include "linalg/dense.hpp"
#include "linalg/error.hpp"
#include <complex>
#include <functional>
#include <type_traits>

namespace plm {

/// What a frame holds.
enum class BytesOf : std::uint32_t { basis = 1, branch = 2 };

/// CRC-64 (ECMA-182, reflected) of what follows on bytes of which it is `crc`.
std::uint64_t crc64(const void *bytes, std::size_t n, std::uint64_t crc = 0);

class ByteWriter {
  public:
    /// Where the bytes go, in the order in which they come.
    using Sink = std::function<void(const void *bytes, std::size_t n)>;
    static constexpr bool reads = false;

    explicit ByteWriter(Sink sink) : sink_(std::move(sink)) {}
    std::int64_t count() const { return count_; }
    std::uint64_t checksum() const { return crc_; }

    void operator()(double x);
    void operator()(std::int64_t x);
    void operator()(bool x) { (*this)(static_cast<std::int64_t>(x)); }
    void operator()(const std::string &text);
    void operator()(const vector<double> &x);
    void operator()(const vector<std::int64_t> &x);
    void operator()(const vector<char> &x);
    void operator()(const vector<std::complex<double>> &x);
    void operator()(const Matrix &x);
    /// An integer or an enumerator of which these are the least and the most.
    template <class T> void integer(const T &x, std::int64_t, std::int64_t) {
        (*this)(static_cast<std::int64_t>(x));
    }
    /// The number of things that follow, each of so many bytes or more.
    std::int64_t size(std::int64_t n, std::int64_t) {
        (*this)(n);
        return n;
    }
    void require(bool, const char *) {}
    void raw(const void *bytes, std::size_t n);

  private:
    void words(const void *first, std::int64_t n);

    Sink sink_;
    std::int64_t count_ = 0;
    std::uint64_t crc_ = 0;
};

class ByteReader {
  public:
    static constexpr bool reads = true;

    ByteReader(const void *bytes, std::int64_t n)
        : next_(static_cast<const unsigned char *>(bytes)), left_(n) {}
    std::int64_t left() const { return left_; }
    std::int64_t version = 0; // of the frame

    void operator()(double &x);
    void operator()(std::int64_t &x);
    void operator()(bool &x);
    void operator()(std::string &text);
    void operator()(vector<double> &x);
    void operator()(vector<std::int64_t> &x);
    void operator()(vector<char> &x);
    void operator()(vector<std::complex<double>> &x);
    void operator()(Matrix &x);
    template <class T> void integer(T &x, std::int64_t least, std::int64_t most) {
        std::int64_t value = 0;
        (*this)(value);
        require(value >= least && value <= most, "a number outside its range");
        x = static_cast<T>(value);
    }
    std::int64_t size(std::int64_t, std::int64_t bytes_each);
    /// PLM_ERR_ARGUMENT with the place where it is not so.
    void require(bool so, const char *found) const;
    /// Nothing is left.
    void finish() const { require(left_ == 0, "more than belongs there"); }
    void raw(void *bytes, std::size_t n);

  private:
    void words(void *first, std::int64_t n);

    const unsigned char *next_;
    std::int64_t left_, offset_ = 0;
};

/// A framed state: what `body` passes, between its head and its checksum. With a sink of null only counted.
/// Returns the number of bytes.
std::int64_t write_framed(BytesOf kind, const std::function<void(ByteWriter &)> &body,
                          const ByteWriter::Sink &sink);
/// The body of a frame, whose checksum is right. PLM_ERR_ARGUMENT ("bytes") where it is not, or of another
/// kind, or of a later version than this library knows.
ByteReader read_framed(BytesOf kind, const void *bytes, std::int64_t n);

/// Each thing of a list by `pass`. least: bytes that each takes at least.
template <class Bytes, class List, class Pass>
void pass_list(Bytes &bytes, List &list, std::int64_t least, Pass pass) {
    const std::int64_t n = bytes.size(static_cast<std::int64_t>(list.size()), least);
    if constexpr (Bytes::reads) list.resize(static_cast<std::size_t>(n));
    for (auto &x : list) pass(x);
}

/// Shapes as they must be, where they were read.
template <class Bytes>
void require_shape(Bytes &bytes, const Matrix &a, std::int64_t rows, std::int64_t cols) {
    bytes.require(a.rows() == rows && a.cols() == cols, "a matrix of another shape than belongs there");
}
template <class Bytes, class T> void require_length(Bytes &bytes, const vector<T> &x, std::int64_t n) {
    bytes.require(static_cast<std::int64_t>(x.size()) == n, "an array of another length than belongs there");
}

} // namespace plm
