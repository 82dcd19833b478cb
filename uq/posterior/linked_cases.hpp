#pragma once
// The cases that are sampled as one: the wanted case and those whose posteriors it takes (uq/posterior/case_model.hpp,
// linked cases), and where in them an unknown is at home. A posterior taken with `cut` brings its law, not its case.
#include <string>
#include <vector>

#include "data/error.hpp"
#include "data/study.hpp"

namespace uq {

/// The case that an unknown belongs to, with links followed, and its name there. No case: it belongs to the whole
/// study.
struct Home {
  const data::CalibrationCase* owner = nullptr;
  std::string name;
  bool operator==(const Home&) const = default;
};

class LinkedCases {
 public:
  /// Follows the links of a case. Study and case must outlive the object.
  LinkedCases(const data::Study& study, const data::CalibrationCase& wanted);

  const std::vector<const data::CalibrationCase*>& cases() const { return cases_; }  ///< the wanted one first
  /// Problems: circles, posteriors that do not exist, a cut that is reached through another case. The functions below
  /// need that there are none.
  const std::vector<data::Problem>& problems() const { return problems_; }

  /// The prior of a parameter or nuisance of a case, as the case states it.
  const data::Prior& prior_of(const data::CalibrationCase& item, const std::string& name) const;
  Home home(const data::CalibrationCase& item, const std::string& name) const;
  /// The density that an unknown had before any data, traced through cuts, too.
  const data::Prior& first_prior(const data::CalibrationCase& item, const std::string& name) const;
  const data::Nuisance& first_nuisance(const data::CalibrationCase& item, const std::string& name) const;

 private:
  void check_cuts();
  void include(const data::CalibrationCase& item, std::vector<std::string> path);
  void follow(const std::string& name, const data::Prior& prior, const std::vector<std::string>& path);

  const data::Study& study_;
  const data::CalibrationCase& wanted_;
  std::vector<const data::CalibrationCase*> cases_;
  std::vector<data::Problem> problems_;
};

}  // namespace uq
