#pragma once
// The kinds of findings, each with its texts (data/texts.hpp).
#include "data/texts.hpp"

namespace uq {

/// The verdict on a parameter (uq/verdict/verdict.hpp).
enum class Verdict { identified, weakly_identified, several_values, not_identified, does_not_fit };

/// Why a parameter is not known (uq/verdict/reason.hpp).
enum class Reason {
  structural,
  practical,
  surrogate,
  one_sided,
  bound,
  no_influence,
  unsupported,
  range_of_another,
  common_error,
  traded
};

/// An error that all readings of a case share (uq/posterior/common_share.hpp): a meter's offset or gain that is
/// sampled, or its common error, the rig's scale, a control's true setting, what the model leaves out.
enum class CommonErrorKind { offset, gain, scale, setting, meter, discrepancy };

/// How far a surrogate can be trusted (surrogate/validation.hpp).
enum class SurrogateWord { good, caution, unusable };

/// The relation between traded parameters (uq/verdict/combination.hpp).
enum class CombinationForm { none, product, sum, curved };

/// The kind of a measurement that could be made next (uq/plan).
enum class CandidateKind { repeat, setting, output };

using data::to_text;

}  // namespace uq

template <>
inline constexpr std::array data::texts_of<uq::Verdict> = {"identified", "weakly identified", "several values",
                                                           "not identified", "model does not fit"};
template <>
inline constexpr std::array data::texts_of<uq::Reason> = {
    "structural",   "practical",   "surrogate",        "one-sided",    "bound",
    "no influence", "unsupported", "range of another", "common error", "traded"};
template <>
inline constexpr std::array data::texts_of<uq::CommonErrorKind> = {"offset",  "gain",  "scale",
                                                                   "setting", "meter", "discrepancy"};
template <>
inline constexpr std::array data::texts_of<uq::SurrogateWord> = {"good", "caution", "unusable"};
template <>
inline constexpr std::array data::texts_of<uq::CombinationForm> = {"none", "product", "sum", "curved"};
template <>
inline constexpr std::array data::texts_of<uq::CandidateKind> = {"repeat", "setting", "output"};
