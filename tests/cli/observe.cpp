// A raw log made into observations, as a user does.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data/csv.hpp"
#include "data/random.hpp"
#include "tests/cli/program.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using test::Folder;

namespace {

/// 20 s at each of three speeds, 100 samples a second: torque `at_rest` + `slope` * rpm with independent noise.
std::string log_text(double at_rest, double slope, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test);
  std::string text = "time [s],torque [mN m],rpm\n";
  for (int i = 0; i < 6000; ++i) {
    const double rpm = 100.0 * (1 + i / 2000);
    text += fmt::format("{:.2f},{:.6f},{:.2f}\n", 0.01 * i, at_rest + slope * rpm + 0.05 * random.normal(), rpm);
  }
  return text;
}

void write(const Folder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path / name) << text;
}

}  // namespace

TEST_CASE("a log becomes observations that a calibration reads, with a picture") {
  const Folder folder;
  write(folder, "log.csv", log_text(2.0, 0.001, 1));
  write(folder, "empty.csv", log_text(0.3, 0.0005, 2));
  const auto outcome =
      folder.demcal({"observe", "log.csv", "--idle-log", "empty.csv", "--unit", "uN m", "--out", "seen/bench.csv"});
  CHECK(outcome.status == 0);
  CHECK(fs::file_size(folder.path / "seen" / "bench.svg") > 1000);
  const data::Csv csv = data::read_csv((folder.path / "seen" / "bench.csv").string());
  REQUIRE(csv.rows.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double rpm = csv.number(csv.rows[i], csv.column("rpm"));
    const double error = csv.number(csv.rows[i], csv.column("torque_se"));
    CHECK(rpm == Approx(100.0 * static_cast<double>(i + 1)));
    CHECK(error == Approx(50.0 * std::sqrt(2.0 / 2000.0)).epsilon(0.3));  // of the log's mean and of the idle one's
    CHECK(std::abs(csv.number(csv.rows[i], csv.column("torque")) - (1700.0 + 0.5 * rpm)) < 4.0 * error);
  }
}

TEST_CASE("observations keep their units where a spreadsheet saves them again, and the JSON names them") {
  const Folder folder;
  std::string text = "time [s],torque [N m],omega [rad/s]\n";
  data::RandomStream random(9, data::Purpose::test);
  for (int i = 0; i < 600; ++i)
    text += fmt::format("{:.1f},{:.6f},15.707963\n", 0.1 * i, 0.01 + 1e-4 * random.normal());
  write(folder, "log.csv", text);
  const auto outcome = folder.demcal({"observe", "log.csv", "--rpm", "omega", "--control", "speed", "--json"});
  REQUIRE(outcome.status == 0);
  const nlohmann::json row = nlohmann::json::parse(outcome.out)["rows"][0];
  CHECK(row["speed"].get<double>() == Approx(15.708).epsilon(1e-4));
  CHECK(row["speed_unit"] == "rad/s");
  CHECK(row["unit"] == "N m");
  // LibreOffice parts a comment's fields like those of a row, and quotes what holds a comma.
  std::string saved = folder.read("log-observed.csv");
  const std::size_t units = saved.find("# units: "), end = saved.find('\n', units), comma = saved.find(", ", units);
  REQUIRE(comma < end);
  saved.replace(comma, end - comma, ";\"" + saved.substr(comma + 2, end - comma - 2) + "\"");
  for (std::size_t at = saved.find('\n', units); at < saved.size(); ++at)
    if (saved[at] == ',') saved[at] = ';';
  write(folder, "saved.csv", saved);
  const data::Csv csv = data::read_csv((folder.path / "saved.csv").string());
  CHECK(csv.unit(csv.column("speed"), data::parse_unit("rpm")).factor == Approx(1.0));
  CHECK(csv.unit(csv.column("torque"), data::parse_unit("mN m")).factor == Approx(1.0));
}

