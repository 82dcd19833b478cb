// The end-to-end check: simulated runs of the default study, each left out of the surrogates in turn, as data. Do the
// intervals hold the friction and the Hamaker constant that the run had?
#include <catch2/catch.hpp>
#include <cmath>

#include "data/study_file.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/posterior.hpp"

using namespace uq;

namespace {

struct Count {
  int inside = 0, of = 0;
};

/// The place of a run in the study's unit cube.
Eigen::RowVectorXd place_of(const FittedSurrogate& fitted, Eigen::Index run) {
  Eigen::RowVectorXd place = fitted.rows.set.x.row(run);
  for (std::size_t k = 0; k < fitted.rows.inputs.size(); ++k) place[k] = study_place(fitted.rows.inputs[k], place[k]);
  return place;
}

/// The case of one run of a material: all its outputs at its speed, everything that its rows vary free.
CaseModel case_of_run(const data::Study& study, const std::vector<FittedSurrogate>& fitted, std::size_t run) {
  CaseModel model{.name = "held out", .unknowns = {}, .groups = {}, .linked = {}, .observed_sets = {}};
  for (const EmulatorInput& input : fitted.front().rows.inputs)
    if (input.kind == InputKind::parameter) {
      const data::Parameter& parameter = study.parameters[input.index];
      model.unknowns.push_back({.label = parameter.name, .prior = ScaledPrior(parameter, parameter.prior), .cut = {}});
    }
  const auto row = static_cast<Eigen::Index>(run);
  for (const FittedSurrogate& one : fitted) {
    // The same hyper-parameters, without the run.
    const surrogate::TrainingSet& all = one.rows.set;
    surrogate::TrainingSet rest{.x = Eigen::MatrixXd(all.x.rows() - 1, all.x.cols()),
                                .y = Eigen::VectorXd(all.x.rows() - 1),
                                .noise_variance = Eigen::VectorXd(all.x.rows() - 1)};
    for (Eigen::Index i = 0, at = 0; i < all.x.rows(); ++i) {
      if (i == row) continue;
      rest.x.row(at) = all.x.row(i);
      rest.y[at] = all.y[i];
      rest.noise_variance[at++] = all.noise_variance[i];
    }
    const surrogate::HyperParameters hyper = one.process->hyper_parameters();
    const auto process = std::make_shared<const surrogate::GaussianProcess>(
        surrogate::condition(rest, {.kernel = one.process->kernel(), .mean = one.process->mean()}, hyper));
    const auto& inputs = one.rows.inputs;
    RowGroup group{.emulator = make_emulator(process, one.rows.material, one.rows.output, inputs),
                   .base = place_of(one, row),
                   .unknown = Eigen::MatrixXi::Constant(1, all.x.cols(), -1),
                   .observed = all.y.segment(row, 1),
                   .variance = all.noise_variance.segment(row, 1),
                   .origin = {{0, 0, one.rows.output}},
                   .coordinate = {}};
    group.variance.array() += hyper.nugget_sd * hyper.nugget_sd;  // another seed would scatter so much more
    int unknown = 0;
    for (std::size_t k = 0; k < inputs.size(); ++k)
      if (inputs[k].kind == InputKind::parameter) group.unknown(0, k) = unknown++;
    find_coordinates(group, model.dimension());
    model.groups.push_back(std::move(group));
  }
  return model;
}

}  // namespace

TEST_CASE("runs left out of the surrogates, as data, have their own parameters inside 90 % intervals", "[uq][slow]") {
  const data::StudyFile file = data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/developer");
  const data::Study study = data::read_study(file);
  const data::RunTable table = data::read_table(study.training.table, study).table;
  const std::vector<FittedSurrogate> every = fit_surrogates(study, table);
  std::map<std::string, Count> counts;
  for (const data::Material& material : study.materials) {
    std::vector<FittedSurrogate> fitted;
    for (const FittedSurrogate& one : every)
      if (one.rows.material == material.name) fitted.push_back(one);
    REQUIRE_FALSE(fitted.empty());
    const std::size_t runs = static_cast<std::size_t>(fitted.front().rows.set.y.size());
    for (const FittedSurrogate& one : fitted) REQUIRE(static_cast<std::size_t>(one.rows.set.y.size()) == runs);
    for (std::size_t run = 0; run < runs; ++run) {
      const auto model = std::make_shared<const CaseModel>(case_of_run(study, fitted, run));
      const Draws draws =
          sample_mixture(posterior_target(model), {.draws = 400, .stop = {.ess_bulk = 600.0}, .seed = 1});
      if (!draws.converged) continue;
      const Eigen::MatrixXd all = draws.pooled();
      int unknown = 0;
      for (std::size_t k = 0; k < fitted.front().rows.inputs.size(); ++k) {
        if (fitted.front().rows.inputs[k].kind != InputKind::parameter) continue;
        const double truth = place_of(fitted.front(), static_cast<Eigen::Index>(run))[k];
        const Eigen::VectorXd u = all.col(unknown);
        Count& count = counts[model->unknowns[unknown].label];
        ++count.of;
        if (quantile(u, 0.05) <= truth && truth <= quantile(u, 0.95)) ++count.inside;
        ++unknown;
      }
    }
  }
  for (const auto& [name, count] : counts) {
    const double share = count.inside / static_cast<double>(count.of);
    // Outputs of one run share its scatter, which the likelihood takes for independent: three standard errors.
    const double error = std::sqrt(0.09 / count.of);
    WARN(name << ": " << count.inside << " of " << count.of << " held-out runs inside 90 % intervals");
    CHECK(std::abs(share - 0.9) < 3.0 * error);
  }
}
