// What `demcal export` writes for LIGGGHTS, and what it refuses; LIGGGHTS itself is run by tests/exchange/liggghts.py.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using test::Folder;

namespace {

const std::string quick = DEMCAL_SOURCE_DIR "/data/quick";

}  // namespace

TEST_CASE("an exported bed has the spheres, masses and pairs of the study's run") {
  const Folder folder;
  const auto outcome =
      folder.demcal({"export", quick, "case", "--to", "liggghts", "--json", "--quiet", "--at", "hamaker=0,rpm=120"});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const nlohmann::json answer = nlohmann::json::parse(outcome.out);
  for (const std::string file : answer["files"]) CHECK(fs::exists(folder.path / "case" / file));

  std::istringstream bed(folder.read("case/bed.data"));
  std::string line;
  while (std::getline(bed, line) && line != "Atoms") {
  }
  int spheres = 0;
  double mass = 0.0;
  int largest_type = 0;
  for (int id = 0, type = 0; bed >> id >> type;) {
    double diameter = 0.0, density = 0.0, x = 0.0, y = 0.0, z = 0.0;
    bed >> diameter >> density >> x >> y >> z;
    mass += density * 3.14159265358979 / 6.0 * diameter * diameter * diameter;
    largest_type = std::max(largest_type, type);
    ++spheres;
  }
  CHECK(spheres == 480);
  CHECK(largest_type == 3);  // its three sizes
  const auto told = nlohmann::json::parse(folder.demcal({"check", quick, "--json", "--quiet"}).out);
  CHECK(mass == Approx(told["materials"][0]["mass_kg"].get<double>()).epsilon(1e-9));

  const std::string script = folder.read("case/in.liggghts");
  CHECK_THAT(script, Contains("boundary p f f") && Contains("period 0.5\n") && Contains("v_torque file torque.dat"));
  // Half a second's turn about +x: the mixer alone.
  CHECK_THAT(script, Contains("move/mesh mesh m0 rotate") && !Contains("move/mesh mesh m1"));

  // Written again over its own files; not over those of others.
  CHECK(folder.demcal({"export", quick, "case", "--to", "liggghts", "--quiet", "--at", "hamaker=0"}).status == 0);
  folder.write("case/bed.data", "mine\n");
  CHECK(folder.demcal({"export", quick, "case", "--to", "liggghts", "--quiet", "--at", "hamaker=0"}).status == 73);
  CHECK(folder.read("case/bed.data") == "mine\n");
}

TEST_CASE(
    "each material of a Hertz bed is exported with its own moduli, and a wall that has none of its own is refused") {
  const Folder folder;
  fs::create_directories(folder.path / "mix");
  folder.write("mix/study.toml", R"(
[study]
name = "mix"
seed = 3
[rig]
shaft_radius = "1.5 mm"
blade_radius = "3.6 mm"
blade_thickness = "0.8 mm"
trough_radius = "6.0 mm"
pitch = "4.8 mm"
fill = 100
[materials.mix]
components = [{ material = "soft", mass_fraction = 0.5 }, { material = "stiff", mass_fraction = 0.5 }]
[materials.soft]
density = "3000 kg/m3"
diameter = "0.8 mm"
contact = { young_modulus = "2 MPa", poisson_ratio = 0.3 }
[materials.stiff]
density = "6090 kg/m3"
diameter = "0.9 mm"
contact = { young_modulus = "20 MPa", poisson_ratio = 0.2 }
[contact]
normal = "hertz"
poisson_ratio = 0.3
wall_young_modulus = "50 MPa"
[parameters.friction]
target = "contact.friction"
low = 0.1
high = 0.8
[outputs.torque]
unit = "uN m"
)");
  const std::vector<std::string> words{"export", "mix", "case", "--to", "liggghts", "--quiet"};
  CHECK_THAT(folder.says(words, 78), Contains("contact.wall_young_modulus: LIGGGHTS has no wall whose moduli are"));
  folder.replace("mix/study.toml", "poisson_ratio = 0.2", "poisson_ratio = 0.3");
  REQUIRE(folder.demcal(words).status == 0);
  // Larger spheres come first. The two walls follow.
  CHECK_THAT(folder.read("case/in.liggghts"),
             Contains("youngsModulus peratomtype 20000000 2000000 50000000 50000000\n") &&
                 Contains("poissonsRatio peratomtype 0.3 0.3 0.3 0.3\n"));
}

