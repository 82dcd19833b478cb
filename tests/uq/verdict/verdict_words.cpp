// Every combination of facts has words that do not contradict each other.
#include "uq/verdict/verdict_words.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "uq/verdict/verdict.hpp"

using namespace uq;

namespace {

bool has(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }

/// A parameter with one combination of facts, judged.
ParameterReport judged(const std::string& name, const WordFacts& facts, const ParameterEvidence& more) {
  ParameterEvidence evidence = more;
  evidence.found.name = name;
  if (!(evidence.found.sd > 0.0)) {
    evidence.found.mean = 0.5;
    evidence.found.sd = 0.3;
    evidence.found.prior_high = 1.0;
  }
  evidence.found.q95 = evidence.found.mean + 2.0 * evidence.found.sd;
  evidence.facts = facts;
  for (int i = 0; i < facts.parts; ++i)
    evidence.found.intervals.push_back(
        {.low = 0.1 + 0.4 * i, .high = 0.3 + 0.4 * i, .weight = 0.5, .mean = 0.2, .sd = 0.05});
  const VerdictThresholds thresholds;
  const ParameterVerdict verdict = judge(evidence, {}, {}, thresholds);
  ParameterReport report = evidence.found;
  report.contraction = facts.contraction;
  report.verdict = verdict.verdict;
  report.reason = verdict.reason;
  report.sentence = verdict.sentence;
  report.shares = verdict.shares;
  return report;
}

/// All combinations of facts of one parameter.
std::vector<ParameterReport> all_parameters(const std::string& name) {
  std::vector<ParameterReport> all;
  for (const bool influences : {true, false})
    for (const int parts : {1, 2})
      for (const bool open_low : {false, true})
        for (const bool open_high : {false, true})
          for (const bool physical : {false, true})
            for (const double contraction : {0.2, 0.7, 0.95})
              for (const bool structural : {false, true})
                for (const bool undecided : {false, true})
                  for (const double surrogate : {0.0, 0.3, 0.8})
                    for (const double common : {0.0, 0.4, 0.9})
                      for (const bool pinned : {false, true}) {
                        ParameterEvidence more;
                        more.structural = structural;
                        more.undecided = undecided;
                        more.surrogate_share = surrogate;
                        more.found.common = {.share = common, .errors = {{CommonErrorKind::offset, "zero"}}};
                        if (pinned && open_high) more.found.high_pinned_by = "other";
                        if (pinned && open_low) more.found.low_pinned_by = "other";
                        all.push_back(judged(name,
                                             {.influences = influences,
                                              .parts = parts,
                                              .open_low = open_low,
                                              .open_high = open_high,
                                              .physical_low = physical,
                                              .contraction = contraction,
                                              .contraction_within = contraction},
                                             more));
                      }
  return all;
}

/// What no set of words may say together.
void check_words(const std::vector<ParameterReport>& parameters, const Words& words) {
  const bool all_known = std::all_of(parameters.begin(), parameters.end(),
                                     [](const ParameterReport& p) { return p.verdict == Verdict::identified; });
  const std::string remedy = shown_remedy(words);
  CHECK(words.remedies.empty() == all_known);
  CHECK(has(remedy, "None needed") == all_known);
  if (all_known) CHECK(remedy == "None needed.");
  CHECK_FALSE(remedy.empty());
  CHECK_FALSE(words.consequence.empty());
  bool practical = false, structural = false;
  for (const ParameterReport& p : parameters) {
    practical = practical || p.reason == Reason::practical || p.reason == Reason::bound;
    structural = structural || p.reason == Reason::structural;
    // A sentence names its reason, and no other.
    for (const auto& [reason, clause] : {std::pair{Reason::practical, "noise hides it"},
                                         {Reason::surrogate, "surrogate's error hides it"},
                                         {Reason::structural, "would not help"},
                                         {Reason::no_influence, "say nothing of it"},
                                         {Reason::common_error, "which repeated readings share, hide"},
                                         {Reason::traded, "do much the same to all that was measured"}}) {
      INFO(p.sentence);
      CHECK(has(p.sentence, clause) == (p.reason == reason));
    }
    if (has(p.sentence, "is identified")) CHECK(p.verdict == Verdict::identified);
    if (p.reason == Reason::no_influence) CHECK_FALSE(has(p.sentence, "would not help"));
  }
  // To find a common error is asked for only where it holds a part of a width.
  if (has(remedy, "errors that repeated readings share"))
    CHECK(std::any_of(parameters.begin(), parameters.end(),
                      [](const ParameterReport& p) { return p.reason && p.common.share > 0.25; }));
  // A smaller error is asked for only where it can help.
  if (!practical) CHECK_FALSE(has(remedy, "educe the measurement error"));
  if (!structural) CHECK_FALSE(has(remedy, "will not part them"));
  if (has(words.consequence, "little better than the prior"))
    CHECK(std::any_of(parameters.begin(), parameters.end(),
                      [](const ParameterReport& p) { return p.contraction < 0.5; }));
}

}  // namespace

