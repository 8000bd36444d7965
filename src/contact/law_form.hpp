// Two forms of the contact law in the contact gaps. Penalty: N = k_n max(u, 0) of the penetration u.
// Compliance (dynamic Lagrangian): with p = N + e (u - N / k_n) the law is N = max(p, 0) for every e > 0,
// exactly; in the length v = p / e that is a contact of the moderate stiffness e on v = u + N (1/e - 1/k_n).
// It does not stiffen with k_n and has the rigid limit 1/k_n = 0, where a penalty on few harmonics only
// follows its own ripples.
#pragma once
#include "contact/contact.hpp"

namespace plm {

/// A contact of these stiffnesses on v = u + slack N.
struct LawForm {
    vector<double> stiffness; // e of every pair; k_n where it has the penalty form
    vector<double> slack;     // 1/e - 1/k_n >= 0
    bool compliant = false;   // some slack is not zero
};

LawForm penalty_form(const Contact &contact);
/// Of the pairs stiffer than `limit`, with e = `moderate`; the others keep the penalty form.
LawForm compliance_form(const Contact &contact, double limit, double moderate);

} // namespace plm
