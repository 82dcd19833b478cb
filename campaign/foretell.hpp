#pragma once
// The forecast of a study's runs, told before any is made: by `check` for each material, and by `simulate` and `train`
// before they start.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "campaign/point.hpp"
#include "dem/bed/derived.hpp"
#include "dem/forecast/effort.hpp"
#include "dem/forecast/forecast.hpp"

namespace campaign {

struct Foretold {
  dem::PreparedCase prepared;
  dem::Forecast forecast;
};
/// The forecast of the point's run. Throws data::InputError (78) with every problem that makes the run nonsense.
Foretold foretell(const Workspace& workspace, const Point& point);

/// Whether an input of the study changes the rig or its fill, so that each point has a forecast of its own.
bool changes_rig(const data::Study& study);

/// The cost of a run, by a measurement on this machine.
struct Cost {
  double steps = 0.0;    ///< time steps at most
  double seconds = 0.0;  ///< of processor time, at most
  double bytes = 0.0;
  dem::Effort effort;
  std::vector<std::string> warnings;  ///< warnings of a run beyond this machine's memory, or beyond a day
};
Cost cost_of(const dem::PreparedCase& prepared);

/// Throws data::InputError (78) where so many runs at a time need more memory than this machine has.
void require_memory(const Workspace& workspace, const Foretold& told, int jobs);

/// The problem of a run of this many spheres in a machine of this many bytes; nothing where it fits.
std::optional<data::Problem> too_large(const Cost& cost, std::int64_t spheres, int jobs, double machine);

/// Problems at the ends of each parameter's and control's range, the other inputs in the middle of theirs.
std::vector<std::string> problems_at_ends(const Workspace& workspace, const Point& middle);

/// A sentence on the points whose run ends, at run.longest, before it has measured what it must: none of them will
/// train anything. It tells of the worst of them; empty where there is none.
std::string too_short(const Workspace& workspace, const std::vector<Point>& points);

/// For each input of the point that the study's range does not cover, a sentence.
std::vector<std::string> outside_ranges(const Workspace& workspace, const Point& point);

nlohmann::json to_json(const Foretold& told, const Cost& cost);

}  // namespace campaign
