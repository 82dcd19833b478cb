#include "uq/plan/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "data/random.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/interval_drop.hpp"

namespace uq::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int readings_drawn = 200;
constexpr double sure = 0.9;
constexpr int readings_most = 1024;

}  // namespace

const char* to_text(Floor floor) {
  switch (floor) {
    case Floor::none:
      return "";
    case Floor::surrogate:
      return "the surrogate's error is the floor: more training runs lower it";
    case Floor::meter:
      return "what repeated readings share is the floor";
    case Floor::range:
      return "elsewhere another parameter comes to the end of its range, and that end closes the interval, not the "
             "readings";
    case Floor::structural:
      return "repeats of it alone do not part what is traded, however many there are";
    case Floor::no_influence:
      return "neither it nor the data change with the parameter";
  }
  return "";
}

Forecast::Forecast(const ExtendedCase& extended, const CaseModel& judged, const Identification& found,
                   const Outlook& outlook, const VerdictThresholds& thresholds, std::uint64_t seed)
    : extended_(extended), outlook_(outlook), thresholds_(thresholds), seed_(seed), profiles_(found.profiles) {
  const CaseModel exact = without_surrogate_error(extended.model);
  for (std::size_t k = 0; k < profiles_.size(); ++k) {
    profiles_[k].low_pinned.reset();
    profiles_[k].high_pinned.reset();
    WordFacts facts = found.facts[k];
    facts.influences = true;  // asked again of the deviances
    found_.push_back({facts, &profiles_[k]});
    paths_.push_back(path_points(extended.model, judged, profiles_[k], found.best_fit.x, true));
    paths_of_exact_.push_back(path_points(exact, judged, profiles_[k], found.best_fit.x, true));
  }
  for (auto* paths : {&paths_, &paths_of_exact_})
    for (std::vector<PathPoint>& path : *paths)
      for (PathPoint& point : path) point.noise = extended.noise_at(point.mean, point.noise);
  data_ = observed(extended.model)(extended.measured);
}

std::vector<std::vector<WordFacts>> Forecast::facts_of_draws(const std::vector<Index>& rows, double readings,
                                                             Uncertain uncertain, OthersEnds ends) const {
  const auto measured = static_cast<Index>(extended_.measured.size()), planned = static_cast<Index>(rows.size());
  std::vector<Index> both = extended_.measured;
  both.insert(both.end(), rows.begin(), rows.end());
  VectorXd share = VectorXd::Ones(measured + planned);
  share.tail(planned).setConstant(1.0 / readings);
  std::vector<PathWords> before, after;
  std::vector<VectorXd> found_deviance;
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    std::vector<PathPoint> path = uncertain == Uncertain::all ? paths_[k] : paths_of_exact_[k];
    if (uncertain == Uncertain::nothing)
      for (PathPoint& point : path) point.covariance.setZero();
    before.emplace_back(path, extended_.measured, VectorXd::Ones(measured));
    after.emplace_back(path, both, share);
    found_deviance.push_back(before.back().usable() ? before.back().deviances(data_) : VectorXd());
  }
  data::RandomStream random(seed_, data::Purpose::planned_words);
  const auto draws = static_cast<int>(std::min<Index>(readings_drawn, outlook_.draws()));
  std::vector<std::vector<WordFacts>> found(paths_.size());
  for (int b = 0; b < draws; ++b) {
    ReadingLaw law = outlook_.law(b * outlook_.draws() / draws, rows);
    if (uncertain == Uncertain::all) {
      law.shared.diagonal() += law.noise / readings;
      const Eigen::LLT<MatrixXd> factor(law.shared);
      VectorXd z(planned);
      for (double& value : z) value = random.normal();
      law.mean += factor.matrixL() * z;
    }
    VectorXd y(measured + planned);
    y << data_, law.mean;
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      WordFacts one;
      if (before[k].usable() && after[k].usable()) {
        const VectorXd deviance = after[k].deviances(y);
        one = after[k].facts(found_[k], before[k], found_deviance[k], deviance, thresholds_);
        one.influences = deviance.maxCoeff() > thresholds_.silent_deviance;
        const auto [low, high] = after[k].ends_by_another(deviance, profiles_[k].drop);
        if (ends == OthersEnds::open) {
          one.open_low = one.open_low || low;
          one.open_high = one.open_high || high;
        }
      }
      found[k].push_back(one);
    }
  }
  return found;
}

