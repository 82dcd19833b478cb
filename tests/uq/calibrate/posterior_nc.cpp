// A posterior's file read back with netCDF itself: dimensions, units, and the numbers that were put in.
#include "uq/calibrate/posterior_nc.hpp"

#include <netcdf.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/calibrate/calibrate.hpp"

using namespace uq;

namespace {

constexpr std::size_t chains = 2, draws = 300;
const std::vector<double> speeds = {0.0, 0.4, 1.0};
constexpr double error = 0.05;  // of each reading, SI

/// A reader of one group of a file.
class NcGroup {
 public:
  NcGroup(int file, const std::string& name) { REQUIRE(nc_inq_ncid(file, name.c_str(), &id_) == NC_NOERR); }

  int variable(const std::string& name) const {
    INFO(name);
    int found = -1;
    REQUIRE(nc_inq_varid(id_, name.c_str(), &found) == NC_NOERR);
    return found;
  }
  bool has(const std::string& name) const {
    int found = -1;
    return nc_inq_varid(id_, name.c_str(), &found) == NC_NOERR;
  }
  /// "chain 2, draw 300".
  std::string shape(const std::string& name) const {
    int count = 0, ids[NC_MAX_VAR_DIMS] = {};
    REQUIRE(nc_inq_varndims(id_, variable(name), &count) == NC_NOERR);
    REQUIRE(nc_inq_vardimid(id_, variable(name), ids) == NC_NOERR);
    std::string text;
    for (int k = 0; k < count; ++k) {
      char dimension[NC_MAX_NAME + 1] = {};
      std::size_t size = 0;
      REQUIRE(nc_inq_dim(id_, ids[k], dimension, &size) == NC_NOERR);
      text += (k == 0 ? "" : ", ") + std::string(dimension) + " " + std::to_string(size);
    }
    return text;
  }
  std::vector<double> values(const std::string& name, std::size_t count) const {
    std::vector<double> read(count);
    REQUIRE(nc_get_var_double(id_, variable(name), read.data()) == NC_NOERR);
    return read;
  }
  /// Empty where there is none.
  std::string attribute(const std::string& name, const char* key) const {
    std::size_t size = 0;
    if (nc_inq_attlen(id_, variable(name), key, &size) != NC_NOERR) return {};
    std::string text(size, ' ');
    REQUIRE(nc_get_att_text(id_, variable(name), key, text.data()) == NC_NOERR);
    return text;
  }

 private:
  int id_ = -1;
};

/// A file open for reading.
class NcFile {
 public:
  explicit NcFile(const std::string& path) { REQUIRE(nc_open(path.c_str(), NC_NOWRITE, &id_) == NC_NOERR); }
  ~NcFile() { nc_close(id_); }
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;
  NcGroup group(const std::string& name) const { return {id_, name}; }

 private:
  int id_ = -1;
};

/// A study of two outputs in units of their own; the angle was not read at the first speed.
data::Study study_in_units() {
  data::Study study = formula::study(speeds, {12.0, 12.1, 12.2}, error);
  study.parameters[0].unit = {.symbol = "mJ/m2", .factor = 1e-3};
  study.controls[0].unit = {.symbol = "rpm", .factor = 2.0 * std::numbers::pi / 60.0};
  study.outputs[0].unit = {.symbol = "mN m", .factor = 1e-3};
  data::ObservationSet& bench = study.observations[0];
  bench.outputs = {0, 1};
  for (std::size_t i = 0; i < bench.points.size(); ++i) {
    bench.points[i].values.push_back(i == 0 ? std::numeric_limits<double>::quiet_NaN() : 11.0);
    bench.points[i].standard_errors.push_back(i == 0 ? std::numeric_limits<double>::quiet_NaN() : error);
  }
  return study;
}

/// A case with draws from all over the cube, no two of them alike.
SampledCase with_draws(const data::Study& study) {
  SampledCase sampled;
  sampled.model = std::make_shared<const CaseModel>(build_case(study, formula::emulators(), 0));
  sampled.draws.sampler = "nuts";
  data::RandomStream random(20261129, data::Purpose::test, 6);
  for (std::size_t c = 0; c < chains; ++c) {
    Chain chain{.x = Eigen::MatrixXd(draws, 2),
                .log_density = Eigen::VectorXd(draws),
                .acceptance = Eigen::VectorXd(draws),
                .energy = Eigen::VectorXd(draws),
                .tree_depth = std::vector<int>(draws, 3),
                .diverged = std::vector<bool>(draws, false)};
    for (double& u : chain.x.reshaped()) u = random.uniform();
    for (Eigen::VectorXd* one : {&chain.log_density, &chain.acceptance, &chain.energy})
      for (double& value : *one) value = random.normal();
    chain.diverged[7 + c] = true;
    sampled.draws.chains.push_back(std::move(chain));
  }
  return sampled;
}

}  // namespace

