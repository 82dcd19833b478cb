#pragma once
// What a case's posterior and likelihood say of each of its parameters: the way from draws to verdicts.
#include <Eigen/Dense>
#include <vector>

#include "uq/case_model.hpp"
#include "uq/draws.hpp"
#include "uq/fisher.hpp"
#include "uq/optimise.hpp"
#include "uq/predictive.hpp"
#include "uq/profile.hpp"
#include "uq/results.hpp"
#include "uq/verdict.hpp"

namespace uq {

struct IdentifyOptions {
  VerdictThresholds thresholds = {};
  ProfileOptions profile = {};
  std::vector<std::string> unsupported = {};  ///< per own parameter (ParameterEvidence); empty: all are supported
};

struct Identification {
  std::vector<ParameterReport> parameters;  ///< the case's own, in its order; all but the chains' diagnostics filled
  std::vector<Profile> profiles;            ///< of the same
  Maximum best_fit;                         ///< largest likelihood
  FisherSpectrum fisher;                    ///< at the best fit
  FitCheck check;
  bool fits = true;
  std::vector<TradedPair> traded;
  double surrogate_share = 0.0;  ///< median over rows: surrogate's sd over the measurement's, at the best fit
};

/// `draws`: rows in u, from the posterior of `model`.
Identification identify(const CaseModel& model, const Eigen::MatrixXd& draws, const IdentifyOptions& options = {});

/// The case's verdicts in one finding, what follows from it, and what to do.
struct Words {
  std::string finding, consequence, remedy;
};
Words summarise(const CaseModel& model, const Identification& found, const VerdictThresholds& thresholds);

}  // namespace uq