TEST_CASE("an idle torque given as one value is an error common to all rows, and the file says how to state it") {
  const Folder folder;
  write(folder, "log.csv", log_text(2.0, 0.0, 3));
  REQUIRE(folder.demcal({"observe", "log.csv", "--idle", "0.5", "--idle-error", "0.1", "--quiet"}).status == 0);
  const data::Csv csv = data::read_csv((folder.path / "log-observed.csv").string());
  CHECK(csv.number(csv.rows[0], csv.column("torque")) == Approx(1.5).epsilon(0.01));
  CHECK(csv.number(csv.rows[0], csv.column("torque_se")) < 0.01);
  CHECK_THAT(csv.comments.at(3), Contains("common_error = \"0.1 mN m\""));
}

TEST_CASE("a log of which much belongs to no speed says so, with the option for a noisy tachometer") {
  const Folder folder;
  data::RandomStream random(4, data::Purpose::test);
  std::string noisy = "time [s],torque [mN m],rpm\n";
  for (int i = 0; i < 600; ++i)
    noisy += fmt::format("{:.1f},{:.4f},{:.3f}\n", 0.1 * i, 2.5 + 0.05 * random.normal(),
                         (i < 300 ? 50.0 : 100.0) * (1.0 + 0.03 * random.normal()));
  write(folder, "noisy.csv", noisy);
  CHECK_THAT(folder.demcal({"observe", "noisy.csv", "--shortest", "3"}).err,
             Contains("s of turning belong to no speed") && Contains("--tolerance 10"));
  const auto wide = folder.demcal({"observe", "noisy.csv", "--tolerance", "12", "--out", "wide.csv"});
  CHECK(wide.status == 0);
  CHECK(wide.err.find("belong to no speed") == std::string::npos);
  CHECK(data::read_csv((folder.path / "wide.csv").string()).rows.size() == 2);
}

TEST_CASE("what is left out of a hold stands in the words and in the JSON") {
  const Folder folder;
  data::RandomStream random(6, data::Purpose::test);
  std::string text = "time [s],torque [mN m],rpm\n";
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{:.2f},{:.5f},100\n", 0.01 * i,
                        (i < 800 ? 2.5 : 2.0) + (i == 1200 ? 30.0 : 0.0) + 0.05 * random.normal());
  write(folder, "log.csv", text);
  const auto outcome = folder.demcal({"observe", "log.csv", "--without-spikes", "--json"});
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.err, Contains("note: ") && Contains("are left out as start-up") &&
                              Contains("mN m at 12 s, left out of the mean"));
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  CHECK(json["notes"].size() == 2);
  CHECK(json["rows"][0]["left_out_s"].get<double>() == Approx(8.0).margin(0.2));
  CHECK(json["rows"][0]["torque"].get<double>() == Approx(2.0).epsilon(0.005));
}

TEST_CASE("what the meter reads at standstill is said where nothing is taken off") {
  const Folder folder;
  const auto write_log = [&](const std::string& name, double zero) {
    data::RandomStream random(7, data::Purpose::test);
    std::string text = "time [s],torque [mN m],rpm\n";
    for (int i = 0; i < 600; ++i)
      text += fmt::format("{:.1f},{:.5f},{}\n", 0.1 * i, zero + (i < 200 ? 0.0 : 2.0) + 0.05 * random.normal(),
                          i < 200 ? 0 : 50);
    write(folder, name, text);
  };
  write_log("shifted.csv", 0.3);
  const auto shifted = folder.demcal({"observe", "shifted.csv"});
  CHECK(shifted.status == 2);
  CHECK_THAT(shifted.err, Contains("at standstill the meter reads 0.") && Contains("--idle 0."));
  const auto mended = folder.demcal({"observe", "shifted.csv", "--idle", "0.3", "--out", "mended.csv"});
  CHECK(mended.status == 0);
  CHECK(mended.err.find("at standstill") == std::string::npos);
  write_log("zeroed.csv", 0.0);
  CHECK(folder.demcal({"observe", "zeroed.csv"}).status == 0);
  CHECK_THAT(folder.says({"observe", "zeroed.csv", "--idle", "5", "--out", "negative.csv"}, 2),
             Contains("every torque is negative") && Contains("so much idle torque"));
}

