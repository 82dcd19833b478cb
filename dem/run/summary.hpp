#pragma once
// What a run's series amounts to: means, errors, whether they are those of the steady flow, and why not.
#include "dem/run/run.hpp"

namespace dem {

/// Over the samples first ... first + count - 1, of which `window` make one of RunControl::window; in the order of
/// outputs(). Not a number where a series has none of them.
std::vector<data::SeriesMean> means_of(const Series& series, std::size_t first, std::size_t count, std::size_t window);

/// Of a run whose looks are these; all but the processor time. `sample` is the time of a sample, `turn` that of a turn of
/// the tool, 0 when it has none [s].
Summary summarise(const Case& c, double sample, double turn, const Series& series, const Looks& looks);

/// What of the summary its reader must know, one sentence each.
std::vector<std::string> warnings_of(const Case& c, const Summary& summary);

}  // namespace dem
