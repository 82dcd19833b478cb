#pragma once
// The files that demcal observe writes.
#include <filesystem>
#include <string>
#include <vector>

namespace cli {

/// The paths of the files beside the observations `out`: the picture, its script and its data.
std::vector<std::filesystem::path> observe_pictures(const std::filesystem::path& out);

/// Throws InputError, before anything is read or drawn: 64 when `out` has the name of one of the picture's files; 73
/// when a file in the place of one of them is a log that is read, or was not written by demcal, or `out` was edited
/// since.
void check_observe_targets(const std::filesystem::path& out, const std::vector<std::string>& logs);

}  // namespace cli
