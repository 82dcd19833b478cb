#include "data/error.hpp"

namespace data {

std::string describe(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    if (!problem.place.empty()) text += problem.place + ": ";
    text += problem.what;
    if (!problem.remedy.empty()) text += " (" + problem.remedy + ")";
  }
  return text;
}

}  // namespace data
