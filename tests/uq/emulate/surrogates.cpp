// Which surrogates a study needs.
#include "uq/emulate/surrogates.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "tests/uq/formula_study.hpp"

TEST_CASE("an output that is only to be predicted has a surrogate, one that nobody asks for has none", "[uq]") {
  data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, 0.1);
  data::RunTable table = data::empty_table(study);
  const Eigen::MatrixXd design = surrogate::scrambled_sobol(30, 3, 1, 0);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double a = design(i, 0), b = design(i, 1), x = design(i, 2);
    table.rows.push_back({.inputs = {a, b, x},
                          .outputs = {formula::torque(a, b, x), formula::angle(a, b, x)},
                          .standard_errors = {0.01, 0.01}});
  }
  const auto names = [&] {
    std::vector<std::string> found;
    for (const uq::FittedSurrogate& one :
         uq::fit_surrogates(study, table, {.fit = {.starts = 2}, .observed_only = true}))
      found.push_back(one.report.output);
    return found;
  };
  CHECK(names() == std::vector<std::string>{"torque"});
  study.observations.push_back({.name = "later", .outputs = {1}});
  study.unused_data = {{.name = "later", .case_index = 0, .observe = {"later"}}};
  CHECK(names() == std::vector<std::string>{"torque", "angle"});
}

TEST_CASE("a cheaper level that says nothing of the other is left out, and one that says something is used", "[uq]") {
  const data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, 0.1);
  data::RandomStream random(3, data::Purpose::test);
  const auto table_of = [&](int runs, std::uint64_t seed, const auto& torque) {
    data::RunTable table = data::empty_table(study);
    const Eigen::MatrixXd design = surrogate::scrambled_sobol(runs, 3, seed, 0);
    for (Eigen::Index i = 0; i < design.rows(); ++i)
      table.rows.push_back({.inputs = {design(i, 0), design(i, 1), design(i, 2)},
                            .outputs = {torque(design(i, 0), design(i, 1), design(i, 2)), std::nan("")},
                            .standard_errors = {0.01, 0.01}});
    return table;
  };
  const data::RunTable dear = table_of(12, 1, formula::torque);
  const auto report_over = [&](const data::RunTable& low) {
    uq::SurrogateOptions options{.fit = {.starts = 2}, .observed_only = true};
    options.low = low;
    return uq::fit_surrogates(study, dear, options).at(0).report;
  };
  for (const uq::SurrogateReport& report :
       {report_over(table_of(40, 2, [&](double, double, double) { return 10.0 + random.normal(); })),
        report_over(table_of(40, 2, [](double, double, double) { return 10.0; }))}) {
    CHECK(report.low_runs == 0);
    CHECK(report.q2 > 0.98);
    CHECK(report.notes.front().find("the cheaper level, 40 runs, is left out") == 0);
  }
  const uq::SurrogateReport used = report_over(
      table_of(40, 2, [](double a, double b, double x) { return 0.8 * formula::torque(a, b, x) + 0.5 * a; }));
  CHECK(used.low_runs == 40);
}
