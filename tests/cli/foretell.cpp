// What check, simulate and train say of a rig before anything runs, on rigs that are nonsense in one way each.
#include <fmt/core.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
using test::with_settings;
namespace fs = std::filesystem;

namespace {

const std::string cases = DEMCAL_SOURCE_DIR "/tests/cli/cases/";
const std::string quick = DEMCAL_SOURCE_DIR "/data/quick";

test::Outcome check(const Folder& folder, const std::string& study, const std::vector<std::string>& set = {}) {
  return folder.demcal(with_settings({"check", study}, set));
}

}  // namespace

TEST_CASE("rigs whose runs would be nonsense are refused by check and by simulate, with place, value and remedy") {
  const Folder folder;
  const std::vector<std::pair<std::string, std::vector<std::string>>> wrong{
      {"paddle-above-bed", {"rig.mesh.paddle", "never touches the powder", "raise the fill"}},
      {"axis-elsewhere", {"rig.mesh.paddle", "leaves the box as it turns", "give rig.mesh.paddle.point"}},
      {"fill-outside", {"rig.region", "no wall is under them", "inside the vessel"}}};
  for (const auto& [name, words] : wrong) {
    for (const char* command : {"check", "simulate"}) {
      const auto outcome = folder.demcal({command, cases + name});
      INFO(name << ": " << outcome.err);
      CHECK(outcome.status == 78);
      for (const std::string& word : words) CHECK_THAT(outcome.err, Contains(word));
    }
  }
  CHECK(folder.demcal({"train", cases + "paddle-above-bed"}).status == 78);
}

TEST_CASE("the same rigs put right are not refused") {
  const Folder folder;
  const auto fuller = check(folder, cases + "paddle-above-bed", {"rig.fill=3000"});
  INFO(fuller.err);
  CHECK((fuller.status == 0 || fuller.status == 2));
  CHECK_THAT(fuller.err, !Contains("dips only"));
  CHECK_THAT(check(folder, cases + "paddle-above-bed", {"rig.fill=1500"}).err, Contains("paddle dips only"));
  const auto turned = check(folder, cases + "axis-elsewhere", {R"(rig.mesh.paddle.point=["40 mm", "25 mm", "0 mm"])"});
  INFO(turned.err);
  CHECK_THAT(turned.err, !Contains("leaves the box"));
  const auto inside =
      check(folder, cases + "fill-outside",
            {R"(rig.region={ from = ["0 mm", "0 mm", "0 mm"], to = ["20 mm", "0 mm", "0 mm"], radius = "11 mm" })"});
  INFO(inside.err);
  CHECK((inside.status == 0 || inside.status == 2));
}

TEST_CASE("check says how many spheres, their fill, gaps, Bond number, time step, memory and time, also as JSON") {
  const Folder folder;
  const auto outcome = folder.demcal({"check", quick, "--json"});
  INFO(outcome.err);
  for (const char* word : {"480 spheres", "fill: ", "gap between blade and trough: 2.4 mm, 2.7 of the largest sphere",
                           "Bond number", "time step", "MB", "18 runs missing", "measured on this machine"})
    CHECK_THAT(outcome.err, Contains(word));
  const nlohmann::json one = nlohmann::json::parse(outcome.out)["materials"][0];
  CHECK(one["spheres"] == 480);
  CHECK(one["missing_runs"] == 18);
  CHECK(one["fill"].get<double>() > 0.2);
  CHECK(one["fill"].get<double>() < 1.0);
  CHECK(one["cpu_seconds_at_most"].get<double>() ==
        Approx(one["steps"].get<double>() * 480 / one["particle_steps_per_second"].get<double>()));
}

TEST_CASE("a slice's nonsense is refused or warned of") {
  const Folder folder;
  const auto refused = [&](std::vector<std::string> set) {
    const auto outcome = check(folder, quick, set);
    INFO(outcome.err);
    CHECK(outcome.status == 78);
    return outcome.err;
  };
  CHECK_THAT(refused({"rig.fill=\"60 g\""}), Contains("study.toml:15: rig.fill") || Contains("--set"));
  CHECK_THAT(refused({"rig.fill=\"0.7 g\"", "materials.powder.density=\"2.5 kg/m3\""}), Contains("blade's top"));
  CHECK_THAT(refused({"rig.trough_radius=\"0.3 mm\"", "rig.blade_radius=\"0.2 mm\"", "rig.shaft_radius=\"0.1 mm\""}),
             Contains("rig.trough_radius"));
  CHECK_THAT(refused({"rig.fill=40"}), Contains("never touches the powder"));
  const auto above = check(folder, quick, {"rig.fill=130"});  // whose torque is exactly 0
  INFO(above.err);
  CHECK(above.status == 2);
  CHECK_THAT(above.err, Contains("mm above the bed: it may never touch the powder"));
  const auto narrow = check(folder, quick, {"rig.trough_radius=\"4 mm\"", "rig.fill=200"});
  INFO(narrow.err);
  CHECK(narrow.status == 2);
  CHECK_THAT(narrow.err, Contains("the gap between blade and trough is 0.4 mm, 0.45 of the largest sphere"));
  // Of 320 spheres the blade touches the upper row: torque fell from 1.7 to 1.2 uN m within 6 s of steady turning.
  const auto skimmed = check(folder, quick, {"rig.fill=320"});
  INFO(skimmed.err);
  CHECK(skimmed.status == 2);
  CHECK_THAT(skimmed.err, Contains("the blade dips only") && Contains("raise the fill"));
  CHECK_THAT(check(folder, quick, {}).err, !Contains("dips only"));
  const auto light = check(folder, quick, {"materials.powder.density=\"2.5 kg/m3\""});
  CHECK(light.status == 2);
  CHECK_THAT(light.err, Contains("2.5 g/cm3"));
}