TEST_CASE("no combination of one parameter's facts has words that contradict each other", "[uq]") {
  for (const ParameterReport& parameter : all_parameters("a"))
    check_words({parameter}, words_of({.parameters = {parameter}, .traded = {}, .parted_by = {}}));
}

TEST_CASE("runs by another code are not asked of this program", "[uq]") {
  bool asked = false;
  for (const ParameterReport& parameter : all_parameters("a"))
    for (const bool own : {true, false}) {
      const Words words = words_of({.parameters = {parameter}, .traded = {}, .parted_by = {}, .own_engine = own});
      const bool named = has(shown_remedy(words), "demcal train");
      asked = asked || (own && named);
      if (!own) CHECK_FALSE(named);
    }
  CHECK(asked);
}

TEST_CASE("no combination of two parameters' facts has words that contradict each other", "[uq]") {
  // One of each verdict and reason.
  std::vector<ParameterReport> kinds;
  for (const ParameterReport& parameter : all_parameters("a"))
    if (std::none_of(kinds.begin(), kinds.end(), [&](const ParameterReport& other) {
          return other.verdict == parameter.verdict && other.reason == parameter.reason &&
                 (other.common.share == parameter.common.share) &&
                 (other.contraction < 0.5) == (parameter.contraction < 0.5) &&
                 (other.shares.surrogate > 0.5) == (parameter.shares.surrogate > 0.5);
        }))
      kinds.push_back(parameter);
  CHECK(kinds.size() > 10);
  for (const ParameterReport& first : kinds)
    for (ParameterReport second : kinds) {
      second.name = "b";
      INFO(first.sentence << " | " << second.sentence);
      const Words words = words_of({.parameters = {first, second}, .traded = {}, .parted_by = {}});
      INFO(words.finding << " | " << words.consequence << " | " << shown_remedy(words));
      check_words({first, second}, words);
      // Of two that are traded it is said once what parts them, and nothing against it.
      TradedPair pair;
      pair.parameters = {"a", "b"};
      const std::string of_pair =
          shown_remedy(words_of({.parameters = {first, second}, .traded = {pair}, .parted_by = {}}));
      INFO(of_pair);
      const auto ways = has(of_pair, "whatever a smaller error") + has(of_pair, "or reduce the measurement error") +
                        has(of_pair, "will not part them");
      CHECK(ways <= 1);
    }
}

TEST_CASE("the first remedy is that of the largest share: training runs where the surrogate decides", "[uq]") {
  ParameterEvidence more;
  more.surrogate_share = 0.8;
  const ParameterReport parameter = judged("a", {.contraction = 0.3, .contraction_within = 0.3}, more);
  CHECK(parameter.reason == uq::Reason::surrogate);
  const Words words = words_of({.parameters = {parameter}, .traded = {}, .parted_by = {}});
  CHECK(words.remedies.front().rfind("Make more training runs", 0) == 0);
  CHECK(has(shown_remedy(words), "up to 80 % of the posterior variance is the surrogate's"));
  CHECK_FALSE(has(shown_remedy(words), "Reduce the measurement error"));
}

