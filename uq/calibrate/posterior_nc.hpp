#pragma once
// posterior-CASE.nc: draws as netCDF-4 by the ArviZ InferenceData schema (https://python.arviz.org, "schema"), read by
// arviz.from_netcdf and, group by group, by xarray.
//   posterior             one variable (chain, draw) per unknown, in the study's unit
//   sample_stats          lp, acceptance_rate; energy, diverging, tree_depth where the sampler has them
//   posterior_predictive  one variable (chain, draw, point) per observation set and output: a repeat of the measurement
//   log_likelihood        the same shape: log density of each measured number on its own. Surrogate errors that several
//                         numbers share are in each of them, so the sum is not the joint one
//   observed_data         the same variables (point); controls are coordinates of the points
//   constant_data         their standard errors
#include <cstdint>
#include <string>

#include "data/study.hpp"
#include "uq/calibrate/calibrate.hpp"

namespace uq {

/// Writes the file, whole or not at all. Throws data::InputError (73) when it cannot write.
void write_posterior(const std::string& path, const data::Study& study, const SampledCase& sampled, std::uint64_t seed);

/// The group posterior alone as a CSV: chain, draw, one column per unknown in the study's unit, lp.
std::string draws_csv(const SampledCase& sampled);

}  // namespace uq
