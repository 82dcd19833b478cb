#include "uq/posterior/unused_data.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data/random.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/infer/factor.hpp"
#include "uq/posterior/more_data.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/posterior/support.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index draws_used = 400;
constexpr Index drawn_each = 25;        // data of each law, for the tail of chi-squared
constexpr double numbers_most = 4.0e6;  // of all these data

/// The rows' laws, one a draw.
struct PredictiveLaws {
  MatrixXd mean, sd;  ///< draws x rows, SI
  VectorXd centre;
  MatrixXd covariance;
  MatrixXd data;  ///< drawn from it x rows, SI
};

PredictiveLaws mixture_of(const CaseModel& model, const MatrixXd& draws, const std::vector<Index>& wanted,
                          const std::vector<Index>& measured, data::RandomStream random) {
  const auto rows = static_cast<Index>(wanted.size());
  const double numbers = static_cast<double>(draws.rows() * std::max<Index>(rows, 1));
  const Index each = std::clamp<Index>(static_cast<Index>(numbers_most / numbers), 1, drawn_each);
  PredictiveLaws all{MatrixXd(draws.rows(), rows), MatrixXd(draws.rows(), rows), VectorXd::Zero(rows),
                     MatrixXd::Zero(rows, rows), MatrixXd(draws.rows() * each, rows)};
  const VectorXd y = observed(model);
  for (Index i = 0; i < draws.rows(); ++i) {
    const ReadingLaw law = reading_law(predict(model, draws.row(i).transpose()), y, wanted, measured);
    const MatrixXd total = law.total();
    all.mean.row(i) = law.mean.transpose();
    all.sd.row(i) = total.diagonal().cwiseMax(0.0).cwiseSqrt().transpose();
    all.covariance += total / static_cast<double>(draws.rows());
    MatrixXd normal(each, rows);
    for (double& value : normal.reshaped()) value = random.normal();
    all.data.middleRows(i * each, each) =
        (normal * semidefinite_root(total, "data of a prediction").transpose()).rowwise() + law.mean.transpose();
  }
  all.centre = all.mean.colwise().mean().transpose();
  const MatrixXd apart = all.mean.rowwise() - all.centre.transpose();
  all.covariance += apart.transpose() * apart / static_cast<double>(draws.rows());
  return all;
}

/// The chance of data at least as far off; below what the drawn data resolve, of normal ones.
double tail_of(const PredictiveLaws& all, double chi2) {
  const Eigen::LDLT<MatrixXd> factor(all.covariance);
  const MatrixXd away = (all.data.rowwise() - all.centre.transpose()).transpose();
  const Eigen::ArrayXd drawn = away.cwiseProduct(factor.solve(away)).colwise().sum().transpose().array();
  const auto count = static_cast<double>(drawn.size()), farther = static_cast<double>((drawn >= chi2).count());
  if (farther > 0.0) return farther / count;
  return std::min(1.0 / count, gsl_cdf_chisq_Q(chi2, static_cast<double>(away.rows())));
}

/// Quantile of a row by bisection of the mixture's distribution function.
double quantile_of(const PredictiveLaws& all, Index row, double probability) {
  double low = (all.mean.col(row) - 8.0 * all.sd.col(row)).minCoeff();
  double high = (all.mean.col(row) + 8.0 * all.sd.col(row)).maxCoeff();
  for (int step = 0; step < 100 && high - low > 1e-12 * (std::abs(low) + std::abs(high)); ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (Index i = 0; i < all.mean.rows(); ++i) {
      const double away = middle - all.mean(i, row);
      below += all.sd(i, row) > 0.0 ? gsl_cdf_ugaussian_P(away / all.sd(i, row)) : (away >= 0.0 ? 1.0 : 0.0);
    }
    (below < probability * static_cast<double>(all.mean.rows()) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::string sentence_of(const PredictionReport& report) {
  const std::size_t n = report.points.size();
  std::string text = fmt::format(
      "{}: {} of {} measured values that the case has not used lie inside their 90 % intervals; chi-squared {:.3g} of "
      "{} (p {:.2g}). The calibration {} them.",
      report.name, report.inside, n, report.chi2, n, report.p, report.predicts ? "predicts" : "does not predict");
  if (report.unsupported > 0)
    text +=
        fmt::format(" No run speaks at {} of them, where this is the surrogate's extrapolation.", report.unsupported);
  if (report.predicts || n == 0) return text;
  const auto farthest =
      std::max_element(report.points.begin(), report.points.end(),
                       [](const PredictedPoint& a, const PredictedPoint& b) { return std::abs(a.z) < std::abs(b.z); });
  const PredictivePoint& point = farthest->point;
  std::string at;
  for (const auto& [name, value] : point.controls)
    at += fmt::format("{}{} {:.4g}", at.empty() ? " at " : ", ", name, value);
  return text + fmt::format(" Farthest off is {}{}, by {:.2g} standard deviations.", point.output, at, farthest->z);
}

}  // namespace

PredictionReport predict_unused(const data::Study& study, const std::vector<Emulator>& emulators,
                                const data::UnusedData& wanted, const CaseModel& sampled, const MatrixXd& draws) {
  data::Study wider = study;
  for (data::ObservationSet& set : wider.observations)
    if (std::find(wanted.observe.begin(), wanted.observe.end(), set.name) == wanted.observe.end())
      condense(set, study.cases.at(wanted.case_index));
  auto& observe = wider.cases.at(wanted.case_index).observe;
  observe.insert(observe.end(), wanted.observe.begin(), wanted.observe.end());
  const CaseModel model = with_more_data(wider, emulators, wanted.case_index, sampled);

  std::set<std::size_t> unused;
  for (const std::string& name : wanted.observe) unused.insert(*study.observation_index(name));
  const std::vector<RowOrigin> from = origins(model);
  std::vector<Index> rows, measured;
  for (std::size_t row = 0; row < from.size(); ++row)
    (unused.count(from[row].set) > 0 ? rows : measured).push_back(static_cast<Index>(row));

  const PredictiveLaws all = mixture_of(model, thinned(draws, draws_used), rows, measured,
                                        data::RandomStream(study.seed, data::Purpose::unused_data));
  const VectorXd away = observed(model)(rows) - all.centre;
  PredictionReport report{.name = wanted.name, .observed_sets = wanted.observe, .points = {}, .sentence = {}};
  for (Index i = 0; i < away.size(); ++i) {
    PredictivePoint point = observed_point(wider, from[static_cast<std::size_t>(rows[i])]);
    const data::Unit& unit = wider.outputs[from[static_cast<std::size_t>(rows[i])].output].unit;
    point.mean = unit.from_si(all.centre[i]);
    point.q05 = unit.from_si(quantile_of(all, i, 0.05));
    point.q95 = unit.from_si(quantile_of(all, i, 0.95));
    report.inside += point.observed >= point.q05 && point.observed <= point.q95 ? 1 : 0;
    report.points.push_back({.point = std::move(point), .z = away[i] / std::sqrt(all.covariance(i, i))});
  }
  report.chi2 = away.dot(all.covariance.ldlt().solve(away));
  report.p = away.size() > 0 ? tail_of(all, report.chi2) : 1.0;
  report.predicts = report.p >= VerdictThresholds{}.predictive_p;
  report.unsupported =
      static_cast<int>((unsupported_at(model, rows, draws).array() > SupportThresholds{}.share).count());
  report.sentence = sentence_of(report);
  return report;
}

}  // namespace uq
