#include "data/provenance.hpp"

#include <array>
#include <ctime>

#include "data/error.hpp"

namespace data {
namespace {

int level(const std::string& isa) { return isa == "x86-64-v4" ? 4 : isa == "x86-64-v3" ? 3 : 1; }

}  // namespace

std::string program_version() { return DEMCAL_VERSION; }
std::string built_isa() { return DEMCAL_ISA; }

std::string processor_isa() {
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (!v3) return "x86-64";
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? "x86-64-v4" : "x86-64-v3";
}

bool processor_runs(const std::string& isa) { return level(processor_isa()) >= level(isa); }

void require_processor() {
  if (processor_runs(built_isa())) return;
  // Plain concatenation: library templates that other files share may have been compiled for more than this processor
  // has.
  std::string what = "this demcal was built for ";
  what += built_isa() + ", but the processor runs only " + processor_isa();
  throw InputError(ExitStatus::missing_program,
                   Problem{"", what, "build it again on this machine, or with -DDEMCAL_ISA=" + processor_isa()});
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
