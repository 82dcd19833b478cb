#pragma once
// The figures of the report as gnuplot scripts and data, made from plain results; drawn by gnuplot (gnuplot.hpp).
// Colours are Okabe & Ito's, told apart by colour-blind readers, and every mark also differs in shape or place.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "uq/findings/results.hpp"
#include "uq/report/gnuplot.hpp"

namespace uq {

/// The curves by which torque (or any output) is drawn against its control. They are the case's own, or, where it has
/// none, curves through its predictive points at the control that varies most.
std::vector<PredictiveCurve> curves_to_draw(const CaseReport& result);

/// Observed points with their errors and the posterior predictive band against one control.
Figure predictive_figure(const CaseReport& result, const PredictiveCurve& curve, const std::string& stem);

/// The model's mean at the equivalent points of a traded pair, and the observed points, for the set and output of
/// `like`.
Figure equivalent_figure(const CaseReport& result, const TradedPair& traded, const PredictiveCurve& like,
                         const std::string& stem);

/// The band of a case's discrepancy against one control, with the line 0.
Figure discrepancy_figure(const CaseReport& result, const DiscrepancyBand& band, const std::string& stem);

/// The joint posterior of two parameters: draws, 50 and 90 % regions, prior box, equivalent points.
enum class FigureSize { wide, half };  ///< share of the page's width
Figure joint_figure(const CaseReport& result, std::pair<std::size_t, std::size_t> pair, FigureSize size,
                    const std::string& stem);

/// Whether two parameters of a case are named as traded.
bool are_traded(const CaseReport& result, std::pair<std::size_t, std::size_t> pair);

/// The pairs of parameters worth a joint figure: traded ones first, then by falling correlation; at most `limit`.
std::vector<std::pair<std::size_t, std::size_t>> pairs_to_draw(const CaseReport& result, std::size_t limit);

/// The profile likelihood of one parameter with the 95 % line.
Figure profile_figure(const ParameterReport& parameter, const std::string& stem);

/// Whether the case's draws are kept chain by chain, enough of them for the figures below.
bool has_chains(const CaseReport& result);
/// One parameter's draws in their order, a line per chain.
Figure trace_figure(const CaseReport& result, std::size_t parameter, const std::string& stem);
/// The spread of the ranks of each chain's draws among all draws; it is level where the chains agree.
Figure chain_rank_figure(const CaseReport& result, std::size_t parameter, const std::string& stem);
/// One parameter's posterior distribution with its median and 90 % interval.
Figure marginal_figure(const CaseReport& result, std::size_t parameter, const std::string& stem);

/// The runs of a material over two of its inputs.
Figure design_figure(const DesignReport& design, std::pair<std::size_t, std::size_t> inputs, const std::string& stem);

/// Leave-one-out predictions against the runs, with the identity line.
Figure leave_one_out_figure(const SurrogateReport& surrogate, const std::string& stem);

/// Standardised leave-one-out errors against the prediction, those beyond two marked.
Figure standardised_figure(const SurrogateReport& surrogate, const std::string& stem);

/// Runs at points of the posterior against what the surrogate said before, for the output and material of `like`.
Figure verification_figure(const VerificationReport& round, const VerifiedValue& like, const std::string& stem);

/// Information that single readings are expected to give, against their control; nothing where no control varies.
std::optional<Figure> information_figure(const PlanReport& plan, const std::string& stem);

/// Arrows from the origin: what each candidate's reading does when either of two parameters changes, the one asked for
/// and the first other; nothing where there is no other or no candidate has an arrow.
std::optional<Figure> arrow_figure(const PlanReport& plan, const std::string& stem);

}  // namespace uq
