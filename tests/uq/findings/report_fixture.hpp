#pragma once
// A made-up calibration with the shape of the default study: one parameter identified, one identified with a linked
// case, and two on a ridge. The numbers are invented; only their form matters to the tests of the report.
#include <string>

#include "uq/findings/results.hpp"

namespace report_fixture {

uq::CalibrationReport three_cases();

/// One case with four parameters, of which two are traded; no units.
uq::CalibrationReport four_parameters();

/// One case that no parameter value reproduces, although its parameter claims to be identified.
uq::CalibrationReport misfit();

std::size_t count(const std::string& text, const std::string& piece);

}  // namespace report_fixture
