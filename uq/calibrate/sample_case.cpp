// Sampling of a resolved case, by the sampler that the case asks for.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/calibrate/calibrate.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/posterior/prior_reach.hpp"
#include "uq/posterior/support.hpp"

namespace uq {
namespace {

/// Index of the unknown of this name in another case's model.
int unknown_of(const CaseModel& model, const std::string& name) {
  for (int k = 0; k < model.dimension(); ++k)
    if (model.unknowns[k].label == name) return k;
  return -1;
}

/// The sampled case whose posterior an unknown has.
const SampledCase& source_of(const SampledCase& sampled, const Unknown& unknown) {
  const auto found = std::find_if(sampled.cut_sources.begin(), sampled.cut_sources.end(),
                                  [&](const auto& source) { return source->model->name == unknown.cut_from; });
  return **found;
}

/// Draws of the cut unknowns, chain by chain, as their sources gave them.
GivenDraws given_draws(const SampledCase& sampled) {
  GivenDraws given;
  const CaseModel& model = *sampled.model;
  for (int k = 0; k < model.dimension(); ++k)
    if (!model.unknowns[k].cut_from.empty()) given.unknowns.push_back(k);
  for (const int k : given.unknowns) {
    const Unknown& unknown = model.unknowns[k];
    const SampledCase& source = source_of(sampled, unknown);
    const Eigen::MatrixXd column = source.draws.coordinate(unknown_of(*source.model, unknown.label));
    const Eigen::Index rows =
        given.chains.empty() ? column.rows() : std::min(column.rows(), given.chains.front().rows());
    given.chains.resize(static_cast<std::size_t>(column.cols()), Eigen::MatrixXd(rows, 0));
    for (std::size_t c = 0; c < given.chains.size(); ++c) {
      given.chains[c].conservativeResize(rows, given.chains[c].cols() + 1);
      given.chains[c].rightCols(1) = column.col(c).head(rows);
    }
  }
  return given;
}

}  // namespace

std::uint64_t seed_of(const data::Study& study, const CalibrateOptions& options) {
  return options.seed.value_or(study.seed);
}

Draws sample_model(const data::Study& study, const SampledCase& sampled, const std::shared_ptr<const CaseModel>& model,
                   const CalibrateOptions& options, std::optional<int> draws) {
  const Target target = posterior_target(model);
  const std::uint64_t seed = seed_of(study, options);
  if (!sampled.cut_sources.empty()) {
    CutOptions cut = options.cut;
    cut.seed = seed;
    cut.threads = options.threads;
    return sample_cut(target, given_draws(sampled), cut);
  }
  if (sampled.sampler == data::Sampler::nuts) {
    NutsOptions nuts = options.nuts;
    nuts.seed = seed;
    nuts.threads = options.threads;
    nuts.draws = draws.value_or(nuts.draws);
    if (options.sampling_progress) nuts.progress = options.sampling_progress;
    return sample_nuts(target, nuts);
  }
  MixtureSamplerOptions mixture = options.mixture;
  mixture.seed = seed;
  mixture.threads = options.threads;
  mixture.draws = draws.value_or(mixture.draws);
  if (options.sampling_progress) mixture.progress = options.sampling_progress;
  return sample_mixture(target, mixture);
}

SampledCase sample_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                        const CalibrateOptions& options) {
  const data::CalibrationCase& item = study.cases.at(case_index);
  SampledCase sampled{.model = nullptr, .draws = {}, .sampler = options.sampler.value_or(item.sampler)};
  CaseModel model = build_case(study, emulators, case_index);
  for (Unknown& unknown : model.unknowns) {
    if (unknown.cut_from.empty()) continue;
    const auto known = std::find_if(sampled.cut_sources.begin(), sampled.cut_sources.end(),
                                    [&](const auto& source) { return source->model->name == unknown.cut_from; });
    if (known == sampled.cut_sources.end()) {
      const std::size_t from = study.case_index(unknown.cut_from).value();
      sampled.cut_sources.push_back(std::make_shared<const SampledCase>(sample_case(study, emulators, from, options)));
    }
    const SampledCase& source = source_of(sampled, unknown);
    if (source.draws.chains.empty()) {
      sampled.model = std::make_shared<const CaseModel>(std::move(model));
      sampled.draws.reason = fmt::format("case '{}', whose posterior it takes, has no draws", source.model->name);
      return sampled;
    }
    const Eigen::VectorXd u = source.draws.pooled().col(unknown_of(*source.model, unknown.label));
    unknown.cut = cut_law(u, seed_of(study, options));
  }
  if (model.distinct) pool_rows(model);  // its pooled rows have the same unknowns
  sampled.model = std::make_shared<const CaseModel>(std::move(model));
  refuse_excluding_priors(study, *sampled.model);
  // Each case draws its own numbers.
  CalibrateOptions own = options;
  own.seed =
      data::child_seed(seed_of(study, options), data::Purpose::case_seed, static_cast<std::uint32_t>(case_index));
  sampled.draws = sample_model(study, sampled, sampled.model, own);
  if (!sampled.draws.chains.empty()) sampled.support = find_support(study, *sampled.model, sampled.draws.pooled());
  return sampled;
}

}  // namespace uq
