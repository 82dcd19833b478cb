// Odd data, kind by kind: what cannot be meant is refused, what is suspicious is named, and clean data pass in silence.
#include "uq/calibrate/data_check.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tests/temporary.hpp"

using Catch::Contains;
using data::Severity;

namespace {

struct Row {
  double friction, cohesion, speed, torque, error;
};

double torque(double friction, double cohesion, double speed) {
  return 2.0 + 14.0 * friction / (0.4 + friction) + 0.5 * cohesion * (1.0 - 0.3 * speed / 300.0) - 0.003 * speed;
}

/// Six numbers as normal ones come.
constexpr double scatter[] = {0.5, -1.1, 0.8, -0.3, 1.2, -0.9};

/// A study, its runs and its bench, to be spoilt by a test.
struct Files {
  std::string parameters =
      "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 0\nhigh = 10\n";
  std::string header = "friction,cohesion,speed,torque,torque_se";
  std::vector<Row> runs;
  std::string bench_comment = {};
  std::vector<Row> bench;  ///< friction and cohesion are not written
  std::pair<std::string, std::string> bench_columns =
      {};  ///< further ones in front: their names, and what each row has
  std::string cases =
      "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\n"
      "free = [\"friction\", \"cohesion\"]\n";
  std::vector<std::string> log_outputs = {};

  Files() {
    const auto part = [](double x) { return x - std::floor(x); };
    for (int i = 1; i <= 60; ++i) {
      // Roberts' additive recurrence in three dimensions.
      const double f = 0.1 + 0.7 * part(0.8191725134 * i), c = 10.0 * part(0.6710436067 * i),
                   s = 50.0 + 250.0 * part(0.5497004779 * i);
      const double y = torque(f, c, s) * (1.0 + 0.005 * std::sin(71.0 * i));
      runs.push_back({f, c, s, y, 0.005 * y});
    }
    for (int i = 0; i < 6; ++i) {
      const double s = 50.0 + 50.0 * i, y = torque(0.4, 4.0, s) * (1.0 + 0.02 * scatter[i]);
      bench.push_back({0.0, 0.0, s, y, 0.02 * y});
    }
  }
  void each_run(const std::function<void(Row&)>& change) {
    for (Row& row : runs) change(row);
  }
  void each_reading(const std::function<void(Row&)>& change) {
    for (Row& row : bench) change(row);
  }
};

struct Looked {
  std::vector<data::Finding> findings;
  data::RunTable table;
  std::vector<std::string> left_out;  ///< by the table's reader
};

Looked look(const Files& files) {
  const TemporaryFolder folder;
  std::string runs = files.header + "\n",
              bench = files.bench_comment + files.bench_columns.first + "speed,torque,torque_se\n";
  for (const Row& r : files.runs)
    runs += fmt::format("{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", r.friction, r.cohesion, r.speed, r.torque, r.error);
  for (const Row& r : files.bench)
    bench += files.bench_columns.second + fmt::format("{:.8g},{:.8g},{:.8g}\n", r.speed, r.torque, r.error);
  folder.write("runs.csv", runs);
  folder.write("bench.csv", bench);
  const auto path = folder.write(
      "study.toml", "[study]\nname = \"s\"\n" + files.parameters +
                        "[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n[training]\ntable = \"runs.csv\"\n"
                        "[outputs.torque]\nunit = \"mN m\"\n" +
                        files.cases);
  const data::StudyFile file = data::StudyFile::open(path);
  const data::Study study = data::read_study(file);
  file.finish();
  data::TableRead read = data::read_table(study.training.table, study);
  Looked looked{.findings = {}, .table = std::move(read.table), .left_out = std::move(read.left_out)};
  looked.findings = uq::check_data(study, looked.table, {}, files.log_outputs);
  return looked;
}

/// The only finding, which must be of this kind.
data::Finding only(const Files& files, const std::string& kind) {
  const Looked looked = look(files);
  std::string all;
  for (const data::Finding& finding : looked.findings)
    all += data::to_text(finding.kind) + (": " + data::describe(finding)) + "\n";
  INFO(all);
  REQUIRE(looked.findings.size() == 1);
  CHECK(data::to_text(looked.findings[0].kind) == kind);
  return looked.findings[0];
}

}  // namespace

