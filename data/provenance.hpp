#pragma once
// The origin of a result: program, instruction set, time. It holds no host or user names.
#include <string>
#include <utility>
#include <vector>

namespace data {

std::string program_version();  ///< "0.1.0"
std::string built_isa();        ///< "x86-64", "x86-64-v3" or "x86-64-v4": of the whole program but its contact forces

/// The best of these instruction sets that this processor runs.
std::string processor_isa();
bool processor_runs(const std::string& isa);

double machine_memory();  ///< bytes

std::string utc_now();  ///< "2026-11-23T05:04:00Z"

/// Names and values for a report or a file's head: demcal, instruction set, compiler, time.
std::vector<std::pair<std::string, std::string>> provenance();

}  // namespace data
