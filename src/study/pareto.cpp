#include "study/pareto.hpp"
#include <cmath>

namespace plm {

vector<char> pareto_front(const vector<double> &time, const vector<double> &error) {
    vector<char> front(time.size(), 0);
    for (std::size_t i = 0; i < time.size(); ++i) {
        bool beaten = std::isnan(time[i]) || std::isnan(error[i]);
        for (std::size_t j = 0; j < time.size() && !beaten; ++j)
            beaten = time[j] <= time[i] && error[j] <= error[i] && (time[j] < time[i] || error[j] < error[i]);
        front[i] = !beaten;
    }
    return front;
}

} // namespace plm
