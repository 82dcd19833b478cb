#pragma once
// Validation of a design of few levels. Where an input takes a handful of values only, leaving out single runs sees
// nothing of what happens between these: the other runs of the same level stand in for the one left out. Each inner
// level is therefore left out as a whole and predicted from the others; the first and the last, which would be
// extrapolation, always stay. Two levels have no inner one: nothing is known between them, and that is said.
#include <vector>

#include "surrogate/held_out.hpp"

namespace surrogate {

constexpr int levels_most = 8;  ///< an input with more values is no factor of a factorial design

/// Of every input of few values (at most levels_most, and on average three runs a value). `training` is on the model's
/// own scale.
std::vector<LevelCheck> check_levels(const TrainingSet& training, const HeldOutModel& model);

/// Pairs of inputs that no run moves together from where most runs hold them, as in a design of one factor at a time: how
/// one's effect depends on the other is not in the runs, and no run left out can show it.
std::vector<ApartPair> pairs_apart(const TrainingSet& training);

/// What the checks found, one sentence each.
std::vector<std::string> level_notes(const std::vector<LevelCheck>& checks);

/// Whether a check leaves the surrogate in doubt between the levels.
bool doubtful(const LevelCheck& check, const ValidationThresholds& thresholds);

}  // namespace surrogate
