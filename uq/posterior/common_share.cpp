#include "uq/posterior/common_share.hpp"

#include <algorithm>
#include <cmath>

#include "uq/findings/thresholds.hpp"
#include "uq/infer/factor.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {
namespace {

constexpr Eigen::Index draws_most = 32;

/// An error that repeated readings share: an unknown of the case, or a term of the data's covariance (-1).
struct Source {
  CommonError error;
  int unknown = -1;
};

CommonErrorKind kind_of(data::NuisanceKind nuisance) {
  switch (nuisance) {
    case data::NuisanceKind::gain:
      return CommonErrorKind::gain;
    case data::NuisanceKind::scale:
      return CommonErrorKind::scale;
    case data::NuisanceKind::setting:
      return CommonErrorKind::setting;
    default:
      return CommonErrorKind::offset;
  }
}

std::vector<Source> find_sources(const CaseModel& model) {
  std::vector<Source> found;
  for (int s = 0; s < model.dimension(); ++s) {
    const Unknown& unknown = model.unknowns[s];
    if (unknown.nuisance && !unknown.only_widens()) found.push_back({{kind_of(*unknown.nuisance), unknown.label}, s});
  }
  bool meter = false, setting = false, discrepancy = false;
  for (const RowGroup& group : model.groups) {
    discrepancy = discrepancy || !group.measurement.discrepancies.empty();
    for (const ReadSet& set : group.measurement.sets) {
      meter = meter || set.common_absolute > 0.0 || set.common_relative > 0.0;
      setting = setting || !set.settings.empty();
    }
  }
  if (meter) found.push_back({{CommonErrorKind::meter, {}}});
  if (setting) found.push_back({{CommonErrorKind::setting, {}}});
  if (discrepancy) found.push_back({{CommonErrorKind::discrepancy, {}}});
  return found;
}

double prior_sd(const Unknown& unknown) { return unknown.cut ? unknown.cut->sd : unknown.prior.sd(); }

/// The case with some of the errors known.
class KnownErrors {
 public:
  KnownErrors(const CaseModel& model, const std::vector<Source>& known) : model_(model) {
    for (const Source& source : known)
      if (source.unknown >= 0)
        unknowns_.push_back(source.unknown);
      else
        leave_out(source.error.kind);
  }

  /// Posterior variances of the case's own parameters, over those of their priors, with the model linear about u.
  /// `slopes`: of the data, each column times its prior's sd.
  Eigen::VectorXd variances(const Eigen::VectorXd& u, const Eigen::MatrixXd& slopes) const {
    Eigen::MatrixXd whitened = slopes;
    for (const int s : unknowns_) whitened.col(s).setZero();
    factor(predict(model_, u).total(), "the data at a draw").llt.matrixL().solveInPlace(whitened);
    Eigen::MatrixXd information = whitened.transpose() * whitened;
    information.diagonal().array() += 1.0;
    const auto one = Eigen::MatrixXd::Identity(information.rows(), information.cols());
    return information.llt().solve(one).diagonal().head(model_.own_count());
  }

 private:
  void leave_out(CommonErrorKind kind) {
    for (RowGroup& group : model_.groups) {
      if (kind == CommonErrorKind::discrepancy) group.measurement.discrepancies.clear();
      for (ReadSet& set : group.measurement.sets) {
        if (kind == CommonErrorKind::meter) set.common_absolute = set.common_relative = 0.0;
        if (kind == CommonErrorKind::setting)
          for (SettingShift& shift : set.settings) shift.error.setZero();
      }
    }
  }

  CaseModel model_;
  std::vector<int> unknowns_;
};

}  // namespace

std::vector<CommonError> shared_errors(const CaseModel& model) {
  std::vector<CommonError> errors;
  for (const Source& source : find_sources(model)) errors.push_back(source.error);
  return errors;
}

std::vector<CommonShare> common_shares(const CaseModel& full, const Eigen::MatrixXd& draws) {
  const CaseModel& model = distinct_rows(full);
  std::vector<CommonShare> found(static_cast<std::size_t>(model.own_count()));
  const std::vector<Source> sources = find_sources(model);
  if (sources.empty()) return found;

  const KnownErrors none(model, {}), all(model, sources);
  std::vector<KnownErrors> one;
  for (const Source& source : sources) one.emplace_back(model, std::vector{source});
  const auto count = static_cast<Eigen::Index>(sources.size());
  Eigen::VectorXd with = Eigen::VectorXd::Zero(model.own_count()), without_all = with;
  Eigen::MatrixXd without_one = Eigen::MatrixXd::Zero(model.own_count(), count);
  const Eigen::MatrixXd points = thinned(draws, draws_most);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::VectorXd u = points.row(i).transpose();
    Eigen::MatrixXd slopes = sensitivity(model, u);
    for (Eigen::Index s = 0; s < u.size(); ++s) slopes.col(s) *= prior_sd(model.unknowns[s]);
    with += none.variances(u, slopes);
    without_all += all.variances(u, slopes);
    for (Eigen::Index k = 0; k < count; ++k) without_one.col(k) += one[k].variances(u, slopes);
  }
  for (Eigen::Index p = 0; p < with.size(); ++p) {
    CommonShare& share = found[p];
    share.share = std::clamp(1.0 - without_all[p] / with[p], 0.0, 1.0);
    if (share.share < notable_share) continue;
    for (Eigen::Index k = 0; k < count; ++k)
      if (1.0 - without_one(p, k) / with[p] >= notable_share) share.errors.push_back(sources[k].error);
    if (share.errors.empty())  // each alone would be made up for by another
      for (const Source& source : sources) share.errors.push_back(source.error);
  }
  return found;
}

}  // namespace uq
