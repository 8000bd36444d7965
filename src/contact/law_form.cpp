#include "contact/law_form.hpp"

namespace plm {

LawForm penalty_form(const Contact &contact) {
    return {contact.stiffness, vector<double>(contact.stiffness.size(), 0.0), false};
}

LawForm compliance_form(const Contact &contact, double limit, double moderate) {
    LawForm form = penalty_form(contact);
    for (std::size_t i = 0; i < form.stiffness.size(); ++i) {
        if (contact.stiffness[i] <= limit) continue;
        form.stiffness[i] = moderate;
        form.slack[i] = 1 / moderate - 1 / contact.stiffness[i];
        form.compliant = true;
    }
    return form;
}

} // namespace plm
