#include "uq/posterior/linked_cases.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace uq {

using data::CalibrationCase;

namespace {

const CalibrationCase* find_case(const data::Study& study, const std::string& name) {
  for (const auto& item : study.cases)
    if (item.name == name) return &item;
  return nullptr;
}

const data::Nuisance* find_nuisance(const CalibrationCase& item, const std::string& name) {
  for (const auto& nuisance : item.nuisances)
    if (nuisance.parameter.name == name) return &nuisance;
  return nullptr;
}

bool joins(const data::Prior& prior) { return prior.kind == data::PriorKind::posterior && !prior.cut; }

}  // namespace

LinkedCases::LinkedCases(const data::Study& study, const CalibrationCase& wanted) : study_(study), wanted_(wanted) {
  include(wanted, {});
  if (problems_.empty()) check_cuts();
}

/// A cut unknown keeps the law that the other case gave it alone, so that nothing else may come from that case: the two
/// would not belong together any more.
void LinkedCases::check_cuts() {
  const auto check = [&](const std::string& name, const data::Prior& prior) {
    if (prior.kind != data::PriorKind::posterior || !prior.cut) return;
    const CalibrationCase* other = find_case(study_, prior.posterior_of);
    if (std::find(cases_.begin(), cases_.end(), other) == cases_.end()) return;
    problems_.push_back(
        {prior.place,
         fmt::format("case '{}' cuts {} from '{}', with which it is also sampled jointly: what it takes "
                     "from there would not belong together",
                     wanted_.name, name, other->name),
         fmt::format("cut all that comes from '{}', or nothing", other->name)});
  };
  for (const auto& [name, prior] : wanted_.priors) check(name, prior);
}

/// Adds a case and those whose posteriors it takes; `path` is the way from the wanted case.
void LinkedCases::include(const CalibrationCase& item, std::vector<std::string> path) {
  if (std::find(path.begin(), path.end(), item.name) != path.end()) {
    std::string circle;
    for (const auto& name : path) circle += name + " -> ";
    problems_.push_back({item.place, fmt::format("the priors of the cases run in a circle: {}{}", circle, item.name),
                         "give one of them a prior of its own"});
    return;
  }
  path.push_back(item.name);
  if (std::find(cases_.begin(), cases_.end(), &item) == cases_.end()) cases_.push_back(&item);
  for (const auto& [name, prior] : item.priors) follow(name, prior, path);
  for (const auto& nuisance : item.nuisances) follow(nuisance.parameter.name, nuisance.parameter.prior, path);
}

/// Includes the case whose posterior an unknown takes.
void LinkedCases::follow(const std::string& name, const data::Prior& prior, const std::vector<std::string>& path) {
  if (prior.kind != data::PriorKind::posterior) return;
  const CalibrationCase* other = find_case(study_, prior.posterior_of);
  if (other == nullptr) {
    problems_.push_back(
        {prior.place,
         fmt::format("there is no case '{}' whose posterior could be the prior of {}", prior.posterior_of, name),
         "name one of the [[calibrate]] cases"});
  } else if (std::find(other->free.begin(), other->free.end(), name) == other->free.end() &&
             find_nuisance(*other, name) == nullptr) {
    problems_.push_back({prior.place,
                         fmt::format("{} is not free in case '{}', so it has no posterior there", name, other->name),
                         fmt::format("free it in '{}', or fix it here", other->name)});
  } else if (!prior.cut) {
    include(*other, path);
  } else if (path.size() > 1) {
    problems_.push_back({prior.place,
                         fmt::format("case '{}' cuts {} from '{}', but is itself sampled jointly with case '{}'",
                                     path.back(), name, other->name, wanted_.name),
                         fmt::format("cut the posterior of '{}' in '{}', too", path.back(), wanted_.name)});
  }
}

const data::Prior& LinkedCases::prior_of(const CalibrationCase& item, const std::string& name) const {
  if (const auto* nuisance = find_nuisance(item, name)) return nuisance->parameter.prior;
  const auto own = item.priors.find(name);
  return own == item.priors.end() ? study_.parameters[study_.parameter_index(name).value()].prior : own->second;
}

Home LinkedCases::home(const CalibrationCase& item, const std::string& name) const {
  const data::Prior& prior = prior_of(item, name);
  return joins(prior) ? home(*find_case(study_, prior.posterior_of), name) : Home{&item, name};
}

const data::Prior& LinkedCases::first_prior(const CalibrationCase& item, const std::string& name) const {
  const data::Prior& prior = prior_of(item, name);
  if (prior.kind != data::PriorKind::posterior) return prior;
  return first_prior(*find_case(study_, prior.posterior_of), name);
}

const data::Nuisance& LinkedCases::first_nuisance(const CalibrationCase& item, const std::string& name) const {
  const data::Nuisance& nuisance = *find_nuisance(item, name);
  if (nuisance.parameter.prior.kind != data::PriorKind::posterior) return nuisance;
  return first_nuisance(*find_case(study_, nuisance.parameter.prior.posterior_of), name);
}

}  // namespace uq
