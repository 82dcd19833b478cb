// Surrogates as a user meets them: kept and refitted, of two levels, of several outputs.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "data/random.hpp"
#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

/// A point that moves over the unit square: Roberts' additive recurrence.
struct Point {
  double friction, speed;
};
Point point(int i) {
  const auto part = [](double x) { return x - std::floor(x); };
  return {0.1 + 0.7 * part(0.5 + 0.7548776662466927 * i), 50.0 + 250.0 * part(0.5 + 0.5698402909980532 * i)};
}

double slice(const Point& p) { return std::sqrt(p.friction) * (10.0 + 0.02 * p.speed); }
double machine(const Point& p) { return 2.5 * slice(p) + 1.0 + 0.004 * p.speed; }

/// A line of a CSV file.
std::string line(std::initializer_list<double> values) {
  std::ostringstream text;
  for (const double value : values) text << (text.tellp() > 0 ? "," : "") << value;
  return text.str() + "\n";
}

std::string study(const std::string& training, const std::string& outputs = "[outputs.torque]\nunit = \"mN m\"\n") {
  return "[study]\nname = \"levels\"\nseed = 3\n[parameters.friction]\nlow = 0.1\nhigh = 0.8\n"
         "[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n[training]\n" +
         training + outputs +
         "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n[[calibrate]]\nname = \"powder\"\n"
         "observe = [\"bench\"]\nfree = [\"friction\"]\n";
}

void write_bench(const Folder& folder) {
  std::string bench = "speed,torque,torque_se\n";
  for (const double speed : {60.0, 150.0, 250.0})
    bench += line({speed, machine({0.4, speed}), 0.02 * machine({0.4, speed})});
  folder.write("study/bench.csv", bench);
}

}  // namespace

TEST_CASE("a saved surrogate is used again, and fitted again as soon as its table or study is another", "[slow]") {
  const Folder folder;
  folder.study("other-code");
  const fs::path file = folder.path / "out" / "surrogate.h5";
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"study", "--out", "out"});
    const auto outcome = folder.demcal(arguments);
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    return outcome;
  };
  const std::string first = run({"fit", "--json"}).out;
  const std::string saved = folder.read("out/surrogate.h5");
  const fs::file_time_type written = fs::last_write_time(file);
  const auto again = run({"fit", "--json"});
  CHECK(again.out == first);
  CHECK_THAT(again.err, !Contains("fitted again"));
  CHECK(fs::last_write_time(file) == written);
  CHECK_THAT(run({"sample"}).err, !Contains("fitted again"));
  CHECK(fs::last_write_time(file) == written);

  CHECK_THAT(run({"fit", "--set", "surrogate.kernel=matern 3/2"}).err, Contains("fitted again: the study has changed"));
  CHECK(folder.read("out/surrogate.h5") != saved);
  run({"fit"});  // back to the study's own
  folder.replace("study/runs.csv", "11.1853", "11.1854");
  CHECK_THAT(run({"fit"}).err, Contains("fitted again: the run table has changed"));
  fs::resize_file(file, fs::file_size(file) / 2);
  CHECK_THAT(run({"fit"}).err, Contains("fitted again: it cannot be read"));
  CHECK_THAT(run({"fit"}).err, !Contains("fitted again"));
}

