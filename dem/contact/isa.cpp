#include "dem/contact/isa.hpp"

#include <fmt/format.h>

#include "data/error.hpp"
#include "data/provenance.hpp"
#include "dem/contact/laws.hpp"

// One entry for each instruction set, which CMake lists as FORCES(name, entry).
#define FORCES(name, entry) \
  extern "C" void entry(const dem::BedCoefficients& bed, std::shared_ptr<const dem::ForcePass>& made);
#include "forces.inc"
#undef FORCES

namespace dem {
namespace {

struct Forces {
  const char* isa;
  void (*make)(const BedCoefficients& bed, std::shared_ptr<const ForcePass>& made);
};
#define FORCES(name, entry) {name, entry},
constexpr Forces built[] = {
#include "forces.inc"
};
#undef FORCES

const Forces* pinned = nullptr;

const Forces& in_use() {
  if (pinned != nullptr) return *pinned;
  const Forces* widest = nullptr;
  for (const Forces& f : built)
    if (data::processor_runs(f.isa)) widest = &f;
  if (widest == nullptr) pin_isa(data::processor_isa());  // says what there is
  return *widest;
}

}  // namespace

std::vector<std::string> isas() {
  std::vector<std::string> all;
  for (const Forces& f : built)
    if (data::processor_runs(f.isa)) all.emplace_back(f.isa);
  return all;
}

std::string isa() { return in_use().isa; }

void pin_isa(const std::string& name) {
  std::string why = fmt::format("this demcal was built without contact forces for {}", name);
  for (const Forces& f : built) {
    if (name != f.isa) continue;
    if (data::processor_runs(name)) {
      pinned = &f;
      return;
    }
    why = fmt::format("the processor does not run {}", name);
  }
  std::string choice;
  for (const std::string& one : isas()) choice += (choice.empty() ? "choose one of: " : ", ") + one;
  throw data::InputError(data::ExitStatus::missing_program,
                         {"--isa", why, choice.empty() ? "build it again, with -DDEMCAL_FORCES=x86-64" : choice});
}

std::shared_ptr<const ForcePass> make_force_pass(const BedCoefficients& bed) {
  std::shared_ptr<const ForcePass> made;
  in_use().make(bed, made);
  return made;
}

}  // namespace dem
