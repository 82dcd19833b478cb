#include "data/provenance.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <string_view>

#include "data/error.hpp"

namespace data {
namespace {

int level(std::string_view isa) { return isa == "x86-64-v4" ? 4 : isa == "x86-64-v3" ? 3 : 1; }

const char* best_isa() {
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (!v3) return "x86-64";
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? "x86-64-v4" : "x86-64-v3";
}

/// Ends the program (69) where the processor lacks the instruction set that it was built for: before main and before
/// static objects are made, as that may need it. With the C library alone: templates that other files share may have
/// been compiled for more than this processor has.
[[gnu::constructor(101)]] void require_processor() {
  const char* const best = best_isa();
  if (level(best) >= level(DEMCAL_ISA)) return;
  dprintf(STDERR_FILENO,
          "demcal: built for " DEMCAL_ISA
          ", but the processor runs only %s (build it again on this machine, or with -DDEMCAL_ISA=%s)\n",
          best, best);
  _exit(static_cast<int>(ExitStatus::missing_program));
}

}  // namespace

std::string program_version() { return DEMCAL_VERSION; }
std::string built_isa() { return DEMCAL_ISA; }
std::string processor_isa() { return best_isa(); }
bool processor_runs(const std::string& isa) { return level(best_isa()) >= level(isa); }

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::vector<std::pair<std::string, std::string>> provenance() {
  return {{"demcal", program_version()},
          {"instruction set", built_isa()},
          {"compiler", std::string("g++ ") + __VERSION__},
          {"written", utc_now()}};
}

}  // namespace data
