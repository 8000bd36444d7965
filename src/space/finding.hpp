// What an audit has to say.
#pragma once
#include <string>

namespace plm {

struct Finding {
    int severity = 0; // 0 fact, 1 worth a look, 2 probably wrong
    double value = 0; // the number the finding is about
    std::string text;
};

} // namespace plm