TEST_CASE("a width that an offset holds asks for the offset, not for smaller errors of the readings", "[uq]") {
  ParameterEvidence more;
  more.found.common = {.share = 0.93, .errors = {{CommonErrorKind::offset, "zero"}}};
  const WordFacts facts{.contraction = 0.3, .contraction_within = 0.3};
  const ParameterReport held = judged("a", facts, more);
  CHECK(held.reason == uq::Reason::common_error);
  CHECK(has(held.sentence, "; the offset zero, which repeated readings share, hides it"));
  const Words words = words_of({.parameters = {held}, .traded = {}, .parted_by = {}});
  CHECK(shown_remedy(words) ==
        "Read the meter without load (the offset zero): 93 % of the variance of a is held by errors that repeated "
        "readings share, and neither repeats nor smaller errors of each take that away.");

  SECTION("a part of it is named beside the readings' errors") {
    more.found.common.share = 0.3;
    const ParameterReport partly = judged("a", facts, more);
    CHECK(partly.reason == uq::Reason::practical);
    const Words both = words_of({.parameters = {partly}, .traded = {}, .parted_by = {}});
    REQUIRE(both.remedies.size() == 2);
    CHECK(both.remedies[0].rfind("Reduce the measurement error", 0) == 0);
    CHECK(both.remedies[1].rfind("Read the meter without load (the offset zero): up to 30 % of the variance is", 0) ==
          0);
  }
}

TEST_CASE("of traded parameters another quantity is advised first, where the surrogate leaves open why", "[uq]") {
  ParameterEvidence more;
  more.undecided = true;
  more.surrogate_share = 0.12;
  const WordFacts facts{.contraction = 0.7, .contraction_within = 0.7};
  const std::vector<ParameterReport> both = {judged("a", facts, more), judged("b", facts, more)};
  CHECK(both[0].reason == uq::Reason::traded);
  TradedPair pair;
  pair.parameters = {"a", "b"};
  const Words words = words_of({.parameters = both, .traded = {pair}, .parted_by = {}});
  CHECK(words.remedies.front().rfind("Measure a quantity that responds differently to a and b, or fix one", 0) == 0);
  CHECK(has(shown_remedy(words), "More training runs would help, too: up to 12 %"));
  // More runs alone narrow nothing where their share of the width is small.
  more.surrogate_share = 0.05;
  const std::vector<ParameterReport> sharp = {judged("a", facts, more), judged("b", facts, more)};
  CHECK_FALSE(has(shown_remedy(words_of({.parameters = sharp, .traded = {pair}, .parted_by = {}})), "raining runs"));
}

TEST_CASE("the end of a range is no limit of a parameter that is only known in a combination", "[uq]") {
  ParameterEvidence more;
  more.traded = true;
  for (const bool low : {true, false}) {
    const WordFacts facts{
        .open_low = low, .open_high = !low, .physical_low = low, .contraction = 0.3, .contraction_within = 0.3};
    CHECK(judged("a", facts, more).reason == uq::Reason::traded);
  }
  // An upper limit that the data narrow well stays one.
  CHECK(judged("a", {.open_low = true, .physical_low = true, .contraction = 0.7, .contraction_within = 0.7}, more)
            .reason == uq::Reason::bound);
}

TEST_CASE("a side that a stated prior ends does not depend on where the range does", "[uq]") {
  ParameterEvidence more;
  more.found.mean = 6.0;
  more.found.sd = 0.9;
  more.found.prior_high = 10.0;
  const WordFacts facts{.open_high = true, .contraction = 0.3, .contraction_within = 0.3};
  CHECK(judged("a", facts, more).reason == uq::Reason::practical);
  more.found.sd = 2.5;
  CHECK(judged("a", facts, more).reason == uq::Reason::one_sided);
}

TEST_CASE("an end that the surrogate's ignorance makes asks for runs", "[uq]") {
  ParameterEvidence more;
  more.unknown_beyond = true;
  const ParameterReport found = judged("a", {.open_high = true, .contraction = 0.3, .contraction_within = 0.3}, more);
  CHECK(found.reason == uq::Reason::surrogate);
  CHECK(found.shares.surrogate == 1.0);
}

