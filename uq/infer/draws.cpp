#include "uq/infer/draws.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/infer/diagnostics.hpp"

namespace uq {

Eigen::MatrixXd Draws::coordinate(int k) const {
  Eigen::MatrixXd values(chains.front().x.rows(), static_cast<Eigen::Index>(chains.size()));
  for (std::size_t c = 0; c < chains.size(); ++c) values.col(c) = chains[c].x.col(k);
  return values;
}

Eigen::MatrixXd Draws::pooled() const {
  const Eigen::Index rows = chains.front().x.rows();
  Eigen::MatrixXd all(rows * static_cast<Eigen::Index>(chains.size()), dimension());
  for (std::size_t c = 0; c < chains.size(); ++c)
    all.middleRows(static_cast<Eigen::Index>(c) * rows, rows) = chains[c].x;
  return all;
}

Eigen::VectorXd Draws::pooled_log_density() const {
  const Eigen::Index rows = chains.front().x.rows();
  Eigen::VectorXd all(rows * static_cast<Eigen::Index>(chains.size()));
  for (std::size_t c = 0; c < chains.size(); ++c)
    all.segment(static_cast<Eigen::Index>(c) * rows, rows) = chains[c].log_density;
  return all;
}

void assess(Draws& draws, const StopRule& rule) {
  const int dimension = draws.dimension();
  const double chains = static_cast<double>(draws.chains.size());
  draws.rhat.resize(dimension);
  draws.ess_bulk.resize(dimension);
  draws.ess_tail.resize(dimension);
  draws.converged = true;
  draws.reason.clear();
  for (int k = 0; k < dimension; ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k);
    draws.rhat[k] = rank_rhat(values);
    draws.ess_bulk[k] = bulk_ess(values);
    draws.ess_tail[k] = tail_ess(values);
    const double bulk_wanted = std::max(rule.ess_bulk, rule.ess_per_chain * chains);
    const double tail_wanted = rule.ess_per_chain * chains;
    // Written so that NaN (a constant coordinate) counts as not converged.
    if (draws.rhat[k] < rule.rhat_max && draws.ess_bulk[k] >= bulk_wanted && draws.ess_tail[k] >= tail_wanted) continue;
    draws.converged = false;
    if (!draws.reason.empty()) continue;
    draws.reason = fmt::format(
        "coordinate {}: R-hat {:.4f} (wanted below {}), bulk ESS {:.0f} (wanted {:.0f}), tail ESS {:.0f} (wanted "
        "{:.0f})",
        k, draws.rhat[k], rule.rhat_max, draws.ess_bulk[k], bulk_wanted, draws.ess_tail[k], tail_wanted);
  }
}

}  // namespace uq