TEST_CASE("the unit of times that nothing states is said, and stands in the JSON") {
  const Folder folder;
  std::string text = log_text(2.0, 0.0, 8);
  text.replace(0, text.find(','), "time");
  write(folder, "log.csv", text);
  const auto outcome = folder.demcal({"observe", "log.csv", "--json"});
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.err, Contains("note: time taken as s, as nothing states its unit: 6000 samples every 0.01 s"));
  CHECK(nlohmann::json::parse(outcome.out)["notes"].size() == 1);
  CHECK(folder.demcal({"observe", "log.csv", "--time-unit", "s", "--out", "o.csv"}).err.find("taken as s") ==
        std::string::npos);
}

TEST_CASE("a log that cannot be used is refused with what to do, and is never overwritten") {
  const Folder folder;
  write(folder, "log.csv", log_text(2.0, 0.0, 4));
  write(folder, "empty.csv", "time,torque [N m],rpm\n0,0,50\n4,0,50\n8,0,50\n12,0,50\n");
  auto outcome = folder.demcal({"observe", "log.csv", "--shortest", "30"});
  CHECK(outcome.status == 65);
  CHECK_THAT(outcome.err, Contains("no stretch of 30 s") && Contains("--shortest"));
  outcome = folder.demcal({"observe", "log.csv", "--idle-log", "empty.csv"});
  CHECK(outcome.status == 65);
  CHECK_THAT(outcome.err, Contains("was not run at 100 rpm (its plateaus: 50)"));
  CHECK(folder.demcal({"observe", "log.csv", "--out", "log.csv"}).status == 73);
  CHECK(folder.demcal({"observe", "absent.csv"}).status == 66);
  CHECK(folder.demcal({"observe", "log.csv", "--idle", "1", "--idle-log", "empty.csv"}).status == 64);
}

TEST_CASE("a machine that stands still within a hold, and a zero that moves, are said") {
  const Folder folder;
  std::string idle = "time [s],torque [mN m],rpm\n", moves = idle;
  for (int i = 0; i < 1000; ++i) {
    const double noise = 0.05 * std::sin(1.7 * i) + 0.03 * std::sin(0.61 * i);
    idle += fmt::format("{:.1f},{:.4f},100\n", 0.1 * i, (i >= 400 && i < 600 ? 0.0 : 12.0) + noise);
    const int part = i / 200;
    moves += fmt::format("{:.1f},{:.4f},{}\n", 0.1 * i, (part % 2 == 0 ? 0.35 * part : 12.0) + noise,
                         part % 2 == 0 ? 0 : 100);
  }
  folder.write("idle.csv", idle);
  folder.write("moves.csv", moves);
  CHECK_THAT(folder.demcal({"observe", "idle.csv"}).err, Contains("falls to nearly nothing from 40 to 59.9 s"));
  const auto moved = folder.demcal({"observe", "moves.csv"});
  CHECK_THAT(moved.err, Contains("its zero moves") && !Contains("take it off (--idle"));
}

TEST_CASE("a speed that is held twice, at torques further apart than their errors, is said") {
  const Folder folder;
  const auto log = [](double second) {
    data::RandomStream random(5, data::Purpose::test);
    std::string text = "time [s],torque [mN m],rpm\n";
    for (int i = 0; i < 6000; ++i) {
      const int hold = i / 2000;
      const double torque = hold == 1 ? 6.0 : (hold == 0 ? 5.0 : second);
      text += fmt::format("{:.2f},{:.6f},{}\n", 0.01 * i, torque + 0.05 * random.normal(), hold == 1 ? 200 : 100);
    }
    return text;
  };
  write(folder, "apart.csv", log(5.5));
  write(folder, "alike.csv", log(5.001));
  const auto apart = folder.demcal({"observe", "apart.csv"}), alike = folder.demcal({"observe", "alike.csv"});
  CHECK(apart.status == 2);
  CHECK_THAT(apart.err, Contains("100 rpm is held 2 times") && Contains("standard errors apart"));
  CHECK(alike.status == 0);
}
