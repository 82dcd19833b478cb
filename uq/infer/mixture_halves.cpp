#include "uq/infer/mixture_halves.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "uq/infer/diagnostics.hpp"
#include "uq/infer/parallel.hpp"

namespace uq {
namespace {

using data::Purpose;
using data::RandomStream;

/// Draws of the proposals where the density is more than they expect: the skirts of a spike inside a wide mode, which
/// no draw of the reference would hit.
Eigen::MatrixXd surprises(const Target& target, std::vector<Half>& halves, const MixtureSamplerOptions& options,
                          int draws) {
  constexpr int each = 8;
  std::vector<Eigen::MatrixXd> found(halves.size());
  for_each_index(static_cast<int>(halves.size()), options.threads, [&](int h) {
    Half& half = halves[h];
    const Proposals made = propose(target, half.proposal.best, draws, half.random);
    half.proposal.evaluations += draws;
    const Eigen::VectorXd surprise = (made.log_density - made.log_proposal).array() - half.proposal.log_evidence;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(draws));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::partial_sort(order.begin(), order.begin() + each, order.end(),
                      [&](Eigen::Index a, Eigen::Index b) { return surprise[a] > surprise[b]; });
    order.resize(each);
    std::erase_if(order, [&](Eigen::Index i) { return !(surprise[i] > std::log(3.0)); });
    found[h] = made.x(order, Eigen::all);
  });
  Eigen::Index rows = 0;
  for (const auto& part : found) rows += part.rows();
  Eigen::MatrixXd all(rows, target.dimension);
  rows = 0;
  for (const auto& part : found) {
    all.middleRows(rows, part.rows()) = part;
    rows += part.rows();
  }
  return all;
}

}  // namespace

std::vector<Half> make_halves(const std::vector<Population>& populations, const MixtureSamplerOptions& options) {
  const std::size_t chains = populations.size(), count = chains >= 4 ? 2 : 1;
  const Eigen::Index size = populations.front().x.rows();
  std::vector<Half> halves;
  for (std::size_t h = 0; h < count; ++h) {
    Half half{.chains = {},
              .random = RandomStream(options.seed, Purpose::proposal, static_cast<std::uint32_t>(h)),
              .archive = {},
              .proposal = {}};
    for (std::size_t c = h * chains / count; c < (h + 1) * chains / count; ++c) half.chains.push_back(c);
    half.archive.resize(size * static_cast<Eigen::Index>(half.chains.size()), populations.front().x.cols());
    for (std::size_t i = 0; i < half.chains.size(); ++i)
      half.archive.middleRows(static_cast<Eigen::Index>(i) * size, size) = populations[half.chains[i]].x;
    halves.push_back(std::move(half));
  }
  return halves;
}

void begin_halves(const Target& target, const Scouts& scouts, std::vector<Half>& halves,
                  const MixtureSamplerOptions& options) {
  const Eigen::Index share = scouts.x.rows() / options.chains;
  for_each_index(static_cast<int>(halves.size()), options.threads, [&](int h) {
    Half& half = halves[h];
    const Eigen::Index first = static_cast<Eigen::Index>(half.chains.front()) * share,
                       count = static_cast<Eigen::Index>(half.chains.size()) * share;
    Proposals sent{.x = scouts.x.middleRows(first, count),
                   .log_density = scouts.log_density.segment(first, count),
                   .log_proposal = Eigen::VectorXd(count),
                   .tries = static_cast<double>(count)};
    for (Eigen::Index i = 0; i < count; ++i)
      sent.log_proposal[i] = target.reference.log_density(sent.x.row(i).transpose());
    half.proposal = begin_proposal(half.archive, sent, half.random, options.proposal);
  });
}

void adapt_halves(const Target& target, std::vector<Half>& halves, const MixtureSamplerOptions& options) {
  for_each_index(static_cast<int>(halves.size()), options.threads, [&](int h) {
    Half& half = halves[h];
    adapt(target, half.proposal, half.random, options.proposal);
  });
}

std::vector<LastMaximum> find_unknown(const Target& target, const Scouts& scouts, const Population& best,
                                      std::vector<Half>& halves, const MixtureSamplerOptions& options, Draws& result) {
  Eigen::Index highest = 0;
  best.log_density.maxCoeff(&highest);
  Origins origins{.through = best.x.row(highest).transpose()};
  const double log_bulk = quantile(best.log_density, 0.1);
  const int draws = static_cast<int>(scouts.x.rows()) / static_cast<int>(halves.size());
  for (int round = 0;; ++round) {
    Knowledge knowledge{.mixtures = {}, .log_levels = {}, .log_bulk = log_bulk};
    double log_evidence = nowhere;
    for (const Half& half : halves) {
      knowledge.mixtures.push_back(half.proposal.best);
      knowledge.log_levels.push_back(half.proposal.log_evidence + std::log(options.unknown_ratio));
      log_evidence = std::max(log_evidence, half.proposal.log_evidence);
    }
    origins.starts = surprises(target, halves, options, draws);
    const Search search = search_unknown(target, scouts, knowledge, origins, options.explore);
    result.evaluations += search.evaluations;
    result.searched_starts += search.starts;
    std::vector<Peak> matter;
    double share = 0.0;
    for (Peak mode : search.modes) {
      const auto mass_of = [&] { return std::exp(std::min(mode.log_mass - log_evidence, 50.0)); };
      if (mass_of() < options.unknown_mass) continue;
      mode.log_mass = log_unknown_mass(target, mode, knowledge, result.evaluations);
      const double mass = mass_of();
      if (mass < options.unknown_mass) continue;
      matter.push_back(mode);
      share += mass;
    }
    if (matter.empty()) return {};
    result.found_modes += static_cast<int>(matter.size());
    for (Half& half : halves) add_modes(half.proposal, matter, std::clamp(share / (1.0 + share), 0.2, 0.7));
    adapt_halves(target, halves, options);
    if (round == options.search_rounds) {
      std::vector<LastMaximum> last;
      for (const Peak& mode : matter)
        last.push_back(
            {mode, std::exp(std::min(log_mass_near(target, mode, result.evaluations) - log_evidence, 50.0))});
      return last;
    }
    const auto top = std::max_element(matter.begin(), matter.end(),
                                      [](const Peak& a, const Peak& b) { return a.log_mass < b.log_mass; });
    origins.through = top->x;
  }
}

}  // namespace uq
