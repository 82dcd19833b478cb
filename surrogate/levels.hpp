#pragma once
// Validation of a design of few levels. Where an input takes a handful of values only, leaving out single runs says
// nothing about the function between the values: the other runs of the same level stand in for the one left out. Each
// inner level is therefore left out as a whole and predicted from the others. The first and the last level, which would
// be extrapolation, always stay. Two levels have no inner one: nothing is known between them, and that is said.
#include <vector>

#include "surrogate/held_out.hpp"

namespace surrogate {

constexpr int levels_most = 8;  ///< an input with more values is no factor of a factorial design

/// The checks of every input of few values (at most levels_most, and on average three runs a value). `training` is on
/// the model's own scale.
std::vector<LevelCheck> check_levels(const TrainingSet& training, const HeldOutModel& model);

/// Pairs of inputs of which no run changes both from the values that most runs have, as in a design of one factor at a
/// time. The runs cannot tell how the effect of one depends on the other, and no run left out can show it.
std::vector<ApartPair> pairs_apart(const TrainingSet& training);

/// What the checks found, one sentence each.
std::vector<std::string> level_notes(const std::vector<LevelCheck>& checks);

/// Whether a check leaves the surrogate in doubt between the levels.
bool doubtful(const LevelCheck& check, const ValidationThresholds& thresholds);

}  // namespace surrogate
