// Known answers: the kat_vectors file of Random123 (D. E. Shaw Research), philox4x32 with 10 rounds.
#include "data/random.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using Words = std::array<std::uint32_t, 4>;

TEST_CASE("philox4x32-10 gives Random123's known answers") {
  CHECK(data::philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(data::philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(data::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("streams of another seed, purpose or index share no numbers") {
  std::set<std::uint64_t> seen;
  int drawn = 0;
  for (const std::uint64_t seed : {0ULL, 1ULL, 1ULL << 32}) {
    for (const auto purpose : {data::Purpose::run, data::Purpose::test}) {
      for (std::uint32_t index = 0; index < 5; ++index) {
        data::RandomStream random(seed, purpose, index);
        for (int i = 0; i < 100; ++i, ++drawn) seen.insert(random());
      }
    }
  }
  CHECK(seen.size() == static_cast<std::size_t>(drawn));
}

TEST_CASE("a stream is the same whenever it is made again") {
  data::RandomStream a(5, data::Purpose::sampler, 3), b(5, data::Purpose::sampler, 3);
  for (int i = 0; i < 50; ++i) CHECK(a() == b());
}

TEST_CASE("uniform and normal draws have the moments of their laws") {
  data::RandomStream random(1, data::Purpose::test);
  const int n = 200000;
  double u1 = 0.0, u2 = 0.0, z1 = 0.0, z2 = 0.0, z4 = 0.0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(), z = random.normal();
    REQUIRE(u > 0.0);
    REQUIRE(u < 1.0);
    u1 += u;
    u2 += u * u;
    z1 += z;
    z2 += z * z;
    z4 += z * z * z * z;
  }
  CHECK(u1 / n == Approx(0.5).margin(4.0 * std::sqrt(1.0 / 12.0 / n)));
  CHECK(u2 / n == Approx(1.0 / 3.0).margin(4.0 * std::sqrt(4.0 / 45.0 / n)));
  CHECK(z1 / n == Approx(0.0).margin(4.0 / std::sqrt(n)));
  CHECK(z2 / n == Approx(1.0).margin(4.0 * std::sqrt(2.0 / n)));
  CHECK(z4 / n == Approx(3.0).margin(4.0 * std::sqrt(96.0 / n)));
}

TEST_CASE("no two places of the program draw the same stream") {
  // Every RandomStream and child seed names its purpose, and its index where it has one, in one expression.
  const std::regex use(R"(Purpose::(\w+)\s*(?:,([^;]*?))?\)[;,){])");
  std::map<std::string, std::set<std::string>> places;
  for (const char* room : {"data", "dem", "surrogate", "uq", "campaign", "cli"}) {
    const std::filesystem::path root = std::filesystem::path(DEMCAL_SOURCE_DIR) / room;
    if (!std::filesystem::exists(root)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      const std::string code = text.str();
      for (auto at = std::sregex_iterator(code.begin(), code.end(), use); at != std::sregex_iterator(); ++at) {
        std::string index = (*at)[2].str();
        index.erase(std::remove_if(index.begin(), index.end(), [](char c) { return std::isspace(c) != 0; }),
                    index.end());
        // An index that is counted covers all of them.
        const bool constant =
            !index.empty() && std::all_of(index.begin(), index.end(), [](char c) { return std::isdigit(c) != 0; });
        places[(*at)[1].str() + " " + (index.empty() ? "0" : constant ? index : "counted")].insert(entry.path());
      }
    }
  }
  CHECK(places.size() > 15);
  // A rig has one packing: that of a slice, or that of its own shape.
  places["packing 0"].erase((std::filesystem::path(DEMCAL_SOURCE_DIR) / "dem" / "rig" / "slice.cpp").string());
  std::map<std::string, std::set<std::string>> by_purpose;
  for (const auto& [stream, files] : places) {
    INFO(stream);
    CHECK(files.size() == 1);
    by_purpose[stream.substr(0, stream.find(' '))].insert(stream);
  }
  for (const auto& [purpose, streams] : by_purpose) {
    INFO(purpose << ": a counted index beside a constant one may be it");
    CHECK((streams.size() == 1 || streams.count(purpose + " counted") == 0));
  }
}

TEST_CASE("child seeds of jobs differ from each other and from their parent's") {
  std::set<std::uint64_t> seeds = {7};
  for (std::uint32_t index = 0; index < 100; ++index) {
    seeds.insert(data::child_seed(7, data::Purpose::test, index));
    seeds.insert(data::child_seed(8, data::Purpose::test, index));
  }
  CHECK(seeds.size() == 201);
}
