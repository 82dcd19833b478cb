#include "campaign/ledger.hpp"

#include <fmt/core.h>

#include "dem/run/summary.hpp"

namespace campaign {

Ledger::Ledger(data::RunTable table, std::size_t runs) {
  result.table = std::move(table);
  result.ended.assign(runs, false);
  for (std::size_t i = 0; i < result.table.rows.size(); ++i) places_.emplace(data::row_key(result.table.rows[i]), i);
}

void Ledger::take(std::size_t index, const Workspace& own, const Point& point, const dem::RunResult& run,
                  data::Progress* progress) {
  const std::string what = fmt::format("{} {}", point.material, describe(own.study, point));
  // Where short runs were asked for, it is no news that they are short.
  const std::string expected = own.unsteady == Unsteady::use ? dem::unsteady_warning(run.summary) : "";
  for (const std::string& warning : run.warnings)
    if (warning != expected) result.warnings.push_back(what + ": " + warning);
  if (run.status == dem::RunStatus::failed) {
    take_failure(index, what + ": " + run.reason, progress);
    return;
  }
  data::RunRow row = to_row(own, point, run);
  const auto [place, is_new] = places_.emplace(data::row_key(row), result.table.rows.size());
  if (is_new)
    result.table.rows.push_back(std::move(row));
  else
    result.table.rows[place->second] = std::move(row);
  if (run.summary.state != data::FlowState::steady) ++result.unsteady;
  ++result.finished;
  result.ended[index] = true;
  if (progress != nullptr) progress->advance();
}

void Ledger::take_failure(std::size_t index, const std::string& point_and_reason, data::Progress* progress) {
  result.failures.push_back(point_and_reason);
  result.ended[index] = true;
  if (progress == nullptr) return;
  progress->note("failed: " + point_and_reason);
  progress->advance();
}

}  // namespace campaign
