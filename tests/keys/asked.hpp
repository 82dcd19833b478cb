#pragma once
// The keys that the readers ask for, found by letting them read studies in which every key stands.
#include <map>
#include <set>
#include <string>

#include "data/study_file.hpp"

namespace keys {

struct Asked {
  std::map<std::string, data::AskedKey> asked;  ///< by the name that the reference has for it
  std::set<std::string> looked_for;
};

/// "observe.bench.file" is "observe.file", "materials.NAME2.contact.friction" is "contact.friction".
std::string reference_name(const std::string& dotted);

Asked asked_by_the_readers();

}  // namespace keys
