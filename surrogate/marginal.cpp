#include "surrogate/marginal.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/log_sum.hpp"

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double none = -std::numeric_limits<double>::infinity();

/// Multivariate Student's t with 5 degrees of freedom.
class StudentT {
 public:
  StudentT(VectorXd centre, const MatrixXd& covariance)
      : centre_(std::move(centre)), factor_(covariance.llt().matrixL()) {
    const double m = static_cast<double>(centre_.size());
    constant_ = gsl_sf_lngamma(0.5 * (degrees + m)) - gsl_sf_lngamma(0.5 * degrees) -
                0.5 * m * std::log(degrees * std::numbers::pi) - factor_.diagonal().array().log().sum();
  }
  /// A draw made from a point of the unit cube, which has one coordinate more than u.
  VectorXd draw(const VectorXd& cube) const {
    const Index m = centre_.size();
    VectorXd normal(m);
    for (Index j = 0; j < m; ++j) normal[j] = gsl_cdf_ugaussian_Pinv(cube[j]);
    return centre_ + factor_ * normal * std::sqrt(degrees / gsl_cdf_chisq_Pinv(cube[m], degrees));
  }
  double log_density(const VectorXd& u) const {
    const VectorXd deviation = factor_.triangularView<Eigen::Lower>().solve(u - centre_);
    return constant_ - 0.5 * (degrees + static_cast<double>(u.size())) * std::log1p(deviation.squaredNorm() / degrees);
  }

 private:
  static constexpr double degrees = 5.0;
  VectorXd centre_;
  MatrixXd factor_;
  double constant_ = 0.0;
};

/// The prior cut to the box, one independent component per hyper-parameter.
class BoxedPrior {
 public:
  explicit BoxedPrior(const HyperPosterior& posterior) : posterior_(posterior) {}
  VectorXd draw(const VectorXd& cube) const {
    VectorXd u(posterior_.low.size());
    for (Index j = 0; j < u.size(); ++j) {
      const auto [below, above] = tails(j);
      const double t = below + cube[j] * (above - below);
      u[j] = posterior_.prior_precision[j] > 0.0
                 ? posterior_.prior_mean[j] + gsl_cdf_ugaussian_Pinv(t) / std::sqrt(posterior_.prior_precision[j])
                 : t;
      u[j] = std::clamp(u[j], posterior_.low[j], posterior_.high[j]);
    }
    return u;
  }
  double log_density(const VectorXd& u) const {
    double value = 0.0;
    for (Index j = 0; j < u.size(); ++j) {
      const auto [below, above] = tails(j);
      value -= std::log(above - below);
      const double precision = posterior_.prior_precision[j], deviation = u[j] - posterior_.prior_mean[j];
      if (precision > 0.0)
        value += 0.5 * std::log(precision / (2.0 * std::numbers::pi)) - 0.5 * precision * deviation * deviation;
    }
    return value;
  }

 private:
  /// The box's ends in the prior's probability (flat prior: themselves).
  std::pair<double, double> tails(Index j) const {
    const double precision = posterior_.prior_precision[j], mean = posterior_.prior_mean[j];
    if (!(precision > 0.0)) return {posterior_.low[j], posterior_.high[j]};
    return {gsl_cdf_ugaussian_P((posterior_.low[j] - mean) * std::sqrt(precision)),
            gsl_cdf_ugaussian_P((posterior_.high[j] - mean) * std::sqrt(precision))};
  }
  const HyperPosterior& posterior_;
};

struct Draws {
  MatrixXd u;           // one column per draw
  VectorXd log_target;  // -infinity outside the box
  VectorXd log_weight;
};

/// Weighted mean and covariance, the latter never narrower than a hundredth in any direction.
StudentT adapted(const Draws& draws) {
  const VectorXd weight = (draws.log_weight.array() - log_sum(draws.log_weight)).exp();
  const VectorXd mean = draws.u * weight;
  const MatrixXd deviation = draws.u.colwise() - mean;
  MatrixXd covariance = deviation * weight.asDiagonal() * deviation.transpose();
  covariance.diagonal().array() += 1e-4;
  return {mean, covariance};
}