TEST_CASE("clean data have no finding", "[uq]") { CHECK(look(Files()).findings.empty()); }

TEST_CASE("of a parameter over decades it is said that its prior is uniform in its value, unless the study says so") {
  Files files;
  for (const auto& [high, prior, said] :
       std::vector<std::tuple<double, std::string, bool>>{{10.0, "", true},
                                                          {10.0, "prior = { kind = \"uniform\" }\n", false},
                                                          {10.0, "prior = { kind = \"log_uniform\" }\n", false},
                                                          {10.0, "scale = \"linear\"\n", false}}) {
    files.parameters = fmt::format(
        "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 0.01\nhigh = "
        "{}\n{}{}",
        high, prior.find("scale") == std::string::npos ? "scale = \"log\"\n" : "", prior);
    INFO(files.parameters);
    CHECK(look(files).findings.empty() != said);
  }
  files.parameters =
      "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 0.01\nhigh = "
      "10\nscale = \"log\"\n";
  const data::Finding finding = only(files, "prior not stated");
  CHECK(finding.severity == Severity::note);
  CHECK_THAT(data::describe(finding), Contains("90 % of it above 1 mJ/m2") && Contains("log_uniform"));
}

TEST_CASE("a control that the runs hold at another value than the measured one is refused", "[uq]") {
  Files files;
  files.each_run([](Row& row) { row.speed = 150.0; });
  const data::Finding found = only(files, "case");
  CHECK(found.severity == Severity::refusal);
  CHECK_THAT(found.what, Contains("every run of this material has 150 rpm"));
  // A speed is never set exactly.
  files.each_reading([](Row& row) { row.speed = 151.0 + 0.002 * row.speed; });
  CHECK(look(files).findings.empty());
}

TEST_CASE("a parameter fixed where no run is, by the case or by the material, is refused", "[uq]") {
  Files files;
  files.each_run([](Row& row) { row.cohesion = 0.0; });
  SECTION("by the case") {
    files.cases =
        "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n[[calibrate]]\nname = \"powder\"\nobserve = "
        "[\"bench\"]\nfree = [\"friction\"]\nfixed = { cohesion = 4 }\n";
    CHECK_THAT(only(files, "case").what, Contains("case 'powder' fixes cohesion at 4 mJ/m2, but every run"));
  }
  SECTION("by the material") {
    files.parameters += "[materials.powder]\nfixed = { cohesion = 4.0 }\n";
    files.cases =
        "[[observe]]\nname = \"bench\"\nmaterial = \"powder\"\nfile = \"bench.csv\"\n[[calibrate]]\nname = "
        "\"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\"]\n";
    CHECK_THAT(only(files, "case").what, Contains("material 'powder' fixes cohesion at 4 mJ/m2, but every run of it"));
  }
}

TEST_CASE("one file under two names in one case is refused, and so is a second file with the same readings", "[uq]") {
  Files files;
  files.cases =
      "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n[[observe]]\nname = \"again\"\nfile = \"bench.csv\"\n"
      "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\", \"again\"]\nfree = [\"friction\", \"cohesion\"]\n";
  const data::Finding found = only(files, "case");
  CHECK(found.severity == Severity::refusal);
  CHECK_THAT(found.what, Contains("'again' would count twice: 'bench' holds the same measurements"));
}