TEST_CASE("a problem of the whole case stands at its key's line, and a value that was not read makes no second one") {
  const Folder folder;
  folder.study("quick");
  folder.replace("study/study.toml", "stiffness = \"300 N/m\"", "stiffness = \"0.01 N/m\"");
  CHECK_THAT(folder.says({"check", "study"}, 78), Contains("study.toml:23: contact.stiffness: lets"));
  folder.replace("study/study.toml", "fill = 480", "fill = \"50 %\"");
  CHECK_THAT(folder.says({"check", "study"}, 78),
             Contains("rig.fill") && !Contains("is zero") && !Contains("contact.stiffness"));
}

TEST_CASE("simulate says where the study has no runs, keeps another point's file, and goes back to it") {
  const Folder folder;
  const std::vector<std::string> brief{
      "run.start_up=\"0.004 s\"", "run.shortest=\"0.008 s\"", "run.shortest_turns=0",          "run.start_up_turns=0",
      "run.longest=\"0.012 s\"",  "run.window=\"0.5 ms\"",    "run.sample_interval=\"0.1 ms\""};
  const auto simulate = [&](const std::string& at) {
    const auto outcome = folder.demcal(with_settings({"simulate", quick, "--out", "out", "--json", "--at", at}, brief));
    INFO(outcome.err);
    REQUIRE((outcome.status == 0 || outcome.status == 2));
    return std::pair{nlohmann::json::parse(outcome.out), outcome.err};
  };
  const auto first = simulate("rpm=100");
  CHECK(first.first["notes"].empty());
  const std::string kept = folder.read("out/run.h5");
  const auto beyond = simulate("rpm=900");
  CHECK_THAT(beyond.second, Contains("rpm 900 rpm lies outside the study's range, 100 rpm to 300 rpm"));
  CHECK_THAT(beyond.second, Contains("run.h5 holds another run and is kept"));
  CHECK(folder.read("out/run.h5") == kept);
  CHECK(fs::exists(fs::path(beyond.first["file"].get<std::string>())));
  CHECK(simulate("rpm=900").first["outputs"] == beyond.first["outputs"]);
  CHECK(simulate("rpm=100").first["outputs"] == first.first["outputs"]);
  folder.write("out/run.h5", "not a run");
  simulate("rpm=100");
  CHECK(folder.read("out/run.h5") == "not a run");
}

TEST_CASE("frames of one run are one series: another run's go to a folder of their own, and none costs the run") {
  const Folder folder;
  const auto simulate = [&](const char* friction, const char* count, const char* out) {
    return folder.demcal(with_settings(
        {"simulate", quick, "--out", out, "--frames", count, "--at", fmt::format("rpm=100,friction={}", friction)},
        {"rig.fill=200", "run.start_up=\"0.004 s\"", "run.shortest=\"0.008 s\"", "run.shortest_turns=0",
         "run.start_up_turns=0", "run.longest=\"0.012 s\"", "run.window=\"0.5 ms\"",
         "run.sample_interval=\"0.1 ms\""}));
  };
  simulate("0.3", "3", "out");
  const std::string first = folder.read("out/frames/0000.vtkhdf");
  CHECK_THAT(simulate("0.4", "2", "out").err, Contains("frames/ holds other frames and is kept; these are in frames-"));
  CHECK_THAT(simulate("0.3", "2", "out").err, Contains("frames/ holds other frames"));  // another number of them
  CHECK(folder.read("out/frames/0000.vtkhdf") == first);
  CHECK(std::distance(fs::directory_iterator(folder.path / "out/frames"), {}) == 3);
  CHECK_THAT(simulate("0.3", "3", "out").err, !Contains("frames/ holds"));

  fs::create_directories(folder.path / "other/frames/0001.vtkhdf");
  const auto refused = simulate("0.3", "2", "other");
  CHECK(refused.status == 73);  // before anything is computed
  CHECK_THAT(refused.err, Contains("0001.vtkhdf"));
  CHECK_FALSE(fs::exists(folder.path / "other/run.h5"));
}