Draws sample(const HyperPosterior& posterior, const IntegrationOptions& options) {
  const Index m = posterior.mode.size();
  const Index total = Index{options.draws} * options.stages;
  const BoxedPrior prior(posterior);
  std::vector<StudentT> proposals{{posterior.mode, posterior.covariance}};
  VectorXd share = VectorXd::Zero(options.stages + 1);  // draws from each proposal, the prior last
  Draws draws{MatrixXd(m, 0), VectorXd(0), VectorXd(0)};
  for (int stage = 0; stage < options.stages; ++stage) {
    if (stage > 0) proposals.push_back(adapted(draws));
    const MatrixXd cube = scrambled_sobol(options.draws, std::min<int>(static_cast<int>(m) + 1, sobol_max_dimension),
                                          options.seed + 7919 * (static_cast<std::uint64_t>(stage) + 1));
    const Index before = draws.u.cols();
    draws.u.conservativeResize(m, before + options.draws);
    draws.log_target.conservativeResize(before + options.draws);
    for (Index i = 0; i < options.draws; ++i) {
      VectorXd point(m + 1);
      for (Index j = 0; j <= m; ++j) point[j] = cube(i, j % cube.cols());
      // Halves of the sequence are nets of their own. Every second point is none: in the second dimension those all lie
      // in the same half of the cube.
      const bool from_prior = stage == 0 && i >= options.draws / 2;
      const VectorXd u = from_prior ? prior.draw(point) : proposals.back().draw(point);
      share[from_prior ? options.stages : stage] += 1.0 / static_cast<double>(total);
      const bool inside = (u.array() >= posterior.low.array()).all() && (u.array() <= posterior.high.array()).all();
      draws.u.col(before + i) = u;
      draws.log_target[before + i] = inside ? posterior.log_density(u) : none;
    }
    draws.log_weight = VectorXd::Constant(draws.u.cols(), none);
    for (Index i = 0; i < draws.u.cols(); ++i) {
      if (!(draws.log_target[i] > none)) continue;  // nor where the density is not a number
      VectorXd density(stage + 2);
      for (int k = 0; k <= stage; ++k) density[k] = std::log(share[k]) + proposals[k].log_density(draws.u.col(i));
      density[stage + 1] = std::log(share[options.stages]) + prior.log_density(draws.u.col(i));
      draws.log_weight[i] = draws.log_target[i] - log_sum(density);
    }
    if (log_sum(draws.log_weight) == none) break;  // no draw has any density: the caller keeps the mode
  }
  return draws;
}

/// Coordinates by which draws are split into cells, one column per draw: u, then what predictions make of it.
struct Coordinates {
  MatrixXd all;
  Index hyper = 0;  ///< the rows that are u
};

/// `members`: the draws that count, the only ones whose predictions are made.
Coordinates coordinates_of(const HyperPosterior& posterior, const MatrixXd& u, const VectorXd& weight,
                           const std::vector<Index>& members) {
  if (!posterior.predict) return {u, u.rows()};
  std::vector<MarginalPrediction> found;
  for (const Index i : members) found.push_back(posterior.predict(u.col(i)));
  const Index points = found.front().mean.size();
  VectorXd first = VectorXd::Zero(points), second = first;
  for (std::size_t k = 0; k < members.size(); ++k) {
    first += weight[members[k]] * found[k].mean;
    second += weight[members[k]] * (found[k].variance + found[k].mean.cwiseAbs2());
  }
  const VectorXd variance = (second - first.cwiseAbs2()).cwiseMax(1e-300);
  Coordinates result{MatrixXd::Zero(u.rows() + 2 * points, u.cols()), u.rows()};
  result.all.topRows(u.rows()) = u;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const VectorXd off = found[k].mean - first;
    result.all.col(members[k]).segment(u.rows(), points) = off.cwiseQuotient(variance.cwiseSqrt());
    result.all.col(members[k]).tail(points) = (found[k].variance + off.cwiseAbs2()).cwiseQuotient(variance);
  }
  return result;
}