TEST_CASE("the study's own run table in the place of the measurement is refused as such", "[uq]") {
  Files files;
  files.cases.replace(files.cases.find("bench.csv"), 9, "runs.csv");
  const Looked looked = look(files);
  const auto found = std::find_if(looked.findings.begin(), looked.findings.end(),
                                  [](const data::Finding& one) { return one.kind == data::FindingKind::run_table; });
  REQUIRE(found != looked.findings.end());
  CHECK(found->severity == Severity::refusal);
  CHECK_THAT(found->what, Contains("has columns of the parameters (friction, cohesion)"));
}

TEST_CASE("readings beside columns of all parameters are suspected to be runs", "[uq]") {
  Files files;
  files.bench_columns = {"friction,cohesion,", "0.4,4,"};
  const data::Finding found = only(files, "run table");
  CHECK(found.severity == Severity::warning);
}

TEST_CASE("copied readings are counted once and named", "[uq]") {
  Files files;
  const std::vector<Row> once = files.bench;
  for (int i = 0; i < 9; ++i) files.bench.insert(files.bench.end(), once.begin(), once.end());
  const data::Finding found = only(files, "copied observations");
  CHECK(found.severity == Severity::warning);
  CHECK(found.places.size() == 54);
  CHECK_THAT(found.what, Contains("54 of 60 rows are copies"));
}

TEST_CASE("rows outside a parameter's range are named, and one far outside is not learnt from", "[uq]") {
  Files files;
  files.runs[10].friction = 0.85;
  files.runs[20].friction = 5.0;
  const data::Finding found = only(files, "outside the range");
  CHECK(found.severity == Severity::warning);
  CHECK(found.places == std::vector<std::string>{"runs.csv:22", "runs.csv:12"});
  const Looked looked = look(files);
  CHECK(data::used_rows(looked.table) == 59);
  CHECK(static_cast<bool>(looked.table.rows[20].left_out));
}

TEST_CASE("rows outside a control's range are named, and those that another unit brings inside are not learnt from",
          "[uq]") {
  Files files;
  SECTION("near") {
    files.runs[4].speed = 330.0;
    const data::Finding found = only(files, "outside the range");
    CHECK_THAT(found.what, Contains("1 of 60 rows have speed outside its range, 50 to 300"));
    CHECK_THAT(found.remedy, Contains("controls.speed"));
  }
  SECTION("a third of them in rad/s") {
    for (std::size_t i = 0; i < 20; ++i) files.runs[i].speed *= 2.0 * 3.14159265358979 / 60.0;
    const data::Finding found = only(files, "outside the range");
    CHECK_THAT(found.what, Contains("20 of 60 rows have speed outside its range") && Contains("rad/s") &&
                               Contains("they are left out"));
  }
}

TEST_CASE("a column in another unit is suspected from its range, and refused where it lies outside of it", "[uq]") {
  Files files;
  SECTION("a thousand times smaller: inside, but nowhere") {
    files.each_run([](Row& row) { row.cohesion *= 1e-3; });
    const Looked looked = look(files);
    REQUIRE_FALSE(looked.findings.empty());
    CHECK(looked.findings[0].kind == data::FindingKind::unit);
    CHECK(looked.findings[0].severity == Severity::warning);
    CHECK_THAT(looked.findings[0].what, Contains("times 1000 it would fill it"));
  }
  SECTION("a thousand times larger") {
    files.each_run([](Row& row) { row.cohesion *= 1e3; });
    const Looked looked = look(files);
    REQUIRE_FALSE(looked.findings.empty());
    CHECK(looked.findings[0].severity == Severity::refusal);
    CHECK_THAT(looked.findings[0].what, Contains("divided by 1000"));
  }
  SECTION("a third of the rows a thousand times smaller, all inside") {
    for (std::size_t i = 0; i < 20; ++i) files.runs[i].cohesion *= 1e-3;
    const Looked looked = look(files);
    REQUIRE_FALSE(looked.findings.empty());
    CHECK(looked.findings[0].kind == data::FindingKind::unit);
    CHECK_THAT(looked.findings[0].what, Contains("20 of 60 rows have cohesion from") && Contains("one prefix"));
  }
  SECTION("runs' speed in rad/s") {
    files.each_run([](Row& row) { row.speed *= 2.0 * 3.14159265 / 60.0; });
    const Looked looked = look(files);
    REQUIRE_FALSE(looked.findings.empty());
    CHECK_THAT(looked.findings[0].what, Contains("rpm against rad/s"));
  }
  SECTION("friction as an angle in degrees: of a ratio neither time nor force is another unit") {
    files.each_run([](Row& row) { row.friction = std::atan(row.friction) * 180.0 / 3.14159265; });
    const Looked looked = look(files);
    REQUIRE_FALSE(looked.findings.empty());
    CHECK(looked.findings[0].severity == Severity::refusal);
    CHECK_THAT(looked.findings[0].what, Contains("Is another unit meant, degrees against radians?"));
  }
  SECTION("the bench's speed in turns per second") {
    files.each_reading([](Row& row) { row.speed /= 60.0; });
    bool said = false;
    for (const data::Finding& finding : look(files).findings)
      said = said || (finding.kind == data::FindingKind::unit &&
                      finding.what.find("minutes against seconds") != std::string::npos);
    CHECK(said);
  }
}

