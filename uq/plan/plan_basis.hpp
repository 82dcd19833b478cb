#pragma once
// The basis of a plan for one case: draws of its posterior or prior, the candidates, and the law of every reading that
// they could give.
#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data/plan.hpp"
#include "data/study.hpp"
#include "uq/plan/candidates.hpp"
#include "uq/plan/extended_case.hpp"
#include "uq/plan/forecast.hpp"
#include "uq/plan/information.hpp"
#include "uq/plan/outlook.hpp"
#include "uq/plan/plan.hpp"

namespace uq::plan {

constexpr double least_information = 0.02;  // nats: a width narrower by two per cent

/// Whether a reading is expected to teach about parameter k, by more than the expectation's error.
bool teaches(const PlanCandidate& candidate, std::size_t k);

struct PlanBasis {
  PlanBasis(const data::Study& of_study, const std::vector<Emulator>& emulators, std::size_t case_index,
            const SampledCase& sampled_case, const data::PlanSection& section, const PlanOptions& how);
  PlanBasis(const PlanBasis&) = delete;  // the forecast refers to its neighbours
  PlanBasis& operator=(const PlanBasis&) = delete;

  std::string name_of(int parameter) const;
  const data::Unit& unit_of(int parameter) const;
  /// The information expected from the rows; before a measurement it is the mean over several scramblings of the
  /// prior's draws.
  Information information_of(const std::vector<Eigen::Index>& rows) const;
  /// Posterior sd of a parameter before the reading, in the study's unit.
  double sd_now(int parameter) const;
  /// What an expectation is worth to the question, nats: the information about the parameter asked for, or, `by_width`,
  /// log (sd now / sd after).
  double worth(double information, double sd_now, double sd_after) const;
  void tell(double share) const;  ///< reports progress

  const data::Study& study;
  const SampledCase& sampled;
  const PlanOptions& options;
  Eigen::MatrixXd draws;                ///< draws of the posterior, in u
  Eigen::VectorXd centre;               ///< in u: the best fit, or the prior's means
  std::optional<Identification> found;  ///< none before a measurement
  bool stated = false;                  ///< somebody stated the parameter to learn of
  int about = 0;                        ///< the parameter asked for; where none is stated the one that is known least
  /// The parameter has separate values, and something parts them. A reading may narrow each value and leave both open,
  /// which is information; only what parts them takes down the width over all.
  bool by_width = false;
  std::vector<Candidate> candidates;
  ExtendedCase extended;
  std::vector<Outlook> outlooks;       ///< one, or one for each scrambling of the prior's draws
  std::vector<Eigen::MatrixXd> noise;  ///< noise of each outlook's readings; none: the information draws its own
  std::vector<std::uint64_t> seeds;    ///< of each outlook, for that
  std::optional<Forecast> forecast;    ///< none before a measurement

 private:
  void look_out();
};

}  // namespace uq::plan
