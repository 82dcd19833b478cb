#include "uq/findings/results.hpp"

namespace uq {

const char* to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::identified:
      return "identified";
    case Verdict::weakly_identified:
      return "weakly identified";
    case Verdict::several_values:
      return "several values";
    case Verdict::not_identified:
      return "not identified";
    case Verdict::does_not_fit:
      break;
  }
  return "model does not fit";
}

}  // namespace uq
