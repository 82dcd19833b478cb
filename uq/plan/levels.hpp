#pragma once
// Outputs of enlarged grains, compared between two levels of coarse graining of one powder.
//
// An output of enlarged grains need not mean the same in the real powder, and a candidate that reads it is "model only".
// Where the runs have the same powder at another enlargement, the output can be asked of both surrogates, m and m', at the
// parameters that the case leaves. With e the error of a reading, v and v' the surrogates' variances, the levels differ by
//   d = sqrt(mean over draws of (m - m')^2 + v + v') / e
// at a setting. Up to 1 no reading could tell the levels apart, and the candidate counts like any other. The surrogates'
// variances are counted in: what they do not know well enough is no agreement. That two enlargements agree is
// evidence for the grains' own size, and no proof.
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/emulator.hpp"
#include "uq/plan/candidates.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq::plan {

/// Writes `level_difference` into candidates that are the model's alone, d at the worst of their readings and the best of
/// the other levels, and takes that mark from those where it is at most 1. A level whose runs do not have the output, do not
/// reach the settings or vary other parameters is not compared. `draws`: rows in u; `u`: where errors in per cent are taken.
void compare_levels(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const CandidateOptions& options, const Eigen::MatrixXd& draws,
                    const Eigen::VectorXd& u, std::vector<Candidate>& candidates);

}  // namespace uq::plan
