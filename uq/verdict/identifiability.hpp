#pragma once
// The way from draws to verdicts: what a case's posterior and likelihood say of each of its parameters.
//   profiles and influence (profile.hpp, influence.hpp) -> facts -> words (verdict.hpp)
//   -> what is traded (traded.hpp), why (structure.hpp), how sure (repeats.hpp) -> sentences (verdict_words.hpp)
#include <Eigen/Dense>
#include <vector>

#include "uq/findings/case_results.hpp"
#include "uq/infer/draws.hpp"
#include "uq/infer/optimise.hpp"
#include "uq/posterior/case_model.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/verdict/modes.hpp"
#include "uq/verdict/profile.hpp"
#include "uq/verdict/repeats.hpp"
#include "uq/verdict/verdict.hpp"
#include "uq/verdict/verdict_words.hpp"

namespace uq {

struct IdentifyOptions {
  VerdictThresholds thresholds = {};
  int even_points = 17;                       ///< points of a profile, over the support
  int near_points = 16;                       ///< points of a profile, where the draws lie
  RepeatOptions repeats = {};                 ///< repeats of the data, for the words' probabilities
  std::vector<std::string> unsupported = {};  ///< per own parameter (ParameterEvidence); empty: all are supported
};

struct Identification {
  std::vector<ParameterReport> parameters;  ///< the case's own, in its order; all but the chains' diagnostics filled
  std::vector<Profile> profiles;            ///< profiles of these parameters
  std::vector<WordFacts> facts;             ///< facts that decided these parameters' words
  std::vector<Influence> influence;         ///< influence of all unknowns
  Maximum best_fit;                         ///< point of largest likelihood
  FisherSpectrum fisher;                    ///< at the best fit
  FitCheck check;
  bool fits = true;
  std::vector<TradedPair> traded;
  std::vector<Mode> modes;                ///< one where the posterior is in one piece
  std::vector<std::string> unvisited;     ///< values that should have draws and have none
  double surrogate_to_measurement = 0.0;  ///< sd of surrogate over sd of measurement at the best fit, median over rows
};

/// `draws`: rows in u, from the posterior of `model`.
Identification identify(const CaseModel& model, const Eigen::MatrixXd& draws, const IdentifyOptions& options = {});

/// The case's verdicts in one finding, what follows from it, and what to do. `parted_by`: what would part its modes.
Words summarise(const Identification& found, const std::string& parted_by = {}, bool own_engine = true);

}  // namespace uq