TEST_CASE("runs are no remedy where an exact surrogate would leave the width", "[uq]") {
  // Open on both sides, a tenth of the variance the surrogate's.
  const WordFacts facts{.open_low = true, .open_high = true, .contraction = 0.2, .contraction_within = 0.2};
  ParameterEvidence more;
  more.unknown_beyond = true;
  more.surrogate_share = 0.1;
  more.undecided = true;
  CHECK(judged("a", facts, more).reason == uq::Reason::surrogate);
  more.runs_could_tell = false;
  const ParameterReport found = judged("a", facts, more);
  CHECK(found.reason == uq::Reason::traded);
  CHECK(found.shares.surrogate == 0.1);
  more.unknown_beyond = more.undecided = false;
  more.faint = true;
  CHECK(judged("a", facts, more).reason == uq::Reason::practical);
}

TEST_CASE("narrow parts at the ends of the range are separate values, unless something else ends them", "[uq]") {
  WordFacts facts{.parts = 2, .open_low = true, .open_high = true, .contraction = -1.0, .contraction_within = 0.99};
  CHECK(word_of(facts, {}) == uq::Verdict::several_values);
  facts.contraction_within = 0.7;
  CHECK(word_of(facts, {}) == uq::Verdict::not_identified);
  facts.contraction_within = 0.99;
  facts.open_beyond = true;
  CHECK(word_of(facts, {}) == uq::Verdict::not_identified);
}

TEST_CASE("a range that ends a value is widened with runs where it is a parameter's, and without where it is a meter's",
          "[uq]") {
  const auto remedy_with = [](const std::string& other) {
    ParameterEvidence evidence{.conditional_on = other};
    evidence.found.low_pinned_by = evidence.found.high_pinned_by = other;
    const WordFacts open{.open_low = true, .open_high = true, .open_beyond = true, .contraction = 0.2};
    const ParameterReport b = judged("b", {.contraction = 0.95, .contraction_within = 0.95}, {});
    return shown_remedy(words_of({.parameters = {judged("a", open, evidence), b}, .traded = {}, .parted_by = {}}));
  };
  CHECK(has(remedy_with("b"), "Widen the range of b, with training runs there."));
  CHECK(has(remedy_with("offset"), "Widen the range of offset, or find it by a calibration of the meter."));
  CHECK_FALSE(has(remedy_with("offset"), "training runs"));
}

TEST_CASE("a parameter without influence is told neither structural nor hidden by noise, and gets one remedy", "[uq]") {
  const ParameterReport known = judged("a", {.contraction = 0.95, .contraction_within = 0.95}, {});
  const ParameterReport silent = judged("b", {.influences = false, .open_low = true, .open_high = true}, {});
  CHECK(silent.reason == uq::Reason::no_influence);
  const Words words = words_of({.parameters = {known, silent}, .traded = {}, .parted_by = {}});
  CHECK(words.finding == "The data determine a. They say nothing of b.");
  CHECK(has(shown_remedy(words), "that b moves"));
  CHECK_FALSE(has(shown_remedy(words), "measurement error"));
}

TEST_CASE("separate values are never averaged: the consequence says so, the remedy is what parts them", "[uq]") {
  const ParameterReport two = judged("a", {.parts = 2, .contraction = 0.1, .contraction_within = 0.95}, {});
  CHECK(two.verdict == Verdict::several_values);
  CHECK(has(two.sentence, "two separate values"));
  const Words words =
      words_of({.parameters = {two}, .traded = {}, .parted_by = "measure torque at speed 50 rpm, where they part"});
  CHECK(shown_remedy(words) == "Measure torque at speed 50 rpm, where they part.");
  CHECK(has(words.consequence, "their mean fits nothing"));
}

TEST_CASE("where no run speaks a misfit is not the model's", "[uq]") {
  ParameterEvidence evidence;
  evidence.found.name = "friction";
  evidence.unsupported = "no run speaks there";
  const ParameterVerdict found = judge(evidence, {.predictive_p = 0.0, .best_fit_p = 0.0}, {}, {});
  CHECK(found.verdict == Verdict::not_identified);
  CHECK(found.reason == Reason::unsupported);
}
