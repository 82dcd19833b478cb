#pragma once
// Data that a case has not used, beside what it predicts of them: the check that a calibration can fail.
//
// For each draw u of the posterior the unused rows have the normal law given u and the data that were used
// (uq/posterior/more_data.hpp). Over the draws it is a mixture of normal laws: its quantiles are the intervals, its mean m and
// covariance V give z = (y - m) / sqrt(V_ii) and, of all rows together, chi-squared = (y - m)' V^-1 (y - m) with as many
// degrees of freedom as rows.
#include <Eigen/Dense>

#include "data/study.hpp"
#include "uq/findings/results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// `draws`: rows in u, of the sampled case. Throws data::InputError where the rows lie outside the runs.
PredictionReport predict_unused(const data::Study& study, const std::vector<Emulator>& emulators,
                                const data::UnusedData& wanted, const CaseModel& sampled, const Eigen::MatrixXd& draws);

}  // namespace uq