TEST_CASE("a posterior's file has the draws that were put in, in the study's units, with their chains", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = study_in_units();
  const SampledCase sampled = with_draws(study);
  write_posterior(folder.path("posterior.nc"), study, sampled, 7);
  const NcFile file(folder.path("posterior.nc"));

  const NcGroup posterior = file.group("posterior");
  CHECK(posterior.shape("a") == "chain 2, draw 300");
  CHECK(posterior.attribute("a", "units") == "mJ/m2");
  CHECK(posterior.attribute("b", "units").empty());
  const std::vector<double> a = posterior.values("a", chains * draws), b = posterior.values("b", chains * draws);
  const NcGroup statistics = file.group("sample_stats");
  const std::vector<double> lp = statistics.values("lp", chains * draws);
  const std::vector<double> acceptance = statistics.values("acceptance_rate", chains * draws);
  const std::vector<double> energy = statistics.values("energy", chains * draws);
  const std::vector<double> depth = statistics.values("tree_depth", chains * draws);
  const std::vector<double> diverging = statistics.values("diverging", chains * draws);
  CHECK(statistics.attribute("diverging", "dtype") == "bool");
  for (std::size_t c = 0; c < chains; ++c)
    for (std::size_t i = 0; i < draws; ++i) {
      const Chain& chain = sampled.draws.chains[c];
      const std::size_t at = c * draws + i;
      const bool same = a[at] == Approx(1000.0 * chain.x(i, 0)).epsilon(1e-14) &&  // both ranges are 0 to 1
                        b[at] == Approx(chain.x(i, 1)).epsilon(1e-14) && lp[at] == chain.log_density[i] &&
                        acceptance[at] == chain.acceptance[i] && energy[at] == chain.energy[i] && depth[at] == 3.0 &&
                        diverging[at] == (i == 7 + c ? 1.0 : 0.0);
      if (!same) FAIL("draw " << i << " of chain " << c);
    }

  // What a sampler does not have is not made up.
  SampledCase mixture = sampled;
  for (Chain& chain : mixture.draws.chains) {
    chain.energy.resize(0);
    chain.tree_depth.clear();
    chain.diverged.clear();
  }
  write_posterior(folder.path("mixture.nc"), study, mixture, 7);
  const NcFile plain(folder.path("mixture.nc"));
  for (const char* name : {"energy", "tree_depth", "diverging"}) CHECK_FALSE(plain.group("sample_stats").has(name));
}

TEST_CASE("a posterior's file has the readings at their settings, and each draw's own repeat and density of them",
          "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = study_in_units();
  const SampledCase sampled = with_draws(study);
  write_posterior(folder.path("posterior.nc"), study, sampled, 7);
  const NcFile file(folder.path("posterior.nc"));

  // What was measured; an output that some points lack has a dimension of its own.
  const NcGroup measured = file.group("observed_data"), constant = file.group("constant_data");
  CHECK(measured.shape("bench_torque") == "bench_point 3");
  CHECK(measured.shape("bench_angle") == "bench_angle_point 2");
  CHECK(measured.attribute("bench_torque", "units") == "mN m");
  CHECK(measured.attribute("bench_torque", "coordinates") == "bench_speed");
  CHECK(measured.attribute("bench_speed", "units") == "rpm");
  const std::vector<double> torque = measured.values("bench_torque", 3), speed = measured.values("bench_speed", 3);
  const std::vector<double> torque_error = constant.values("bench_torque_se", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(torque[i] == Approx(1000.0 * study.observations[0].points[i].values[0]));
    CHECK(torque_error[i] == Approx(1000.0 * error));
    CHECK(speed[i] == Approx(speeds[i] * 60.0 / (2.0 * std::numbers::pi)));
  }
  CHECK(measured.values("bench_angle_speed", 2)[0] == Approx(speed[1]));

  // The emulators are exact: a repeat is normal about the formula, and the density is that of a normal law.
  const NcGroup predicted = file.group("posterior_predictive"), density = file.group("log_likelihood");
  CHECK(predicted.shape("bench_torque") == "chain 2, draw 300, bench_point 3");
  CHECK(density.shape("bench_angle") == "chain 2, draw 300, bench_angle_point 2");
  const std::vector<double> repeats = predicted.values("bench_torque", chains * draws * 3);
  const std::vector<double> logs = density.values("bench_torque", chains * draws * 3);
  double sum = 0.0, squares = 0.0;
  for (std::size_t c = 0; c < chains; ++c)
    for (std::size_t i = 0; i < draws; ++i)
      for (std::size_t p = 0; p < 3; ++p) {
        const Eigen::MatrixXd& x = sampled.draws.chains[c].x;
        const std::size_t at = (c * draws + i) * 3 + p;
        const double exact = formula::torque(x(i, 0), x(i, 1), speeds[p]);
        const double z = (study.observations[0].points[p].values[0] - exact) / error;
        if (logs[at] != Approx(-0.5 * z * z - std::log(error * std::sqrt(2.0 * std::numbers::pi))).epsilon(1e-9))
          FAIL("draw " << i << " of chain " << c << ", point " << p);
        const double off = (repeats[at] / 1000.0 - exact) / error;
        sum += off;
        squares += off * off;
      }
  const double count = chains * draws * 3.0;
  CHECK(std::abs(sum / count) < 4.0 / std::sqrt(count));
  CHECK(squares / count == Approx(1.0).margin(4.0 * std::sqrt(2.0 / count)));
}

TEST_CASE("the table of draws has the numbers of the file", "[uq]") {
  const data::Study study = study_in_units();
  const SampledCase sampled = with_draws(study);
  const std::string table = draws_csv(sampled);
  CHECK(table.rfind("# units: a [mJ/m2], b [1]\nchain,draw,a,b,lp\n0,0,", 0) == 0);
  CHECK(std::count(table.begin(), table.end(), '\n') == static_cast<std::ptrdiff_t>(2 + chains * draws));
}

TEST_CASE("a file of somebody else's is not replaced by a posterior", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = study_in_units();
  const SampledCase sampled = with_draws(study);
  folder.write("posterior.nc", "mine");
  CHECK(failure_of(folder, [&] {
          write_posterior(folder.path("posterior.nc"), study, sampled, 7);
        }).rfind("73: posterior.nc", 0) == 0);
  CHECK(folder.read("posterior.nc") == "mine");
}