TEST_CASE("a handful of machine runs over many slice runs calibrates the machine, and the report names both levels",
          "[slow]") {
  const Folder folder;
  fs::create_directory(folder.path / "study");
  folder.write("study/study.toml", study("table = \"machine.csv\"\nlow = \"slice.csv\"\n"));
  write_bench(folder);
  std::string low = "friction,speed,torque,torque_se\n", high = low;
  for (int i = 0; i < 40; ++i) low += line({point(i).friction, point(i).speed, slice(point(i)), 0.01});
  for (int i = 100; i < 106; ++i) high += line({point(i).friction, point(i).speed, machine(point(i)), 0.05});
  folder.write("study/slice.csv", low);
  folder.write("study/machine.csv", high);
  const auto outcome = folder.demcal({"calibrate", "study", "--out", "out", "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  const nlohmann::json& surrogate = report["surrogates"][0];
  CHECK(surrogate["runs"] == 6);
  CHECK(surrogate["low_runs"] == 40);
  CHECK(surrogate["rho"].get<double>() == Approx(2.5).epsilon(0.1));
  CHECK_THAT(surrogate["notes"][0].get<std::string>(), Contains("two levels: 6 runs over 40"));
  CHECK_THAT(folder.read("out/report.html"), Contains("two levels: 6 runs over 40"));
  const nlohmann::json& friction = report["cases"][0]["parameters"][0];
  CHECK(friction["verdict"] == "identified");
  CHECK(std::abs(friction["mean"].get<double>() - 0.4) < 3.0 * friction["sd"].get<double>());
  // Read back from its file it is the same surrogate.
  const auto fitted = folder.demcal({"fit", "study", "--out", "out", "--json"});
  CHECK_THAT(fitted.err, !Contains("fitted again"));
  CHECK(nlohmann::json::parse(fitted.out)["surrogates"][0]["rho"] == surrogate["rho"]);
  // A logarithmic output cannot have a cheaper level.
  CHECK(folder.demcal({"fit", "study", "--set", "surrogate.log_outputs=[\"torque\"]"}).status == 78);
}

TEST_CASE("each output has its own surrogate, a run without one output trains the others, and what a fit met is said") {
  const Folder folder;
  fs::create_directory(folder.path / "study");
  folder.write("study/study.toml",
               study("table = \"runs.csv\"\n", "[outputs.torque]\nunit = \"mN m\"\n[outputs.flow]\nunit = \"g/s\"\n"));
  write_bench(folder);
  std::string runs = "friction,speed,torque,torque_se,flow,flow_se\n";
  for (int i = 0; i < 30; ++i) {
    const Point p = point(i < 25 ? i : i - 25);  // the last five are replicates
    runs += line({p.friction, p.speed, machine(p) + (i % 2 ? 0.03 : -0.03), 0.05,
                  i == 4 ? std::numeric_limits<double>::quiet_NaN() : 3.0 + std::sin(0.02 * p.speed), 0.001});
  }
  folder.write("study/runs.csv", runs);
  const auto outcome = folder.demcal({"fit", "study", "--json", "--set", "surrogate.estimate=maximum likelihood"});
  INFO(outcome.err);
  CHECK_THAT(outcome.err, Contains("runs.csv:6: flow: is nan, the row counts for the other outputs only"));
  const nlohmann::json fitted = nlohmann::json::parse(outcome.out)["surrogates"];
  REQUIRE(fitted.size() == 2);
  CHECK(fitted[0]["runs"] == 30);
  CHECK(fitted[1]["output"] == "flow");
  CHECK(fitted[1]["runs"] == 29);
  CHECK(fitted[1]["q2"].get<double>() > 0.999);
  CHECK_THAT(fitted[0]["notes"].dump(), Contains("30 runs at 25 points: replicates are pooled"));
  CHECK_THAT(fitted[1]["notes"].dump(), Contains("length scale of friction is on its upper bound"));
  CHECK_THAT(outcome.err, Contains("length scale of friction is on its upper bound, 50: the output hardly depends"));
}

TEST_CASE(
    "a parameter that the data narrow to an upper limit is not said to have no influence, however noisy the runs") {
  const Folder folder;
  const auto cohesion_with = [&](const std::string& stretch) -> nlohmann::json {
    const auto outcome =
        folder.demcal({"calibrate", DEMCAL_SOURCE_DIR "/tests/cli/cases/upper-limit-noisy-runs", "--out",
                       "out" + stretch, "--json", "--quiet", "--no-scan", "--set", "surrogate.stretch=" + stretch});
    return nlohmann::json::parse(outcome.out)["cases"][0]["parameters"][1];
  };
  // On the stretched scale the surrogate knows the steep end, where the posterior lies, to several of the data's
  // errors.
  const nlohmann::json hidden = cohesion_with("true");
  CHECK(hidden["reason"] == "surrogate");
  CHECK_THAT(hidden["sentence"].get<std::string>(), Contains("the surrogate could miss one of"));
  const nlohmann::json cohesion = cohesion_with("false");
  CHECK(cohesion["contraction"].get<double>() > 0.5);
  CHECK(cohesion["verdict"] == "weakly identified");
  CHECK(cohesion["reason"] == "bound");
  CHECK(cohesion["profile95"][1].get<double>() > 2.0);  // the truth
}

TEST_CASE("speeds over a decade are learnt on a log scale, and a report that may not do so says what is missing") {
  const Folder folder;
  const auto calibrated = [&](const std::string& setting) {
    const auto outcome = folder.demcal({"calibrate", DEMCAL_SOURCE_DIR "/tests/cli/cases/speeds-over-a-decade", "--out",
                                        setting, "--json", "--quiet", "--no-scan", "--set", setting});
    return nlohmann::json::parse(outcome.out);
  };
  const nlohmann::json linear = calibrated("surrogate.stretch=false"), log = calibrated("controls.speed.scale=log"),
                       by_itself = calibrated("controls.speed.scale=linear");
  CHECK(linear["status"] == "warning");
  CHECK_THAT(linear["surrogates"][0]["remedy"].get<std::string>(), Contains("[controls.speed] scale = \"log\""));
  CHECK_THAT(by_itself["surrogates"][0]["notes"].dump(), Contains("speed is learnt as log("));
  const double truth[] = {0.35, 6.5};
  for (const nlohmann::json* report : {&log, &by_itself}) {
    CHECK((*report)["status"] == "ok");
    for (std::size_t k = 0; k < 2; ++k) {
      const nlohmann::json& parameter = (*report)["cases"][0]["parameters"][k];
      CHECK(parameter["verdict"] == "identified");
      CHECK(std::abs(parameter["mean"].get<double>() - truth[k]) < 2.5 * parameter["sd"].get<double>());
    }
  }
}

TEST_CASE("good runs that a surrogate accuses where it does not bend are named with the scale on which they agree") {
  // T = 2 + 8 friction + 60 (20 rpm / speed)^1.5 mN m over two decades of speed, which no stationary process follows.
  const Folder folder;
  const auto torque = [](double friction, double speed) {
    return 2.0 + 8.0 * friction + 60.0 * std::pow(20.0 / speed, 1.5);
  };
  const auto radical = [](int i, int base) {  // van der Corput
    double x = 0.0;
    for (double part = 1.0 / base; i > 0; i /= base, part /= base) x += part * (i % base);
    return x;
  };
  data::RandomStream random(8, data::Purpose::test);
  std::string runs = "friction,speed,torque,torque_se\n", bench = "speed,torque,torque_se\n";
  for (int i = 1; i <= 60; ++i) {
    const double friction = 0.1 + 0.7 * radical(i, 2), speed = 10.0 + 990.0 * radical(i, 3);
    const double truth = torque(friction, speed);
    runs += line({friction, speed, truth * (1.0 + 0.003 * random.normal()), 0.003 * truth});
  }
  for (const double speed : {100.0, 500.0, 900.0}) bench += line({speed, torque(0.4, speed), 0.1});
  fs::create_directories(folder.path / "study");
  std::string text = study("table = \"runs.csv\"\n");
  text.replace(text.find("low = 50\nhigh = 300"), 19, "low = 10\nhigh = 1000");
  folder.write("study/study.toml", text);
  folder.write("study/runs.csv", runs);
  folder.write("study/bench.csv", bench);

  CHECK_THAT(folder.says({"fit", "study", "--out", "linear", "--set", "surrogate.stretch=false"}, 2),
             Contains("On another scale they agree with all others") &&
                 Contains("Set [controls.speed] scale = \"log\" first. If they are wrong, leave them out:") &&
                 !Contains("Correct them"));
  const auto log = folder.demcal({"fit", "study", "--out", "log", "--set", "controls.speed.scale=log"});
  CHECK(log.status == 0);
  CHECK(log.err.find("contradict") == std::string::npos);
  // The surrogate finds that scale by itself.
  const auto stretched = folder.demcal({"fit", "study", "--out", "stretched"});
  CHECK(stretched.status == 0);
  CHECK_THAT(stretched.out + stretched.err, Contains("speed is learnt as log(") && !Contains("contradict"));
}
