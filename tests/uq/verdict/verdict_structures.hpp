#pragma once
// Structures whose verdicts are known from the formula, with names that say nothing: what the verdict suite runs.
//
// y(p, z), z in [0, 1] the control. Training runs at a scrambled Sobol design over all of p and z, with run noise; the
// measurement at ten z, with noise of its own. Both noises are normal, as share of the root mean square of y over the
// design, unless the structure says otherwise.
#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "uq/verdict/identifiability.hpp"

namespace verdict_suite {

struct Range {
  double low = 0.0, high = 1.0;
};

/// What is right of one parameter.
struct Expected {
  std::vector<uq::Verdict> words;   ///< any of these
  std::vector<uq::Reason> reasons;  ///< any of these where the word has one; empty: not asked
  int values = 1;                   ///< separate ones
};

/// A combination that must be named, by its members, and of which form; empty text: any form.
struct Together {
  std::vector<std::string> members;
  std::string text;
};

struct Structure {
  std::string what;
  std::function<double(const Eigen::VectorXd& p, double z)> formula;
  std::vector<Range> ranges;
  Eigen::VectorXd truth;
  std::vector<Expected> expected;
  std::vector<Together> together = {};
  double run_noise = 0.002, data_noise = 0.01;
  int runs = 80;
  std::function<double(double z)> noise_shape = {};  ///< of the data's sd against z
  std::function<double(double z)> unmodelled = {};   ///< added to the data alone
};

std::vector<Structure> structures();

/// One structure at one seed.
struct Outcome {
  bool right = true;
  bool falsely_identified = false;
  bool falsely_converged = false;
  std::string missed;  ///< what was not right
};
Outcome run(const Structure& structure, std::uint32_t seed);

/// Names of a structure's parameters: p1, p2, ...
std::string name_of(std::size_t parameter);

}  // namespace verdict_suite
