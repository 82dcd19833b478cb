#pragma once
// What a run's series amounts to: means, errors, whether they are those of the steady flow, and why not.
#include "dem/run/run.hpp"

namespace dem {

/// Of a run whose looks are these; all but the processor time.
Summary summarise(const Case& c, double turn, const Series& series, const Looks& looks);

/// What of the summary its reader must know, one sentence each.
std::vector<std::string> warnings_of(const Case& c, const Summary& summary);

}  // namespace dem
