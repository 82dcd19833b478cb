#pragma once
// The rule by which a run ends and by which a part of it is measured. It is decided at a few looks from the series
// alone, so that a run that was interrupted, or that went on for longer, is judged in the same way.
//
// Start-up. Dropped are run.start_up and run.start_up_turns at least, whichever is longer. Of what is left the front
// goes in steps of a tenth of it, up to half (P. Heidelberger, P. D. Welch, Oper. Res. 31 (1983) 1109), until torque,
// coordination and kinetic energy do not drift. Each is tested by data/steadiness.hpp, and together they call a steady
// run drifting with a chance of `drift_level` at most.
// A bed whose bonds align meanwhile (dem/engine/order.hpp) is not steady either, however steady its torque seems.
// Measured are run.shortest and run.shortest_turns at least.
//
// Looks. The first look comes after the shortest measurement, each later one after half as much again (Heidelberger and
// Welch 1983). At the first look that finds a steady run with a known error e after n samples, the length is fixed at
// n (e/e0)^2, e0 the wanted error (C. Stein, Ann. Math. Stat. 16 (1945) 243). The run stops there whatever its error
// is: stopping when an error happens to be small would bias it. A run that drifts there is looked at again after half
// as much again, and so is one too short for another output that it is made for (RunControl::known): a bed seen by a
// camera avalanches more slowly than its torque shows.
#include <cstddef>
#include <string_view>
#include <vector>

#include "data/steadiness.hpp"
#include "dem/case/case.hpp"

namespace dem {

struct Series;

/// The rule in samples since the tool began to turn.
struct LookRule {
  std::size_t start_up = 0;  ///< samples dropped at least
  std::size_t shortest = 1;  ///< samples measured at least
  std::size_t longest = 1;   ///< samples of start-up and measurement at most
  double standard_error = 0.02;
  std::vector<std::size_t> known;  ///< outputs whose errors are to be known, by their place in outputs()
  std::size_t window = 1;          ///< samples in one of RunControl::window
};
/// The rule of a run. `time` is the time of a sample, `turn` that of a turn of the tool, 0 when it has none [s].
LookRule look_rule(const RunControl& run, double time, double turn);

/// How much turning start-up and shortest measurement take together, where run.longest ends before; else 0 [s].
double turning_missed(const RunControl& run, double turn);

inline constexpr double drift_level = 0.05;

/// Version of this file's rule. It is raised when the rule comes to stop elsewhere, so that runs kept in files are
/// judged again.
inline constexpr int look_rule_version = 3;

/// The findings of a look.
struct Measured {
  data::FlowState state = data::FlowState::too_short;
  std::size_t first = 0, count = 0;  ///< samples measured: first ... first + count - 1
  data::SeriesMean torque;
  std::vector<double> drift_p;  ///< drift probabilities of torque, coordination, kinetic energy
  double bonds_rise = 0.0;      ///< rise of the bond order meanwhile; 0 where none is seen
  bool known = true;            ///< whether the errors of LookRule::known are known, where measured at all
};
/// Measures the first `samples` samples.
Measured measure(const LookRule& rule, const Series& series, std::size_t samples);

/// The state of the looks, which are taken one after the other.
struct Looks {
  std::size_t next = 0;  ///< samples at the next look
  bool planned = false;  ///< its length is fixed
  bool ended = false;
  Measured last;
};
Looks begin_looks(const LookRule& rule);
/// Takes the looks that the series reaches, if any.
void take_looks(const LookRule& rule, const Series& series, Looks& looks);

}  // namespace dem
