#pragma once
// The summary of a run's series: means, errors, whether the means are those of the steady flow, and why not.
#include "dem/run/run.hpp"

namespace dem {

/// The means over the samples first ... first + count - 1, of which `window` make one of RunControl::window; in the
/// order of outputs(). NaN where a series has none of these samples.
std::vector<data::SeriesMean> means_of(const Series& series, std::size_t first, std::size_t count, std::size_t window);

/// The summary of a run with these looks; all but the processor time. `sample` is the time of a sample, `turn` that of
/// a turn of the tool, 0 when it has none [s].
Summary summarise(const Case& c, double sample, double turn, const Series& series, const Looks& looks);

/// Why the means are not known to be those of the steady flow, and what to do; empty where they are.
std::string unsteady_warning(const Summary& summary);

/// Warnings that the summary's reader must know, one sentence each.
std::vector<std::string> warnings_of(const Case& c, const Summary& summary);

}  // namespace dem
