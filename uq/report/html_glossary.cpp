// The words of the page, for a reader who meets them for the first time.
#include <array>
#include <utility>

#include "uq/report/page.hpp"

namespace uq::page {

Markup glossary_section() {
  static constexpr std::array<std::pair<const char*, const char*>, 17> words{{
      {"identified",
       "The data limit the parameter on both sides, to a small part of what was thought possible before."},
      {"weakly identified", "The data limit it on both sides, but not to a small part."},
      {"several values", "Separate values fit; each has its own interval and its share of the posterior."},
      {"not identified", "The data do not limit it on at least one side, or hardly more than was known before."},
      {"structural",
       "Other parameters can undo each change of this one. A better measurement of the same kind does not "
       "help; another kind of measurement does."},
      {"practical", "The data would limit the parameter if they were more accurate."},
      {"common error",
       "An error that repeated readings share, as a meter's offset, hides it. Repeats do not help; to find that error "
       "by "
       "itself does."},
      {"traded",
       "Other parameters can undo most of each change of this one. Another kind of measurement parts them, whatever a "
       "smaller error of the same one would do."},
      {"surrogate", "The error of the surrogate decides. More training runs help."},
      {"one-sided", "The data give a lower or an upper limit alone."},
      {"bound", "The interval ends at a bound that physics sets."},
      {"no influence", "What was measured does not change with the parameter, as far as it can be told."},
      {"borderline",
       "Another measurement of the same kind would say another word with a probability of at least 20 %."},
      {"known together", "Only a combination of parameters is known; its parts can be traded against each other."},
      {"contraction",
       "One minus the variance of the posterior over that of the prior: 0 when nothing was learnt, near 1 "
       "when the data decide."},
      {"profile interval",
       "All values at which the best fit, the other parameters free, is not significantly worse "
       "than the best of all. It does not depend on the prior."},
      {"surrogate's error", "What is not known of the simulation between its runs. It enters every likelihood."},
  }};
  return tag::dl.is("glossary")(
      each(words, [](const auto& word) { return tag::dt(word.first) + tag::dd(word.second); }));
}

}  // namespace uq::page
