#include "surrogate/storage.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "tests/temporary.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

TrainingSet small_set() {
  data::RandomStream random(1, data::Purpose::test);
  TrainingSet training{scrambled_sobol(25, 3, 1), VectorXd(25), VectorXd::Constant(25, 1e-4)};
  training.x.col(1).setConstant(0.5);
  training.x.row(7) = training.x.row(2);
  for (int i = 0; i < 25; ++i)
    training.y[i] = 1.0 + std::sin(3.0 * training.x(i, 0)) * training.x(i, 2) * 0.5 + 0.01 * random.normal();
  return training;
}

}  // namespace

TEST_CASE("a saved process predicts the same bits when it is read again") {
  const TemporaryFolder folder;
  const MatrixXd points = scrambled_sobol(8, 3, 5);
  ProcessSet processes;
  processes.emplace("plain", SavedProcess{fit(small_set(), {.starts = 2}), std::nullopt, "judged \"good\""});
  processes.emplace("integrated, log / second",
                    SavedProcess{fit(small_set(), {.kernel = Kernel::matern32,
                                                   .mean = MeanBasis::linear,
                                                   .scale = OutputScale::log,
                                                   .starts = 2,
                                                   .hyper_uncertainty = HyperUncertainty::integrated})});
  const SurrogateKey key{"study", "table"};
  save_processes(folder.path("surrogate.h5"), processes, key);
  const LoadedProcesses loaded = load_processes(folder.path("surrogate.h5"), key);
  REQUIRE(loaded.processes);
  REQUIRE(loaded.processes->size() == 2);
  for (const auto& [name, saved] : processes) {
    const GaussianProcess &process = saved.process, &again = loaded.processes->at(name).process;
    CHECK(loaded.processes->at(name).remarks == saved.remarks);
    CHECK_FALSE(loaded.processes->at(name).high);
    CHECK(process.predict(points).mean == again.predict(points).mean);
    CHECK(process.predict(points).covariance == again.predict(points).covariance);
    CHECK(process.log_marginal_likelihood() == again.log_marginal_likelihood());
    CHECK(process.leave_one_out().standardised == again.leave_one_out().standardised);
    CHECK(process.diagnostics().starts.size() == again.diagnostics().starts.size());
    CHECK(process.diagnostics().bound_hits.size() == again.diagnostics().bound_hits.size());
  }
}

TEST_CASE("a two-level process predicts the same bits when it is read again") {
  const TemporaryFolder folder;
  const MatrixXd points = scrambled_sobol(8, 3, 5);
  TrainingSet dear{scrambled_sobol(5, 3, 9), VectorXd(5), {}};
  for (int i = 0; i < 5; ++i) dear.y[i] = 3.0 + dear.x(i, 0) + 0.2 * std::sin(7.0 * dear.x(i, 1));
  const TwoLevelProcess process = fit_two_level(fit(small_set(), {.starts = 1}), dear);
  save_processes(folder.path("two.h5"), {{"torque", SavedProcess{process.low(), process.high()}}}, {"study", "table"});
  const LoadedProcesses loaded = load_processes(folder.path("two.h5"), {"study", "table"});
  REQUIRE(loaded.processes);
  const SavedProcess& saved = loaded.processes->at("torque");
  REQUIRE(saved.high);
  const TwoLevelProcess again(saved.process, *saved.high);
  CHECK(process.predict(points).mean == again.predict(points).mean);
  CHECK(process.predict(points).covariance == again.predict(points).covariance);
  CHECK(process.high().diagnostics.starts.size() == again.high().diagnostics.starts.size());
}

TEST_CASE("a surrogate of another study or table is stale, and says so") {
  const TemporaryFolder folder;
  ProcessSet processes;
  processes.emplace("torque", SavedProcess{fit(small_set(), {.starts = 1})});
  save_processes(folder.path("surrogate.h5"), processes, {"study", "table"});
  CHECK_FALSE(load_processes(folder.path("surrogate.h5"), {"study", "other"}).processes);
  CHECK(load_processes(folder.path("surrogate.h5"), {"study", "other"}).reason.find("table") != std::string::npos);
  CHECK(load_processes(folder.path("surrogate.h5"), {"other", "table"}).reason.find("study") != std::string::npos);
  CHECK_FALSE(load_processes(folder.path("none.h5"), {"study", "table"}).processes);
}

TEST_CASE("a truncated surrogate file is bad data, not a crash") {
  const TemporaryFolder folder;
  ProcessSet processes;
  processes.emplace("torque", SavedProcess{fit(small_set(), {.starts = 1})});
  const std::string path = folder.path("surrogate.h5");
  save_processes(path, processes, {"study", "table"});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  CHECK_THROWS_AS(load_processes(path, {"study", "table"}), data::InputError);
}