/// Draws that one node will stand for.
struct Cell {
  std::vector<Index> members;
  double weight = 0.0, score = 0.0, centre = 0.0;
  Index direction = 0;
};

Cell make_cell(std::vector<Index> members, const Coordinates& coordinates, const VectorXd& weight) {
  const MatrixXd& x = coordinates.all;
  Cell cell;
  VectorXd first = VectorXd::Zero(x.rows()), second = first;
  for (const Index i : members) {
    cell.weight += weight[i];
    first += weight[i] * x.col(i);
    second += weight[i] * x.col(i).cwiseAbs2();
  }
  const VectorXd mean = first / cell.weight;
  VectorXd score = cell.weight * (second / cell.weight - mean.cwiseAbs2());
  score.tail(x.rows() - coordinates.hyper) *= cell.weight;
  cell.score = members.size() > 1 ? score.maxCoeff(&cell.direction) : 0.0;
  cell.centre = mean[cell.direction];
  cell.members = std::move(members);
  return cell;
}

}  // namespace

std::vector<HyperNode> integration_nodes(const HyperPosterior& posterior, const IntegrationOptions& options) {
  const Draws draws = sample(posterior, options);
  const double total = log_sum(draws.log_weight);
  if (total == none) return {{posterior.mode, 1.0}};
  const VectorXd weight = (draws.log_weight.array() - total).exp();
  std::vector<Index> all;
  for (Index i = 0; i < weight.size(); ++i)
    if (weight[i] > 1e-12) all.push_back(i);
  const Coordinates coordinates = coordinates_of(posterior, draws.u, weight, all);
  std::vector<Cell> cells{make_cell(std::move(all), coordinates, weight)};
  while (static_cast<int>(cells.size()) < options.nodes) {
    const auto widest =
        std::max_element(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.score < b.score; });
    if (!(widest->score > 1e-10)) break;
    std::vector<Index> below, above;
    for (const Index i : widest->members)
      (coordinates.all(widest->direction, i) < widest->centre ? below : above).push_back(i);
    if (below.empty() || above.empty()) break;  // equal to rounding
    *widest = make_cell(std::move(below), coordinates, weight);
    cells.push_back(make_cell(std::move(above), coordinates, weight));
  }
  data::RandomStream random(options.seed, data::Purpose::optimiser_starts, 2);
  std::vector<HyperNode> nodes{{posterior.mode, 0.0}};
  double kept = 0.0;
  for (const Cell& cell : cells) {
    double left = random.uniform() * cell.weight;
    Index chosen = cell.members.back();
    for (const Index i : cell.members)
      if ((left -= weight[i]) < 0.0) {
        chosen = i;
        break;
      }
    nodes.push_back({draws.u.col(chosen), cell.weight});
    kept += cell.weight;
  }
  for (HyperNode& node : nodes) node.weight /= kept;
  return nodes;
}

HyperPosterior hyper_posterior(const Objective& objective, const VectorXd& mode) {
  const Index m = mode.size();
  HyperPosterior posterior;
  posterior.log_density = [&objective](const VectorXd& u) { return evaluate_value(objective, u); };
  posterior.low = objective.low;
  posterior.high = objective.high;
  posterior.prior_mean = objective.prior_mean;
  posterior.prior_precision = objective.prior_precision;
  posterior.mode = mode;
  // A direction that data and priors leave flatter than a factor of e^4 counts as e^4 wide.
  MatrixXd information = evaluate(objective, mode).information;
  information.diagonal().array() += 1.0 / 16.0;
  posterior.covariance = information.llt().solve(MatrixXd::Identity(m, m));
  return posterior;
}

IntegrationOptions integration_options(Index points, std::uint64_t seed) {
  IntegrationOptions options{.seed = seed};
  if (points > 128) options.draws = 256;
  if (points > 512) options = {.draws = 64, .stages = 2, .nodes = 6, .seed = seed};
  return options;
}

}  // namespace surrogate
