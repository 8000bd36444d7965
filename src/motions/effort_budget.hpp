// The one place where effort is divided: what counts as little or much work (flops; an hour of a core has
// some 1e13), and the shares of what is left that go to one thing where another is to come. By counted work,
// so that results do not depend on the load of the machine.
#pragma once

namespace plm {

struct EffortBudget {
    /// However little is allowed, some curve is an answer: by few harmonics. A look that takes more is taken
    /// with fewer of them.
    static constexpr double first_curve = 1e10;
    /// What a look at the side may cost however little its curve did: the estimate of an error, the search
    /// for other motions. Some tenths of a second, or less where they come to an end.
    static constexpr double aside = 2e9;
    /// A run of the flow for the stability of a point by itself, by a bound that is some ten times what it
    /// takes.
    static constexpr double stability_of_point = 1e10;
    /// The estimate of an error where nothing else is left to do: the answer is worth little without.
    static constexpr double last_estimate = 4e10;

    /// A step of a curve of exact motions, of which there are some hundreds, on the whole basis: where one
    /// costs more, a compressed model is made, if there are coordinates to spare.
    static constexpr double step_to_compress = 2e7;
    /// Up to this exact motions are taken however cheap harmonics are.
    static constexpr double cheap_step = 5e7;
    /// A tenth of a second: where one costs more, motions on a compressed model are exact to a share of the
    /// accuracy alone. Below, they are as exact as others: near grazing, multipliers answer to the root of an
    /// error.
    static constexpr double long_step = 5e8;
    /// A step on a compressed model, of one on the whole: on cracked plates and cylinders, compressed to a
    /// third of their coordinates.
    static constexpr double step_on_compressed = 0.2;
    /// Steps of a curve that a point of a backbone takes: it turns more often, and has an equation more.
    static constexpr double steps_of_backbone_point = 6;
    /// Steps to the motion of the unreduced structure beside a point: Newton's, and the modes of new contact
    /// sets.
    static constexpr double steps_beside = 8;

    /// Of what is left: what goes on first, where its result has to be looked at or something else has to
    /// follow.
    static constexpr double most = 0.85;
    /// The same of a curve of exact motions, where harmonics can have the rest: they need little.
    static constexpr double exact_first = 0.9;
    /// For each of several things, of which the next ones need less.
    static constexpr double half = 0.5;

    /// The estimate of an error by harmonics factors one matrix of n gaps in all harmonics: this times n^3;
    static constexpr double of_factor = 2.0 / 3.0;
    /// and it forms vectors of the unreduced structure: so many numbers for a flop.
    static constexpr double numbers_for_a_flop = 0.01;
};

} // namespace plm
