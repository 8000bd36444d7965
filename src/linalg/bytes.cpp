#include "linalg/bytes.hpp"
#include <cmath>
#include <cstring>

namespace plm {
namespace {

// The line ends and the end-of-file mark in it show what a transfer as text has done to a file.
constexpr unsigned char frame_mark[8] = {0x93, 'p', 'l', 'm', '\r', '\n', 0x1a, '\n'};
constexpr std::int64_t frame_version = 1, head_bytes = 32, checksum_bytes = 8;
constexpr std::int64_t word = 8;

bool is_little_endian() {
    const std::uint16_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

std::uint64_t turned(std::uint64_t x) {
    std::uint64_t y = 0;
    for (int k = 0; k < 8; ++k) y = y << 8 | (x >> 8 * k & 0xff);
    return y;
}

// Tables for eight bytes at a time: tables[k][b] is the remainder of the byte b followed by k zeros.
struct CrcTables {
    std::uint64_t of[8][256];
    CrcTables() {
        constexpr std::uint64_t polynomial = 0xC96C5795D7870F42ull; // ECMA-182, reflected
        for (std::uint64_t b = 0; b < 256; ++b) {
            std::uint64_t r = b;
            for (int bit = 0; bit < 8; ++bit) r = (r & 1) ? r >> 1 ^ polynomial : r >> 1;
            of[0][b] = r;
        }
        for (int k = 1; k < 8; ++k)
            for (int b = 0; b < 256; ++b) of[k][b] = of[0][of[k - 1][b] & 0xff] ^ of[k - 1][b] >> 8;
    }
};

[[noreturn]] void refuse(const std::string &what) {
    throw Error(status::argument, what).argument("bytes");
}

} // namespace

std::uint64_t crc64(const void *bytes, std::size_t n, std::uint64_t crc) {
    static const CrcTables tables;
    const unsigned char *p = static_cast<const unsigned char *>(bytes);
    crc = ~crc;
    for (; n >= 8; n -= 8, p += 8) {
        std::uint64_t x = 0;
        for (int k = 7; k >= 0; --k) x = x << 8 | p[k];
        x ^= crc;
        crc = 0;
        for (int k = 0; k < 8; ++k) crc ^= tables.of[7 - k][x >> 8 * k & 0xff];
    }
    for (; n > 0; --n, ++p) crc = tables.of[0][(crc ^ *p) & 0xff] ^ crc >> 8;
    return ~crc;
}

void ByteWriter::raw(const void *bytes, std::size_t n) {
    if (n == 0) return;
    count_ += static_cast<std::int64_t>(n);
    if (!sink_) return; // counted only
    crc_ = crc64(bytes, n, crc_);
    sink_(bytes, n);
}

// n numbers of eight bytes.
void ByteWriter::words(const void *first, std::int64_t n) {
    static const bool as_they_are = is_little_endian();
    if (as_they_are) return raw(first, static_cast<std::size_t>(word * n));
    for (std::int64_t i = 0; i < n; ++i) {
        std::uint64_t x;
        std::memcpy(&x, static_cast<const unsigned char *>(first) + word * i, word);
        x = turned(x);
        raw(&x, word);
    }
}

void ByteWriter::operator()(double x) {
    words(&x, 1);
}
void ByteWriter::operator()(std::int64_t x) {
    words(&x, 1);
}
void ByteWriter::operator()(const std::string &text) {
    (*this)(static_cast<std::int64_t>(text.size()));
    raw(text.data(), text.size());
}
void ByteWriter::operator()(const vector<double> &x) {
    (*this)(static_cast<std::int64_t>(x.size()));
    words(x.data(), static_cast<std::int64_t>(x.size()));
}
void ByteWriter::operator()(const vector<std::int64_t> &x) {
    (*this)(static_cast<std::int64_t>(x.size()));
    words(x.data(), static_cast<std::int64_t>(x.size()));
}
void ByteWriter::operator()(const vector<char> &x) {
    (*this)(static_cast<std::int64_t>(x.size()));
    raw(x.data(), x.size());
}
void ByteWriter::operator()(const vector<std::complex<double>> &x) {
    (*this)(static_cast<std::int64_t>(x.size()));
    words(x.data(), 2 * static_cast<std::int64_t>(x.size())); // real, imaginary
}
void ByteWriter::operator()(const Matrix &x) {
    (*this)(x.rows());
    (*this)(x.cols());
    words(x.data(), x.rows() * x.cols());
}

void ByteReader::require(bool so, const char *found) const {
    if (so) return;
    throw Error(status::argument,
                format("the bytes are not as the library writes them: %s, before byte %lld; read them again "
                       "from where they were kept, or write them anew",
                       found, static_cast<long long>(offset_ + head_bytes)))
        .argument("bytes")
        .index(offset_ + head_bytes);
}

void ByteReader::raw(void *bytes, std::size_t n) {
    require(static_cast<std::uint64_t>(n) <= static_cast<std::uint64_t>(left_), "less than belongs there");
    if (n == 0) return;
    std::memcpy(bytes, next_, n);
    next_ += n;
    left_ -= static_cast<std::int64_t>(n);
    offset_ += static_cast<std::int64_t>(n);
}

void ByteReader::words(void *first, std::int64_t n) {
    static const bool as_they_are = is_little_endian();
    raw(first, static_cast<std::size_t>(word * n));
    for (std::int64_t i = 0; i < n && !as_they_are; ++i) {
        std::uint64_t x;
        unsigned char *at = static_cast<unsigned char *>(first) + word * i;
        std::memcpy(&x, at, word);
        x = turned(x);
        std::memcpy(at, &x, word);
    }
}

std::int64_t ByteReader::size(std::int64_t, std::int64_t bytes_each) {
    std::int64_t n = 0;
    (*this)(n);
    require(n >= 0 && n <= left_ / bytes_each, "a size that the bytes left cannot hold");
    return n;
}

void ByteReader::operator()(double &x) {
    words(&x, 1);
}
void ByteReader::operator()(std::int64_t &x) {
    words(&x, 1);
}
void ByteReader::operator()(bool &x) {
    std::int64_t value = 0;
    (*this)(value);
    require(value == 0 || value == 1, "a number where 0 or 1 belongs");
    x = value == 1;
}
void ByteReader::operator()(std::string &text) {
    text.resize(static_cast<std::size_t>(size(0, 1)));
    raw(&text[0], text.size());
}
void ByteReader::operator()(vector<double> &x) {
    x.resize(static_cast<std::size_t>(size(0, word)));
    words(x.data(), static_cast<std::int64_t>(x.size()));
    for (double v : x) require(std::isfinite(v), "an array with a number that is not finite");
}
void ByteReader::operator()(vector<std::int64_t> &x) {
    x.resize(static_cast<std::size_t>(size(0, word)));
    words(x.data(), static_cast<std::int64_t>(x.size()));
}
void ByteReader::operator()(vector<char> &x) {
    x.resize(static_cast<std::size_t>(size(0, 1)));
    raw(x.data(), x.size());
}
void ByteReader::operator()(vector<std::complex<double>> &x) {
    x.resize(static_cast<std::size_t>(size(0, 2 * word)));
    words(x.data(), 2 * static_cast<std::int64_t>(x.size()));
}
void ByteReader::operator()(Matrix &x) {
    std::int64_t rows = 0, cols = 0;
    (*this)(rows);
    (*this)(cols);
    // a side of an empty matrix is a size of something else that the bytes hold
    constexpr std::int64_t most_rows = std::int64_t(1) << 40;
    require(rows >= 0 && cols >= 0 && rows <= most_rows && cols <= most_rows, "a negative or absurd size");
    require(rows == 0 || cols <= left_ / word / rows, "a size that the bytes left cannot hold");
    x.reshape(rows, cols);
    words(x.data(), rows * cols);
    for (std::int64_t k = 0; k < rows * cols; ++k)
        require(std::isfinite(x.data()[k]), "a matrix with a number that is not finite");
}

std::int64_t write_framed(BytesOf kind, const std::function<void(ByteWriter &)> &body,
                          const ByteWriter::Sink &sink) {
    ByteWriter counting(nullptr);
    body(counting);
    const std::int64_t total = head_bytes + counting.count() + checksum_bytes;
    if (!sink) return total;
    ByteWriter writer(sink);
    writer.raw(frame_mark, sizeof frame_mark);
    writer(static_cast<std::int64_t>(kind));
    writer(frame_version);
    writer(total);
    body(writer);
    writer(static_cast<std::int64_t>(writer.checksum()));
    return total;
}

ByteReader read_framed(BytesOf kind, const void *bytes, std::int64_t n) {
    if (n < head_bytes + checksum_bytes)
        refuse(format("%lld bytes were handed over, fewer than the head of a state has; it was cut off",
                      static_cast<long long>(n)));
    ByteReader head(bytes, n);
    unsigned char mark[sizeof frame_mark];
    head.raw(mark, sizeof mark);
    if (std::memcmp(mark, frame_mark, sizeof mark) != 0)
        refuse("the bytes do not begin as a state of this library does; they are something else, or "
               "were sent as text");
    std::int64_t found = 0, version = 0, total = 0;
    head(found);
    head(version);
    head(total);
    if (version < 1 || version > frame_version)
        refuse(format("the bytes are of format version %lld, and this library knows those up to %lld; "
                      "read them with the version that wrote them, or a later one",
                      static_cast<long long>(version), static_cast<long long>(frame_version)));
    if (total != n)
        refuse(format("%lld bytes were handed over where the state has %lld; it was cut off, or more was "
                      "read than it",
                      static_cast<long long>(n), static_cast<long long>(total)));
    const unsigned char *all = static_cast<const unsigned char *>(bytes);
    ByteReader end(all + n - checksum_bytes, checksum_bytes);
    std::int64_t checksum = 0;
    end(checksum);
    if (static_cast<std::uint64_t>(checksum) != crc64(bytes, static_cast<std::size_t>(n - checksum_bytes)))
        refuse("the checksum of the bytes is wrong: they were damaged; read them again from where they were "
               "kept, or write them anew");
    if (found != static_cast<std::int64_t>(kind))
        refuse(format("the bytes are those of a %s, where a %s is asked for",
                      found == static_cast<std::int64_t>(BytesOf::basis) ? "basis" : "branch",
                      kind == BytesOf::basis ? "basis" : "branch"));
    ByteReader body(all + head_bytes, n - head_bytes - checksum_bytes);
    body.version = version;
    return body;
}

} // namespace plm
