#pragma once
// Findings about the runs' support: the posterior beside the runs, and the points to run next.
#include <map>
#include <string>
#include <vector>

namespace uq {

/// The runs of one input beside the posterior.
struct InputSupport {
  std::string name, unit;
  std::string material;                    ///< material whose runs these are
  double runs_low = 0.0, runs_high = 0.0;  ///< range that the runs cover
  double outside = 0.0;                    ///< share of the posterior beyond that range
  double gap = 0.0;                        ///< share of the posterior in a gap between runs
  double gap_low = 0.0, gap_high = 0.0;    ///< ends of the gap; equal: there is none
  bool operator==(const InputSupport&) const = default;
};

/// A point to run next.
struct NextRun {
  std::string material;
  std::map<std::string, double> point;  ///< every parameter and control of the study
};

/// Whether the runs speak where the posterior lies (uq/posterior/support.hpp).
struct SupportReport {
  bool known = false;                                             ///< the emulators are learnt from runs
  bool supported = true;                                          ///< the unsupported share is below its threshold
  double unsupported = 0.0;                                       ///< share of the draws
  double outside = 0.0, gap = 0.0, empty = 0.0, uncertain = 0.0;  ///< share of the draws that each test rejects
  double distance = 0.0;        ///< distance to the nearest run, in length scales; median over the draws
  double variance_ratio = 0.0;  ///< median over the draws: surrogate's variance over that without any runs
  std::vector<InputSupport> inputs;
  std::string sentence;            ///< what is not supported, and how far; empty where all is
  std::vector<NextRun> next_runs;  ///< points of the posterior far from the runs, the first the most useful
};

}  // namespace uq