double Forecast::width_factor(const std::vector<WordFacts>& drawn, std::size_t parameter, double width) const {
  if (!errors_unknown(extended_.model) || drawn.empty()) return 1.0;
  double sum = 0.0;
  for (const WordFacts& one : drawn) sum += std::sqrt(std::max(1.0 - one.contraction, 0.0));
  const double mean = sum / static_cast<double>(drawn.size());
  const double wanted = width * std::sqrt(std::max(1.0 - found_[parameter].facts.contraction, 0.0));
  return mean > 0.0 && wanted > 0.0 ? std::pow(wanted / mean, 2) : 1.0;
}

std::vector<Verdict> Forecast::words_of(const std::vector<WordFacts>& drawn, double width_factor) const {
  std::vector<Verdict> words;
  for (WordFacts one : drawn) {
    one.contraction = 1.0 - width_factor * (1.0 - one.contraction);
    one.contraction_within = 1.0 - width_factor * (1.0 - one.contraction_within);
    words.push_back(word_of(one, thresholds_));
  }
  return words;
}

std::vector<std::vector<WordProbability>> Forecast::words(const std::vector<Index>& rows,
                                                          const std::vector<double>& widths) const {
  const std::vector<std::vector<WordFacts>> facts = facts_of_draws(rows, 1.0, Uncertain::all, OthersEnds::open);
  std::vector<std::vector<WordProbability>> found;
  for (std::size_t k = 0; k < facts.size(); ++k) {
    const std::vector<Verdict> drawn = words_of(facts[k], width_factor(facts[k], k, widths[k]));
    found.push_back(probabilities_of(drawn));
  }
  return found;
}

double Forecast::identified(const std::vector<Index>& rows, double readings, Asked asked, Uncertain uncertain,
                            OthersEnds ends) const {
  const std::vector<Verdict> drawn =
      words_of(facts_of_draws(rows, readings, uncertain, ends)[asked.parameter], asked.width_factor);
  return static_cast<double>(std::count(drawn.begin(), drawn.end(), Verdict::identified)) /
         std::max(1.0, static_cast<double>(drawn.size()));
}

ReadingsNeeded Forecast::readings_needed(const std::vector<Index>& rows, int parameter, double width) const {
  Asked asked{parameter};
  if (errors_unknown(extended_.model))
    asked.width_factor =
        width_factor(facts_of_draws(rows, 1.0, Uncertain::all, OthersEnds::open)[parameter], parameter, width);
  const auto enough_with = [&](Uncertain uncertain, OthersEnds ends = OthersEnds::open) {
    return identified(rows, readings_most, asked, uncertain, ends) >= sure;
  };
  const double at_most = identified(rows, readings_most, asked, Uncertain::all);
  if (at_most < sure) {
    Floor floor = Floor::structural;
    if (enough_with(Uncertain::not_surrogate))
      floor = Floor::surrogate;
    else if (enough_with(Uncertain::nothing))
      floor = Floor::meter;
    else if (enough_with(Uncertain::nothing, OthersEnds::closed))
      floor = Floor::range;
    else if (const auto drawn = facts_of_draws(rows, readings_most, Uncertain::nothing, OthersEnds::open)[parameter];
             std::none_of(drawn.begin(), drawn.end(), [](const WordFacts& one) { return one.influences; }))
      floor = Floor::no_influence;
    return {.count = {}, .at_most = at_most, .floor = floor};
  }
  std::map<int, double> chance{{readings_most, at_most}};
  const auto least = [&](double wanted) -> std::optional<int> {
    if (at_most < wanted) return {};
    int enough = readings_most, few = 0;
    while (enough > few + 1) {
      const int middle = few < enough / 4 ? std::max(few + 1, enough / 4) : (few + enough) / 2;
      const auto [known, is_new] = chance.try_emplace(middle);
      if (is_new) known->second = identified(rows, middle, asked, Uncertain::all);
      (known->second >= wanted ? enough : few) = middle;
    }
    return enough;
  };
  const double error =
      std::sqrt(sure * (1.0 - sure) / static_cast<double>(std::min<Eigen::Index>(readings_drawn, outlook_.draws())));
  return {.count = least(sure),
          .low = least(sure - 2.0 * error),
          .high = least(sure + 2.0 * error),
          .at_most = at_most,
          .floor = Floor::none};
}

}  // namespace uq::plan
