#include "linalg/whole_file.hpp"
#include "linalg/error.hpp"
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace plm {
namespace {

[[noreturn]] void refuse(const std::string &path, int code) {
    throw Error(status::argument, format("\"%s\" cannot be written: %s; name a file in a folder that can be "
                                         "written to",
                                         path.c_str(), std::strerror(code)))
        .argument("path");
}

// Given back, and where it never got its name, removed.
class NewFile {
  public:
    explicit NewFile(const std::string &path) : path_(path) {
        const std::string pattern = path + ".XXXXXX";
        name_.assign(pattern.c_str(), pattern.c_str() + pattern.size() + 1);
        file_ = mkstemp(name_.data());
        if (file_ < 0) refuse(path_, errno);
    }
    ~NewFile() {
        if (file_ >= 0) close(file_);
        if (!done_) unlink(name_.data());
    }
    NewFile(const NewFile &) = delete;

    void write(const std::string &bytes) {
        for (std::size_t at = 0; at < bytes.size();) {
            const ssize_t n = ::write(file_, bytes.data() + at, bytes.size() - at);
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) refuse(path_, errno);
            at += static_cast<std::size_t>(n);
        }
    }
    void finish() {
        constexpr mode_t readable = 0644; // mkstemp's own is for the user alone
        const bool synced = fchmod(file_, readable) == 0 && fsync(file_) == 0;
        const int code = errno;
        const bool released = close(file_) == 0;
        file_ = -1;
        if (!synced || !released) refuse(path_, synced ? errno : code);
        if (std::rename(name_.data(), path_.c_str()) != 0) refuse(path_, errno);
        done_ = true;
    }

  private:
    const std::string path_;
    std::vector<char> name_;
    int file_ = -1;
    bool done_ = false;
};

} // namespace

void require_writable(const std::string &path) {
    struct stat there;
    if (stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode)) refuse(path, EISDIR);
    const NewFile probe(path);
}

void write_whole_file(const std::string &path, const std::string &bytes) {
    NewFile file(path);
    file.write(bytes);
    file.finish();
}

} // namespace plm