TEST_CASE("a reading at the end of the control's range is in no other unit, though the runs stop a little before",
          "[uq]") {
  Files files;
  std::erase_if(files.runs, [](const Row& row) { return row.speed > 285.0; });
  files.bench = {files.bench.back()};
  REQUIRE(files.bench[0].speed == 300.0);
  for (const data::Finding& finding : look(files).findings) CHECK(finding.kind != data::FindingKind::unit);
}

TEST_CASE("observed magnitudes outside all runs are named, with the factor between units that they suggest", "[uq]") {
  Files files;
  files.each_reading([](Row& row) { row.torque *= 1e3, row.error *= 1e3; });
  const data::Finding found = only(files, "unit");
  CHECK_THAT(found.place, Contains("bench.csv:2: torque"));
  CHECK_THAT(found.what, Contains("lie outside all runs") && Contains("one prefix"));
  CHECK_THAT(data::describe(found), Contains("check the unit of torque"));
}

TEST_CASE("readings of the other sign than the runs are named as such", "[uq]") {
  Files files;
  files.each_reading([](Row& row) { row.torque = -row.torque; });
  const data::Finding found = only(files, "unit");
  CHECK_THAT(found.place, Contains("bench.csv:2: torque"));
  CHECK_THAT(found.what, Contains("all readings are negative, where all runs give"));
  CHECK_THAT(found.remedy, Contains("by -1"));
  files.bench.back().torque = -files.bench.back().torque;  // one of them agrees
  for (const data::Finding& other : look(files).findings)
    CHECK_THAT(other.what, !Contains("all readings are negative"));
}

TEST_CASE("rows of one output in another unit than the others are named, and a model that steps is not", "[uq]") {
  SECTION("the last third of the runs") {
    for (const double factor : {1000.0, 1e-3, 9.80665}) {
      Files files;
      int i = 0;
      files.each_run([&](Row& row) {
        if (++i > 40) row.torque *= factor, row.error *= factor;
      });
      const std::vector<data::Finding> found = look(files).findings;
      INFO(factor);
      // By 9.8 the two groups are nearer to each other than they are wide.
      REQUIRE(found.size() == (factor == 9.80665 ? 0U : 1U));
      if (found.empty()) continue;
      CHECK(found[0].kind == data::FindingKind::unit);
      CHECK(found[0].severity == Severity::warning);
      CHECK(found[0].places.size() == 20);
      CHECK_THAT(found[0].what, Contains("20 of 60 rows") && Contains("one prefix"));
    }
  }
  SECTION("two readings of six") {
    Files files;
    files.bench[1].torque *= 1000.0;
    files.bench[4].torque *= 1000.0;
    const std::vector<data::Finding> found = look(files).findings;
    REQUIRE(std::any_of(found.begin(), found.end(), [](const data::Finding& one) {
      return one.places == std::vector<std::string>{"bench.csv:3", "bench.csv:6"};
    }));
  }
  SECTION("a torque a thousand times larger above a friction of 0.4") {
    Files files;
    files.each_run([](Row& row) {
      if (row.friction > 0.4) row.torque *= 1000.0, row.error *= 1000.0;
    });
    for (const data::Finding& one : look(files).findings) CHECK(one.kind != data::FindingKind::unit);
  }
}

