#pragma once
// Outputs of enlarged grains, compared between two levels of coarse graining of one powder.
//
// An output of enlarged grains need not mean the same in the real powder, and a candidate that reads it is "model
// only". Where the runs have the same powder at another enlargement, the output can be asked of both surrogates, m and
// m', at the parameters that the case leaves. With e the reading's own error (without what its meter shares with other
// readings) and v and v' the surrogates' variances, the levels differ by d, known to w, both in errors of a reading:
//   d = sqrt(mean over draws of (m - m')^2) / e,    w = sqrt(mean over draws of v + v') / e
// at a setting. Where d^2 + w^2 is at most 1 no reading could tell the levels apart. The candidate counts like any
// other only where it agrees so with every other level. A level that the surrogates do not know well enough is no
// agreement.
// That enlargements agree is evidence for the grains' own size, and no proof.
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/emulator.hpp"
#include "uq/plan/candidates.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq::plan {

/// Writes `levels` into the candidates: for each other level d and w at the worst of their readings. Takes the mark
/// "model only" from candidates where all levels agree. An output that the case itself reads has no such mark; where
/// its levels differ, this is said. A level whose runs do not have the output, do not reach the settings or vary other
/// parameters is not compared, and is no agreement. `draws`: rows in u; `u`: where errors in per cent are taken.
void compare_levels(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const CandidateOptions& options, const Eigen::MatrixXd& draws,
                    const Eigen::VectorXd& u, std::vector<Candidate>& candidates);

}  // namespace uq::plan
