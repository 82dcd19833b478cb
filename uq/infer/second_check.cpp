#include "uq/infer/second_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/infer/diagnostics.hpp"

namespace uq {

std::string missed_maxima(const Target& target, Draws& draws, const SecondCheckOptions& options) {
  const Eigen::MatrixXd all = draws.pooled();
  const Eigen::VectorXd level = draws.pooled_log_density();
  const Eigen::Index count = std::min(options.fitted, all.rows());
  Eigen::MatrixXd kept(count, all.cols());
  Eigen::VectorXd log_density(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    kept.row(i) = all.row(i * all.rows() / count);
    log_density[i] = level[i * all.rows() / count];
  }
  data::RandomStream random(options.seed, data::Purpose::second_check);
  const Mixture mixture = fit_mixture(kept, Eigen::VectorXd::Ones(count), random);
  // At draws of p, log p - log q is about log Z.
  const double log_evidence = quantile(log_density - mixture.log_densities(kept), 0.5);
  const Scouts scouts = send_scouts(target, random, options.explore);
  Eigen::Index highest = 0;
  log_density.maxCoeff(&highest);
  const Knowledge knowledge{.mixtures = {mixture},
                            .log_levels = {log_evidence + std::log(options.ratio)},
                            .log_bulk = quantile(log_density, 0.1)};
  const Search search =
      search_unknown(target, scouts, knowledge, {.through = kept.row(highest).transpose()}, options.explore);
  draws.evaluations += search.evaluations + scouts.x.rows();
  draws.scouts = static_cast<int>(scouts.x.rows());
  draws.searched_starts += search.starts;
  for (Peak mode : search.modes) {
    if (mode.log_mass - log_evidence > std::log(options.mass))
      mode.log_mass = log_unknown_mass(target, mode, knowledge, draws.evaluations);
    const double mass = std::exp(std::min(mode.log_mass - log_evidence, 50.0)), share = mass / (1.0 + mass);
    const auto near = static_cast<double>(draws_near(mode, all));
    if (share < options.mass || near > 0.05 * share * static_cast<double>(all.rows())) continue;
    std::string where;
    for (const double x : mode.x) where += fmt::format("{}{:.4g}", where.empty() ? "" : ", ", x);
    return fmt::format(
        "a maximum at ({}) holds about {:.2g} % of the mass, and {:.0f} of {} draws are near it (sampler = \"mixture\" "
        "goes between separate modes)",
        where, 100.0 * share, near, all.rows());
  }
  return "";
}

}  // namespace uq