TEST_CASE("exchanged columns are refused with both names", "[uq]") {
  Files files;
  files.header = "cohesion,friction,speed,torque,torque_se";
  const Looked looked = look(files);
  REQUIRE(looked.findings.size() == 1);
  CHECK(looked.findings[0].severity == Severity::refusal);
  CHECK_THAT(looked.findings[0].what, Contains("the columns friction and cohesion look exchanged"));
}

TEST_CASE("exchanged columns of a measurement are refused with both names", "[uq]") {
  const auto refused = [](const Files& files) {
    for (const data::Finding& one : look(files).findings)
      if (one.kind == data::FindingKind::exchanged_columns && one.severity == Severity::refusal) return one.what;
    return std::string();
  };
  Files files;
  CHECK(refused(files).empty());
  SECTION("a value and its standard error") {
    files.each_reading([](Row& row) { std::swap(row.torque, row.error); });
    CHECK_THAT(refused(files), Contains("the columns torque and torque_se look exchanged"));
  }
  SECTION("a speed and a torque") {
    files.each_reading([](Row& row) { std::swap(row.torque, row.speed); });
    CHECK_THAT(refused(files), Contains("the columns speed and torque look exchanged"));
  }
  SECTION("a torque in another unit is no exchange") {
    files.each_reading([](Row& row) { row.torque *= 1000.0, row.error *= 1000.0; });
    CHECK(refused(files).empty());
  }
}

TEST_CASE("a range narrowed below the table's is neither an exchange nor a unit", "[uq]") {
  Files files;
  files.parameters =
      "[parameters.friction]\nlow = 0.3\nhigh = 0.5\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 2\nhigh = 6\n";
  for (const data::Finding& finding : look(files).findings) CHECK(finding.kind == data::FindingKind::outside_the_range);
}

TEST_CASE("standard errors in percent are suspected from the scatter, and as shares of the value likewise", "[uq]") {
  Files files;
  SECTION("percent") {
    files.each_reading([](Row& row) { row.error = 2.0; });
    const data::Finding found = only(files, "standard errors");
    CHECK(found.severity == Severity::warning);
    CHECK_THAT(found.what, Contains("Are they in percent?"));
  }
  SECTION("shares") {
    files.each_reading([](Row& row) { row.error = 0.02; });
    CHECK_THAT(only(files, "standard errors").what, Contains("Are they relative?"));
  }
  SECTION("errors three times too small are no shares, where shares would be three times too large") {
    files.each_reading([](Row& row) { row.error = 0.02 * row.torque / 3.0; });
    for (const data::Finding& finding : look(files).findings) CHECK_THAT(finding.what, !Contains("relative"));
  }
  SECTION("honest errors of one and two percent about curves that bend") {
    const std::vector<std::function<double(double)>> curves{
        [](double w) { return 2.0 + w * w; }, [](double w) { return 2.0 + 4.0 / w; },
        [](double w) { return 3.0 + 6.0 * (1.0 - std::exp(-w)); }, [](double w) { return 6.0 * std::pow(w, -0.7); },
        [](double w) { return 4.0 + std::cos(2.0 * w); }};
    for (const auto& curve : curves) {
      for (const double share : {0.01, 0.02}) {
        for (int i = 0; i < 6; ++i) {
          Row& row = files.bench[i];
          row.torque = curve(row.speed / 150.0) * (1.0 + share * scatter[i]);
          row.error = share * row.torque;
        }
        for (const data::Finding& finding : look(files).findings)
          CHECK(finding.kind != data::FindingKind::standard_errors);
      }
    }
  }
  SECTION("honest errors of ten percent") {
    for (int i = 0; i < 6; ++i) {
      Row& row = files.bench[i];
      row.torque *= (1.0 + 0.1 * scatter[i]) / (1.0 + 0.02 * scatter[i]);
      row.error = 0.1 * row.torque;
    }
    CHECK(look(files).findings.empty());
  }
}

