// What libplm asks the carried FFTW before it begins.
#pragma once
#include <cstddef>

extern "C" {
/// Would FFTW get these bytes now, from malloc or from its reserve?
bool carried_fftw_may_work(std::size_t bytes);
}