TEST_CASE("what LIGGGHTS has not is refused with the nearest, and a folder without its answer says what to do") {
  const Folder folder;
  const auto refuse = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"export", quick, "case", "--to", "liggghts"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = folder.demcal(words);
    CHECK(outcome.status == 78);
    CHECK_FALSE(fs::exists(folder.path / "case" / "in.liggghts"));
    return outcome.err;
  };
  CHECK_THAT(refuse({}), Contains("contact.cohesion: LIGGGHTS has no attraction") && Contains("cohesion sjkr"));
  CHECK_THAT(
      refuse({"--at", "hamaker=0", "--set", "contact.resistance=\"spring\"", "--set", "contact.rolling_friction=0.1"}),
      Contains("contact.resistance: LIGGGHTS has no rolling spring") && Contains("rolling_friction cdt"));

  CHECK_THAT(folder.demcal({"export", quick, "case"}).err, Contains("--to liggghts"));
  REQUIRE(folder.demcal({"export", quick, "case", "--to", "liggghts", "--quiet", "--at", "hamaker=0"}).status == 0);
  CHECK_THAT(folder.says({"export", quick, "case", "--collect"}, 66),
             Contains("torque.dat: is not there: LIGGGHTS has not run"));
  CHECK_THAT(folder.says({"export", quick, "case", "--collect", "--set", "contact.restitution=0.5"}, 65),
             Contains("other settings than the study has now"));
}

TEST_CASE("the mean that comes back is that of the samples after the start-up, and too few of them are refused") {
  const Folder folder;
  REQUIRE(folder.demcal({"export", quick, "case", "--to", "liggghts", "--quiet", "--at", "hamaker=0,rpm=300"}).status ==
          0);
  const auto write = [&](int samples, int gap = 0) {  // samples lacking from the 2000th on
    std::ostringstream torque, state;
    torque << "# Time-averaged data for fix torque\n# TimeStep v_torque\n";
    state << "# Time-averaged data for fix state\n# TimeStep c_coordination v_energy\n0 0 0\n";
    // Twice the torque for the first turn, then noise about 2 uN m that does not repeat.
    unsigned random = 1;
    for (int k = 1; k <= samples; ++k) {
      random = random * 1664525u + 1013904223u;
      const double noise = static_cast<double>(random >> 8) / 16777216.0 - 0.5;
      if (k >= 2000 && k < 2000 + gap) continue;
      torque << 71 * k << " " << (k < 1000 ? 4e-6 : 2e-6) * (1.0 + 0.2 * noise) << "\n";
      state << 71 * k << " " << 2.4 + 0.01 * noise << " " << 1e-7 * (1.0 + 0.1 * noise) << "\n";
    }
    folder.write("case/torque.dat", torque.str());
    folder.write("case/state.dat", state.str());
  };
  write(500);
  CHECK(folder.demcal({"export", quick, "case", "--collect", "--out", "back"}).status == 65);
  CHECK_FALSE(fs::exists(folder.path / "back" / "liggghts.csv"));
  write(12000);
  const auto outcome = folder.demcal({"export", quick, "case", "--collect", "--out", "back", "--json"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["state"] == "steady");
  CHECK(json["torque"]["mean"].get<double>() == Approx(2.0).epsilon(0.01));
  const std::string row = folder.read("back/liggghts.csv");
  write(12000, 1000);
  CHECK_THAT(folder.says({"export", quick, "case", "--collect", "--out", "back"}, 65),
             Contains("torque.dat:2002: step 213000 comes after 141929") && Contains("samples are lacking"));
  CHECK(folder.read("back/liggghts.csv") == row);
}
