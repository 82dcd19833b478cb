#include "uq/plan/outlook.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>

#include "surrogate/design.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/infer/parallel.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq::plan {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Outlook::Outlook(const ExtendedCase& extended, const MatrixXd& draws, Given given, int threads)
    : place_(static_cast<std::size_t>(extended.model.row_count()), -1) {
  const CaseModel& model = extended.model;
  std::vector<Index> planned;
  for (const auto& rows : extended.planned) planned.insert(planned.end(), rows.begin(), rows.end());
  std::sort(planned.begin(), planned.end());
  for (std::size_t i = 0; i < planned.size(); ++i) place_[planned[i]] = static_cast<Index>(i);
  const VectorXd y = observed(model);

  values_.resize(draws.rows(), model.own_count());
  for (Index i = 0; i < draws.rows(); ++i)
    for (Index k = 0; k < values_.cols(); ++k) {
      values_(i, k) = in_study_unit(model.unknowns[k].prior.parameter(), draws(i, k));
    }
  laws_.resize(static_cast<std::size_t>(draws.rows()));
  for_each_index(static_cast<int>(draws.rows()), threads, [&](int job) {
    const StackedPrediction all = predict(model, draws.row(job).transpose());
    ReadingLaw law = reading_law(all, y, planned, given == Given::data ? extended.measured : std::vector<Index>{});
    law.noise = extended.noise_at(all.mean, all.noise)(planned);
    laws_[job] = std::move(law);
  });
}

ReadingLaw Outlook::law(Index draw, const std::vector<Index>& rows) const {
  std::vector<Index> places;
  for (const Index row : rows) places.push_back(place_[row]);
  const ReadingLaw& all = laws_[draw];
  return {all.mean(places), all.shared(places, places), all.noise(places)};
}

Ensemble Outlook::ensemble(const std::vector<Index>& rows, double readings) const {
  Ensemble ensemble{.values = values_, .mean = MatrixXd(draws(), static_cast<Index>(rows.size())), .covariance = {}};
  for (Index i = 0; i < draws(); ++i) {
    ReadingLaw one = law(i, rows);
    ensemble.mean.row(i) = one.mean.transpose();
    one.shared.diagonal() += one.noise / readings;
    ensemble.covariance.push_back(std::move(one.shared));
  }
  return ensemble;
}

PriorDraws prior_draws(const CaseModel& model, int count, int readings, std::uint64_t seed) {
  const int unknowns = model.dimension();
  readings = std::clamp(surrogate::sobol_max_dimension - unknowns, 0, readings);
  const MatrixXd cube = surrogate::scrambled_sobol(count, unknowns + readings, seed);
  PriorDraws draws{MatrixXd(count, unknowns), MatrixXd(count, readings)};
  for (Index i = 0; i < count; ++i) {
    for (Index s = 0; s < unknowns; ++s) draws.u(i, s) = model.unknowns[s].prior.inverse_cdf(cube(i, s));
    for (Index r = 0; r < readings; ++r) draws.noise(i, r) = gsl_cdf_ugaussian_Pinv(cube(i, unknowns + r));
  }
  return draws;
}

}  // namespace uq::plan
