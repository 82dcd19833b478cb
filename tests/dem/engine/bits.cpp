// Same bits for any number of threads, after stop and restart and with every instruction set, for each family of
// contact laws and for a mixture.
#include "data/provenance.hpp"
#include "data/random.hpp"
#include "dem/contact/isa.hpp"
#include "tests/dem/families.hpp"

namespace {

/// Enough spheres for several chunks, thrown about in the slice, so that contacts come and go within few steps.
dem::Setup stirred(const dem::Case& c, int threads) {
  dem::Case many = c;
  many.rig.fill = 4500.0;
  many.material.diameter = 0.6e-3;
  many.rig.angular_velocity = 100.0;
  dem::Setup s = scene::rig(many, 1, 0, threads);
  data::RandomStream random(3, data::Purpose::test);
  for (std::size_t i = 0; i < s.spheres.position.size(); ++i) {
    s.spheres.velocity.push_back({0.5 * random.normal(), 0.5 * random.normal(), 0.5 * random.normal()});
    s.spheres.spin.push_back({500.0 * random.normal(), 500.0 * random.normal(), 500.0 * random.normal()});
  }
  s.time_step = 5e-6;
  return s;
}

/// The same with three sizes and two materials.
dem::Setup mixed(const dem::Case& c, int threads) {
  dem::Setup s = stirred(c, threads);
  const std::size_t n = s.spheres.position.size();
  dem::BedCoefficients bed = dem::make_bed(c, s.bodies.size());
  bed.materials = 2;
  bed.equal_mass = bed.equal_radius = 0.0;
  dem::PairCoefficients rough = bed.grain[0], smooth = bed.wall[0];
  rough.friction = 0.8;
  smooth.friction = 0.1;
  bed.grain = {bed.grain[0], rough, rough, smooth};
  const std::vector<dem::PairCoefficients> wall = bed.wall;
  bed.wall.insert(bed.wall.end(), wall.size(), smooth);
  s.laws = dem::make_force_pass(bed);
  s.spheres.radius.resize(n);
  s.spheres.density.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    s.spheres.radius[i] = (i % 3 == 0 ? 0.3e-3 : i % 3 == 1 ? 0.25e-3 : 0.2e-3);
    s.spheres.material.push_back(i % 2);
    s.spheres.density[i] = i % 2 == 0 ? 6090.0 : 2500.0;
  }
  return s;
}

template <class Make>
void check_bits(Make make) {
  constexpr int steps = 240;
  std::vector<std::uint64_t> hashes;
  dem::State middle;
  for (const int threads : {1, 2, 4}) {
    dem::Simulation s(make(threads));
    std::uint64_t contacts = 0;
    for (int k = 0; k < steps; ++k) {
      if (threads == 1 && k == 101) middle = s.state();
      s.step();
      contacts += s.sums().contacts + s.sums().wall_contacts;
    }
    REQUIRE(s.state().chunks() >= 4);
    REQUIRE(s.state().rebuilds > 3);
    REQUIRE(contacts > 10000);
    hashes.push_back(scene::hash(s.state()));
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
  dem::Simulation resumed(make(2));
  resumed.restore(middle);
  for (int k = 101; k < steps; ++k) resumed.step();
  CHECK(scene::hash(resumed.state()) == hashes[0]);
}

}  // namespace

TEST_CASE("each family of laws has the same bits with 1, 2 and 4 threads and after a restart", "[slow]") {
  for (const auto& [name, c] : scene::families(0.7)) {
    INFO(name);
    check_bits([&](int threads) { return stirred(c, threads); });
  }
}

TEST_CASE("mixtures of sizes and materials have the same bits with 1, 2 and 4 threads and after a restart", "[slow]") {
  for (const auto& [name, c] : scene::families(0.7)) {
    INFO(name);
    check_bits([&](int threads) { return mixed(c, threads); });
  }
}

TEST_CASE("pairs that sleep miss nothing: looking at all pairs in every step gives the same bits") {
  const auto [name, c] = scene::families(0.7)[GENERATE(0, 1)];
  INFO(name);
  dem::Simulation sleeping(stirred(c, 1)), waking(stirred(c, 1));
  std::uint64_t contacts = 0;
  for (int k = 0; k < 150; ++k) {
    waking.restore(waking.state());
    waking.step();
    sleeping.step();
    contacts += sleeping.sums().contacts;
  }
  REQUIRE(contacts > 5000);
  REQUIRE(sleeping.state().rebuilds > 2);
  CHECK(scene::hash(sleeping.state()) == scene::hash(waking.state()));
}

TEST_CASE("every instruction set gives the same bits, of the state and of the sums") {
  struct Pin {
    std::string before = dem::isa();
    ~Pin() { dem::pin_isa(before); }
  } const pin;
  for (const auto& [name, c] : scene::families(0.7)) {
    for (const bool equal : {true, false}) {
      INFO(name << (equal ? "" : ", mixed"));
      std::vector<std::uint64_t> hashes;
      for (const std::string& isa : dem::isas()) {
        dem::pin_isa(isa);
        dem::Simulation s(equal ? stirred(c, 1) : mixed(c, 1));
        std::vector<double> sums;
        std::uint64_t contacts = 0;
        for (int k = 0; k < 60; ++k) {
          s.step();
          const dem::StepSums& now = s.sums();
          contacts += now.contacts + now.wall_contacts;
          sums.insert(sums.end(), {now.virial, now.dissipated, now.tool_work, now.max_overlap});
          for (const dem::BodyLoad& b : now.body)
            sums.insert(sums.end(), {b.force.x, b.force.y, b.force.z, b.torque.x, b.torque.y, b.torque.z, b.slip,
                                     static_cast<double>(b.contacts)});
        }
        REQUIRE(contacts > 2000);
        hashes.push_back(XXH3_64bits_withSeed(sums.data(), sums.size() * sizeof sums[0], scene::hash(s.state())));
      }
      REQUIRE(!hashes.empty());
      CHECK(hashes == std::vector<std::uint64_t>(hashes.size(), hashes[0]));
    }
  }
}