TEST_CASE("an idle torque's error that the measurements' file states and the study does not is named", "[uq]") {
  Files files;
  files.bench_comment =
      "# idle torque 0.5 mN m taken off every row; its error is common to all of them: common_error = \"0.1 mN m\" in "
      "[[observe]]\n";
  const data::Finding found = only(files, "error left out");
  CHECK(found.severity == Severity::warning);
  CHECK(found.remedy == "add common_error = \"0.1 mN m\" in [[observe]]");
  const auto stated = files.cases.find("file = \"bench.csv\"\n");
  files.cases.insert(stated, "common_error = { torque = \"0.1 mN m\" }\n");
  CHECK(look(files).findings.empty());
}

TEST_CASE("inputs that move together in all runs are named, along a line, a curve or a plane", "[uq]") {
  Files files;
  SECTION("a line") {
    files.each_run([](Row& row) { row.cohesion = (row.friction - 0.1) / 0.07; });
    CHECK_THAT(only(files, "inputs that move together").what, Contains("friction and cohesion move together"));
  }
  SECTION("a curve") {
    files.each_run([](Row& row) { row.cohesion = 10.0 * std::pow((row.friction - 0.1) / 0.7, 6); });
    CHECK_THAT(only(files, "inputs that move together").what, Contains("friction and cohesion move together"));
  }
  SECTION("a plane") {
    files.each_run([](Row& row) { row.cohesion = (row.friction - 0.1) / 0.14 + (row.speed - 50.0) / 50.0; });
    CHECK_THAT(only(files, "inputs that move together").what, Contains("follows from the other inputs"));
  }
}

TEST_CASE("a row of 0 on a log scale is left out with file, line and cause, and a log output is refused", "[uq]") {
  Files files;
  SECTION("parameter") {
    files.parameters =
        "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = "
        "0.1\nhigh = 10\nscale = \"log\"\nprior = { kind = \"log_uniform\" }\n";
    files.each_run([](Row& row) { row.cohesion = std::max(row.cohesion, 0.1); });
    files.runs[4].cohesion = 0.0;
    const Looked looked = look(files);
    REQUIRE(looked.left_out.size() == 1);
    CHECK_THAT(looked.left_out[0], Contains("runs.csv:6") && Contains("no logarithm"));
    CHECK(looked.table.rows.size() + 1 == files.runs.size());
    CHECK(looked.findings.empty());
  }
  SECTION("output") {
    files.log_outputs = {"torque"};
    files.runs[7].torque = -0.1;
    CHECK_THAT(only(files, "no logarithm").place, Contains("runs.csv:9"));
  }
}

TEST_CASE("a standard error of 0 among others, an output that never changes, and a range half covered are named",
          "[uq]") {
  Files files;
  SECTION("error") {
    files.runs[3].error = 0.0;
    CHECK_THAT(only(files, "standard error 0").place, Contains("runs.csv:5"));
  }
  SECTION("output") {
    files.each_run([](Row& row) { row.torque = 9.0; });
    CHECK_THAT(only(files, "no response").what, Contains("does not respond to any input"));
  }
  SECTION("range") {
    files.each_run([](Row& row) { row.friction = 0.1 + 0.4 * (row.friction - 0.1); });
    CHECK_THAT(only(files, "range not covered").what, Contains("of the range of friction"));
  }
}
