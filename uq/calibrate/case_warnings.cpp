#include "uq/calibrate/case_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/study_units.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/posterior/prior_conflict.hpp"

namespace uq {
namespace {

void add_sampler_warnings(CaseReport& report) {
  if (report.divergences > 0)
    report.warnings.push_back(fmt::format(
        "case {}: {} divergent trajectories: the draws may miss a sharp corner of the posterior (sampler = \"mixture\" "
        "does not follow gradients)",
        report.name, report.divergences));
  if (report.energy_fraction < energy_fraction_poor)
    report.warnings.push_back(
        fmt::format("case {}: E-BFMI {:.2f} is below {:g}: the chains explore the energies slowly", report.name,
                    report.energy_fraction, energy_fraction_poor));
  const bool has_evidence = !std::isnan(report.log_evidence);
  if (has_evidence && !(report.log_evidence_error < evidence_error_poor))
    report.warnings.push_back(
        fmt::format("case {}: the log evidence is only known to {:.2g}", report.name, report.log_evidence_error));
}

}  // namespace

void add_prior_conflicts(CaseReport& report, const SampledCase& sampled, const std::vector<PriorConflict>& conflicts) {
  if (!report.converged) return;  // a mode that no draw visits is seen after the draws
  for (const PriorConflict& conflict : conflicts) {
    const NuisanceReport found = summary_of(sampled, conflict.unknown);
    const std::string unit = behind_number(found.unit);
    report.warnings.push_back(
        fmt::format("case {}: the data contradict the prior of {} by {:.2g} standard deviations: {:.3g} +- {:.2g}{} "
                    "was stated, and {:.3g} +- {:.2g}{} is a compromise of both (check the prior, and what it was "
                    "measured on; then the data's errors)",
                    report.name, found.name, std::abs(conflict.z), found.prior_mean, found.prior_sd, unit, found.mean,
                    found.sd, unit));
  }
}

void add_warnings(CaseReport& report, DoubtOf of, const SampledCase& sampled) {
  if (of == DoubtOf::support || of == DoubtOf::runs || of == DoubtOf::source)
    report.warnings.push_back(fmt::format("case {}: {}", report.name, report.doubt));
  if (!sampled.draws.converged)
    report.warnings.push_back(
        fmt::format("case {}: the chains have not converged: {}", report.name, sampled.draws.reason));
  if (!report.fits && report.doubt.empty())
    report.warnings.push_back(fmt::format("case {}: the model does not fit the data", report.name));
  add_sampler_warnings(report);
  if (!report.discrepancies.empty()) {
    double largest = 0.0;
    for (const auto& band : report.discrepancies) largest = std::max(largest, band.share);
    report.warnings.push_back(
        fmt::format("case {}: a discrepancy competes with the parameters for the data (it takes {:.0f} % of the spread "
                    "about the model); what it takes, the parameters need not explain",
                    report.name, 100.0 * largest));
  }
  for (const auto& unknown : sampled.model->unknowns)
    if (unknown.nuisance == data::NuisanceKind::setting && unknown.prior.kept_mass() < prior_kept)
      report.warnings.push_back(
          fmt::format("case {}: {:.0f} % of what {} may be lies beyond the control's range and is cut off, which "
                      "biases the parameters "
                      "(widen the control's range with runs there, or set as = \"covariance\" in its uncertainty)",
                      report.name, 100.0 * (1.0 - unknown.prior.kept_mass()), unknown.label));
  for (const auto& unknown : sampled.model->unknowns)
    if (!unknown.nuisance && unknown.prior.kept_mass() < prior_kept)
      report.warnings.push_back(fmt::format("case {}: the range of {} cuts off {:.0f} % of its prior", report.name,
                                            unknown.label, 100.0 * (1.0 - unknown.prior.kept_mass())));
}

}  // namespace uq
