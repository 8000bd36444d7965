// The files of a study: of a folder of its own.
#include "study/report.hpp"
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace plm {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string &what, const std::string &why) {
    throw Error(status::argument, what + ": " + why + "; name a folder that can be written to")
        .argument("folder");
}

void make_folder(const fs::path &folder) {
    std::error_code failure;
    if (fs::is_directory(folder, failure)) return;
    if (!fs::create_directory(folder, failure))
        refuse("\"" + folder.string() + "\" cannot be made",
               failure ? failure.message() : "something else has this name");
}

void write(const fs::path &path, const std::string &text) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file)
        refuse("\"" + path.string() + "\" cannot be written",
               errno ? std::strerror(errno) : "the disk refused it");
}

// The name of a method as part of a file's: letters and digits in lower case, anything else as one underline.
std::string plain(const std::string &name) {
    std::string out;
    for (const char c : name) {
        const bool ordinary = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (ordinary)
            out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (!out.empty() && out.back() == '_') out.pop_back();
    return out.substr(0, 60);
}

// curve_reference_0.csv, curve_2_craig_bampton_0.csv: number and name of the method, number of the force
// level.
void write_curves(const fs::path &folder, const std::string &method, const MethodResult &r) {
    for (std::size_t level = 0; level < r.samples.size(); ++level)
        write(folder / ("curve_" + method + "_" + std::to_string(level) + ".csv"),
              curve_csv(r.samples[level]));
}

} // namespace

void write_study(const StudyResult &result, const std::string &folder) {
    const fs::path place(folder);
    make_folder(place);
    write(place / "report.md", report_markdown(result));
    write(place / "table.csv", table_csv(result));
    write_curves(place, "reference", result.reference);
    for (std::size_t i = 0; i < result.methods.size(); ++i) {
        const std::string name = plain(result.methods[i].name);
        write_curves(place, std::to_string(i) + (name.empty() ? "" : "_" + name), result.methods[i]);
    }
}

} // namespace plm