TEST_CASE("a torque that is exactly 0 is said, with status 2") {
  const Folder folder;
  // The mixer turns over powder that it reaches only with its lowest sphere's width: for so short a time it touches
  // none.
  const std::vector<std::string> words = with_settings(
      {"simulate", quick}, {"rig.fill=130", "run.settle=\"0.02 s\"", "run.start_up=\"1 ms\"", "run.shortest=\"2 ms\"",
                            "run.shortest_turns=0", "run.start_up_turns=0", "run.longest=\"4 ms\"",
                            "run.window=\"0.3 ms\"", "run.sample_interval=\"0.1 ms\""});
  CHECK_THAT(
      folder.says(words, 2),
      Contains("warning: the torque is exactly 0: no sphere touched mixer, or none with a lever about the axis"));
}

TEST_CASE("runs that would be too short are foretold once: amid the ranges, or at the slow end alone") {
  const Folder folder;
  const auto told = [&](const std::string& longest) {
    const std::string err = folder.demcal({"check", quick, "--set", "run.longest=\"" + longest + "\""}).err;
    std::size_t count = 0;
    for (std::size_t at = err.find("too short"); at != std::string::npos; at = err.find("too short", at + 1)) ++count;
    return std::pair{count, err};
  };
  CHECK(told("4 s").first == 0);
  const auto slow = told("2 s");  // 4 turns at 100 rpm take 2.4 s
  CHECK(slow.first == 1);
  CHECK_THAT(slow.second, Contains("at rpm 100 rpm") && Contains("takes up to 2.4 s"));
  const auto always = told("0.5 s");
  CHECK(always.first == 1);
  CHECK_THAT(always.second, !Contains("at rpm 50 rpm"));
}

TEST_CASE("a rig without parameters can be simulated, and what cannot be calibrated or planned is said") {
  const Folder folder;
  folder.study("quick");
  std::string text = folder.read("study/study.toml");
  text.erase(text.find("[parameters.friction]"), text.find("[controls.rpm]") - text.find("[parameters.friction]"));
  text.erase(text.find("[[observe]]"));
  folder.write("study/study.toml", text);
  const auto checked = folder.demcal({"check", "study"});
  CHECK(checked.status == 0);
  CHECK_THAT(checked.err, Contains("the study can simulate and train, and has nothing to calibrate"));
  const auto simulated = folder.demcal(
      with_settings({"simulate", "study", "--at", "rpm=200"}, {"run.longest=\"0.4 s\"", "run.start_up_turns=0.25"}));
  INFO(simulated.err);
  CHECK(simulated.status == 2);  // too short a run, and said so
  CHECK_THAT(simulated.out, Contains("torque") && Contains("uN m"));
  const auto planned = folder.demcal({"plan", "study", "--prior"});
  CHECK(planned.status == 78);
  CHECK_THAT(planned.err, Contains("names no parameter that is free"));

  // Without a control, either, there is one point, which is all of the design.
  text.erase(text.find("[controls.rpm]"), text.find("[outputs.torque]") - text.find("[controls.rpm]"));
  text.insert(text.find("[rig]") + 6, "rpm = \"100 rpm\"\n");
  folder.write("study/study.toml", text);
  const auto fixed = folder.demcal({"check", "study"});
  INFO(fixed.err);
  CHECK(fixed.status == 0);
  CHECK_THAT(fixed.out, Contains("1 run missing"));
  const auto designed = folder.demcal({"design", "study", "--runs", "5"});
  CHECK(designed.status == 0);
  CHECK_THAT(designed.out, Contains("1 point to simulate"));
  const auto named = folder.demcal({"simulate", "study", "--at", "rpm=200"});
  CHECK(named.status == 64);
  CHECK_THAT(named.err, Contains("--set rig.rpm"));
}

TEST_CASE("a range of speed that reaches a standstill is asked how long its runs near it take") {
  const Folder folder;
  folder.study("quick");
  const auto from = [&](const std::string& low) {
    return folder.demcal({"check", "study", "--set", "controls.rpm.low=" + low});
  };
  const auto rest = from("0"), both = from("-100");
  CHECK(rest.status == 2);
  CHECK_THAT(rest.err, Contains("runs would be too short") && !Contains("turns either way"));
  CHECK(both.status == 2);
  CHECK_THAT(both.err, Contains("turns either way"));
}

TEST_CASE("what follows --at and its values is not taken for one of them") {
  const Folder folder;
  folder.study("quick");
  const auto before = folder.demcal({"export", "--at", "rpm=200,friction=0.5", "study", "case", "--to", "liggghts"});
  INFO(before.err);
  CHECK(before.status != 64);
}
