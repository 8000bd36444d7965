#include "capi/barrier.hpp"
#include <new>

namespace plm::capi {
namespace {

void store(Context *context, const char *function, const Error &e) noexcept {
    if (!context) return;
    ErrorDetails &d = context->error;
    d.status = e.status(), d.reason = e.reason(), d.index = e.index(), d.library_code = e.library_code();
    try {
        d.function = function;
        d.argument = e.argument();
        d.text = std::string(function) + ": " + e.what();
    } catch (...) { // no memory even for the text: the numbers above stand
        d.function.clear(), d.argument.clear(), d.text.clear();
    }
}

plm_status store_plain(Context *context, const char *function, plm_status status, const char *text) noexcept {
    try {
        store(context, function, Error(status, text));
    } catch (...) {
        if (context) context->error.status = status, context->error.text.clear();
    }
    return status;
}

} // namespace

plm_status record_failure(const char *function, Context *context) noexcept {
    try {
        throw;
    } catch (const Error &e) {
        store(context, function, e);
        return e.status();
    } catch (const std::bad_alloc &) {
        return store_plain(context, function, PLM_ERR_MEMORY,
                           "out of memory; reduce the model or the options");
    } catch (const std::exception &e) {
        return store_plain(context, function, PLM_ERR_INTERNAL, e.what());
    } catch (...) {
        return store_plain(context, function, PLM_ERR_INTERNAL, "an unknown exception; please report this");
    }
}

plm_status finished(const char *function, Context &context, const Outcome &outcome) noexcept {
    if (outcome.status <= 0) return outcome.status;
    try {
        Error said(outcome.status, outcome.text.empty() ? status_words(outcome.status) : outcome.text);
        store(&context, function, said.reason(outcome.reason));
    } catch (...) { // no memory even for the text: the results stand
        context.error = ErrorDetails();
        context.error.status = outcome.status, context.error.reason = outcome.reason;
    }
    return outcome.status;
}

} // namespace plm::capi
