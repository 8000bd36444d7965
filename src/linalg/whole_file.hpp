// A file that is there as a whole or as it was before, whatever happens meanwhile.
#pragma once
#include <string>

namespace plm {

/// Written beside it under a name of its own, brought to the disk, and then given the name. PLM_ERR_ARGUMENT
/// ("path") with what the system says.
void write_whole_file(const std::string &path, const std::string &bytes);

/// PLM_ERR_ARGUMENT ("path") where a file of this name could not be written now.
void require_writable(const std::string &path);

} // namespace plm
