#pragma once
// The torque that `demcal new` puts into bench.csv so that the study can be read: it shows the file's form, and is no
// measurement. Until its rows are replaced, every command that reads them says so.
#include <string_view>
#include <vector>

#include "data/finding.hpp"
#include "data/study.hpp"

namespace campaign {

/// The text of bench.csv as `demcal new` writes it.
std::string_view placeholder_torque();

/// A warning for each observation file that still has the template's rows, whatever stands in its comments.
std::vector<data::Finding> placeholders(const data::Study& study);

}  // namespace campaign
