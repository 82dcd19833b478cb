#pragma once
// The verdict after a reading that has not been made: the probabilities of its words over the reading's possible
// values, and how many readings a word needs.
//
// A reading is drawn from its law given a draw of the posterior and the data (outlook.hpp), and joins the data; along
// the profiles' paths the deviances of both together, and from them the words, follow as in uq/verdict/repeats.hpp,
// without another search. A side is open, too, where the interval ends beside a point at which another parameter has
// come to the end of its range.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "uq/plan/outlook.hpp"
#include "uq/verdict/identifiability.hpp"

namespace uq::plan {

/// The reason why no number of readings is enough.
enum class Floor { none, surrogate, meter, range, structural, no_influence };
/// A clause for the user; empty for none.
const char* to_text(Floor floor);

struct ReadingsNeeded {
  std::optional<int> count;
  /// Numbers of readings at which the probability is two of its standard errors below and above 90 %. The probability
  /// is counted over drawn readings, and the count is known no better. No `high`: the probability is nowhere so far
  /// above.
  std::optional<int> low, high;
  double at_most = 1.0;  ///< probability of "identified" with the largest number of readings that is considered
  Floor floor = Floor::none;
};

class Forecast {
 public:
  /// `judged`: the case as it was sampled; `found` is of it.
  Forecast(const ExtendedCase& extended, const CaseModel& judged, const Identification& found, const Outlook& outlook,
           const VerdictThresholds& thresholds, std::uint64_t seed);

  /// Per own parameter, by falling probability, after the rows were read. `widths`: the sds that are expected then over
  /// those now, per own parameter. Where the errors' size is unknown a path holds it at what suits the data that are
  /// there, so that its widths come too small or too large; they are scaled to these.
  std::vector<std::vector<WordProbability>> words(const std::vector<Eigen::Index>& rows,
                                                  const std::vector<double>& widths) const;

  /// Readings for "identified" with 90 % probability, at most a thousand. `width`: the parameter's sd after one reading
  /// over that now.
  ReadingsNeeded readings_needed(const std::vector<Eigen::Index>& rows, int parameter, double width) const;

 private:
  /// The uncertain parts of the law of data, beside their noise.
  enum class Uncertain { all, not_surrogate, nothing };
  /// Whether an interval that ends where another parameter's range ends is closed.
  enum class OthersEnds { open, closed };
  /// A parameter, and the factor by which the variances along its path are scaled.
  struct Asked {
    int parameter = 0;
    double width_factor = 1.0;
  };
  std::vector<std::vector<WordFacts>> facts_of_draws(const std::vector<Eigen::Index>& rows, double readings,
                                                     Uncertain uncertain, OthersEnds ends) const;
  /// The factor by which the variances of drawn facts are to be scaled; 1 where the errors' size is known.
  double width_factor(const std::vector<WordFacts>& drawn, std::size_t parameter, double width) const;
  std::vector<Verdict> words_of(const std::vector<WordFacts>& drawn, double width_factor) const;
  double identified(const std::vector<Eigen::Index>& rows, double readings, Asked asked, Uncertain uncertain,
                    OthersEnds ends = OthersEnds::open) const;

  const ExtendedCase& extended_;
  const Outlook& outlook_;
  VerdictThresholds thresholds_;
  std::uint64_t seed_;
  std::vector<Profile> profiles_;  ///< profiles as found, but with nothing pinned
  std::vector<FoundFacts> found_;
  std::vector<std::vector<PathPoint>> paths_, paths_of_exact_;  ///< per parameter; with the surrogate taken as exact
  Eigen::VectorXd data_;
};

}  // namespace uq::plan
