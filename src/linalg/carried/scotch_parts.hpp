// What libplm tells the carried SCOTCH, one thread at a time.
#pragma once

extern "C" {
/// Strategies are scanned until it is told otherwise: by code that keeps what it allocates, and must get it.
void carried_scotch_scans(bool it_does);
/// All that SCOTCH holds, but for strategies. Its functions may have ended in a std::bad_alloc.
void carried_scotch_release();
}
