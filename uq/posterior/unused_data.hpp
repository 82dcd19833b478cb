#pragma once
// Data that a case has not used, beside what it predicts of them: the check that a calibration can fail.
//
// For each draw u of the posterior the unused rows have the normal law given u and the data that were used
// (uq/posterior/more_data.hpp). Over the draws it is a mixture of normal laws: its quantiles are the intervals, its
// mean m and covariance V give z = (y - m) / sqrt(V_ii) and, of all rows together, chi-squared = (y - m)' V^-1 (y - m).
// Its tail is that of data drawn from the mixture: where the draws differ in the size of the errors (an unknown noise),
// the mixture has longer tails than a normal law, and the chi-squared law calls good predictions bad seven times too
// often.
#include <Eigen/Dense>

#include "data/study.hpp"
#include "uq/findings/prediction_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Predicts the unused data. `draws`: rows in u, of the sampled case. Throws data::InputError where the rows lie
/// outside the runs.
PredictionReport predict_unused(const data::Study& study, const std::vector<Emulator>& emulators,
                                const data::UnusedData& wanted, const CaseModel& sampled, const Eigen::MatrixXd& draws);

}  // namespace uq
